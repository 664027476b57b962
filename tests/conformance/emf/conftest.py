"""Eclipse EMF as a referee: a small Java program of ours around the libraries."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from mmrs_core.languages.registry import MetamodelSource, registry_with

PROJECT = Path(__file__).parents[3]
JARS = [Path("/usr/share/java") / f"eclipse-emf-{name}.jar" for name in ("common", "ecore", "ecore-xmi")]


@dataclass(frozen=True)
class Verdict:
    accepted: bool
    lines: tuple[str, ...]

    @property
    def faults(self):
        return [line.removeprefix("FAULT ") for line in self.lines if line.startswith("FAULT ")]


@pytest.fixture(scope="session")
def referee(tmp_path_factory, need_program):
    """Return a function that runs the referee with arguments and returns its verdict."""
    java = need_program("java", "Eclipse EMF judges metamodels and models")
    javac = need_program("javac", "the referee is compiled for the tests")
    missing = [jar.name for jar in JARS if not jar.is_file()]
    if missing:
        message = f"{', '.join(missing)}: not installed (Debian: libeclipse-emf-ecore-xmi-java)"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)
    classes = tmp_path_factory.mktemp("referee")
    path = os.pathsep.join(map(str, [classes, *JARS]))
    source = Path(__file__).with_name("Referee.java")
    subprocess.run([javac, "-cp", path, "-d", classes, source], check=True, timeout=120)

    def run(*arguments):
        command = [
            java,
            "-Xshare:auto",
            "-XX:TieredStopAtLevel=1",
            "-Dfile.encoding=UTF-8",
            "-cp",
            path,
            "Referee",
        ]
        done = subprocess.run(
            [*command, *map(str, arguments)], capture_output=True, text=True, timeout=240, check=False
        )
        assert done.returncode in (0, 1), done.stderr
        return Verdict(done.returncode == 0, tuple(done.stdout.splitlines()))

    return run


@pytest.fixture(scope="session")
def metamodels():
    """Return the .ecore files of the core and the plug-ins, those that others need first."""
    core = [PROJECT / "metamodels" / f"{name}.ecore" for name in ("robot", "mission", "context", "behaviour")]
    return [*core, *sorted((PROJECT / "plugins").glob("*/mmrs_*/metamodels/*.ecore"))]


@pytest.fixture(scope="session")
def zoo_file():
    return PROJECT / "tests" / "fixtures" / "models" / "zoo.ecore"


@pytest.fixture(scope="session")
def registry(metamodels, zoo_file):
    """The core, the plug-ins' metamodels and a foreign one that uses what Ecore offers beyond ours."""
    sources = [
        MetamodelSource(f"urn:mmrs:{file.stem}:1.0", file, file.stem)
        for file in metamodels
        if file.parent.name == "metamodels" and file.parent.parent != PROJECT
    ]
    return registry_with([*sources, MetamodelSource("urn:test:zoo", zoo_file, "zoo")])
