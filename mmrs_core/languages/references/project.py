"""Which files belong to one project, by where they lie."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

MODEL_ENDINGS = (".xmi", ".json")
_ROBOTS = "robots"
_NAMES = ("mission", "context")


def robot_files_in(folder: Path) -> tuple[Path, ...]:
    """Return the files of robot types in a folder, by name; hidden files are none."""
    files = (file for ending in MODEL_ENDINGS for file in folder.glob(f"*{ending}"))
    return tuple(sorted(file for file in files if not file.name.startswith(".")))


def files_beside(file: Path) -> Iterator[Path]:
    """Yield the mission, the context and the robot types in the folder of a file, in any form they have."""
    folder = file.parent
    named = (folder / f"{name}{ending}" for name in _NAMES for ending in MODEL_ENDINGS)
    yield from (each for each in named if each.is_file() and each != file)
    yield from robot_files_in(folder / _ROBOTS)


def is_beside(other: Path, file: Path) -> bool:
    """Return whether `files_beside` yields a file once it is there."""
    if other.suffix not in MODEL_ENDINGS or other.name.startswith("."):
        return False
    if other.parent == file.parent:
        return other.stem in _NAMES
    return other.parent == file.parent / _ROBOTS
