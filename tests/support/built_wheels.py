"""Wheels of projects that hatchling builds, all by one process."""

import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

BUILD = """
import os, sys
from hatchling.build import build_wheel
for project in sys.argv[2:]:
    os.chdir(project)
    build_wheel(sys.argv[1])
"""
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet")
OFFLINE = ("--no-deps", "--no-build-isolation", "--no-index", "--no-compile")


def build(projects: Iterable[Path], folder: Path) -> list[Path]:
    """Build a wheel of each project, as pip would have it built, into a new folder; return all of them."""
    folder.mkdir()
    subprocess.run([sys.executable, "-c", BUILD, folder, *projects], check=True, capture_output=True)
    return sorted(folder.glob("*.whl"))


def install(what: Iterable[Path], site: Path) -> None:
    """Install wheels and projects by pip into a folder."""
    subprocess.run([*PIP, "install", *OFFLINE, "--target", site, *what], check=True)
