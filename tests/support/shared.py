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
_MEMORY, _ROOM = Path("/dev/shm"), 2 << 30
SELDOM = (50_000, 20, 20)
"""New objects after which Python looks for cycles; by default, that is a twentieth of the time of tests."""


def write_to_memory() -> None:
    """Have tests keep their files in memory where it has room: a disk takes ten times as long for each."""
    if "TMPDIR" not in os.environ and _MEMORY.is_dir():
        state = os.statvfs(_MEMORY)
        if state.f_bavail * state.f_frsize > _ROOM and not state.f_flag & (os.ST_NOEXEC | os.ST_RDONLY):
            os.environ["TMPDIR"] = tempfile.tempdir = str(_MEMORY)


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
