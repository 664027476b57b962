"""Copies of shipped examples: beside what was made of them, so that it can be used as a project."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from mmrs_core.cli.protection import ProtectedError, refuse_inputs
from mmrs_core.cli.replacing import replace_files

NOT_COPIED = frozenset({"demo.toml"})
ON_TOP = ("mission.xmi", "context.xmi", "surroundings.json")
ROBOTS = "robots"


def require_copies(folder: Path, example: Path, others: Iterable[Path]) -> None:
    """Do nothing if whatever a copy of an example would replace is a copy, too, of any of them.

    Raises:
        ProtectedError: if it is something else, or the example itself.
    """
    refuse_inputs((folder / name for name in names_in(example)), _files_in(example))
    known = {file.read_bytes() for each in (example, *others) for file in _files_in(each)}
    for file in _replaced_in(folder):
        if file.read_bytes() not in known:
            raise ProtectedError(
                f"{file}: is no copy of an example, and is not replaced; choose another folder"
            )


def copy_example(example: Path, folder: Path) -> int:
    """Put a copy of an example in a folder, in place of that of another; return how many files it has."""
    names = names_in(example)
    for file in _replaced_in(folder):
        if file.relative_to(folder) not in names:
            file.unlink()
    replace_files({folder / name: (example / name).read_bytes() for name in names})
    return len(names)


def names_in(example: Path) -> tuple[Path, ...]:
    """Return the files of an example that are copied, from its folder on."""
    return tuple(file.relative_to(example) for file in _files_in(example) if file.name not in NOT_COPIED)


def _files_in(example: Path) -> Iterator[Path]:
    return (file for file in sorted(example.rglob("*")) if file.is_file())


def _replaced_in(folder: Path) -> list[Path]:
    found = (*(folder / name for name in ON_TOP), *sorted((folder / ROBOTS).glob("*")))
    return [file for file in found if file.is_file()]
