"""What all workers of a test run share: a folder, and what is made in it once."""

import atexit
import fcntl
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

_VARIABLE = "MMRS_TEST_RUN"
SELDOM = (50_000, 20, 20)
"""New objects after which Python looks for cycles; by default, that is a twentieth of the time of tests."""


def open_folder() -> Callable[[], None]:
    """Make the folder of this test run, which its workers inherit; return what removes it."""
    folder = os.environ[_VARIABLE] = tempfile.mkdtemp(prefix="mmrs-tests-")
    return lambda: shutil.rmtree(folder, ignore_errors=True)


def folder() -> Path:
    """Return the folder of this test run; outside of one, that of this process."""
    if _VARIABLE not in os.environ:
        atexit.register(open_folder())
    return Path(os.environ[_VARIABLE])


@contextmanager
def alone(name: str) -> Iterator[None]:
    """Keep other workers from what has this name."""
    with (folder() / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def made_once(name: str, make: Callable[[Path], None]) -> Path:
    """Return what the first worker that needed it has made at a path of that name."""
    made = folder() / name
    with alone(name):
        if not made.exists():
            beside = made.with_name(f"{name}.new")
            shutil.rmtree(beside, ignore_errors=True)
            make(beside)
            beside.rename(made)
    return made
