"""Type checks by mypy, which analyses what all of them use only once in a run of tests."""

import subprocess
import sys
from pathlib import Path

import shared


def mypy(*words: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run mypy in a folder, with one cache for this run of tests."""
    command = [sys.executable, "-m", "mypy", "--cache-dir", shared.folder() / "mypy", *words]
    with shared.alone("mypy"):
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=240)
