"""The files of black boxes: full parts are numbered, the newest has no number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_runtime.records.blackbox import BOX, BOX_SUFFIX
from mmrs_runtime.records.entries import Entry, Tell, entries_of
from mmrs_runtime.records.steps import SUFFIX

SIMULATION = "simulation"
"""The link of a robot without a vehicle, as its box names it."""

_PART = re.compile(rf"(?P<stem>.+){re.escape(BOX)}(?:\.(?P<number>\d+))?{re.escape(BOX_SUFFIX)}")


@dataclass(frozen=True, slots=True)
class BlackBox:
    """The box of one robot.

    Attributes:
        stem: of its files, which is that of the robot's log.
        parts: oldest first.
        missing: messages about missing parts; empty if nothing seems to be missing.
    """

    stem: str
    parts: tuple[Path, ...]
    missing: tuple[str, ...] = ()

    def entries(self, tell: Tell) -> Iterator[Entry]:
        """Yield every readable entry in the order of the lines; pass damage to `tell`.

        Raises:
            UnreadableError: if a part cannot be opened.
        """
        for part in self.parts:
            try:
                yield from entries_of(part, tell)
            except OSError as error:
                why = error.strerror or error
                raise UnreadableError(f"{part}: cannot be read as a black box: {why}") from error


def black_boxes(paths: Iterable[Path]) -> tuple[BlackBox, ...]:
    """Return the boxes that paths lead to, by stem; none where there are none.

    Args:
        paths: folders; logs, whose boxes lie beside them; or any part of a box, which stands for all.
    """
    stems: dict[tuple[Path, str], Path] = {}
    for path in paths:
        if path.is_dir():
            found = sorted(path.glob(f"*{BOX}*{BOX_SUFFIX}"))
            stems |= {(path.resolve(), stem): path for part in found if (stem := _stem(part))}
        elif stem := _stem(path) or (path.stem if path.suffix == SUFFIX else ""):
            stems[(path.parent.resolve(), stem)] = path.parent
    boxes = (_box(folder, stem) for (_, stem), folder in stems.items())
    return tuple(box for box in boxes if box.parts)


def is_part(path: Path) -> bool:
    """Return whether a path has the name of a part of a black box."""
    return bool(_stem(path))


def _stem(path: Path) -> str:
    found = _PART.fullmatch(path.name)
    return found["stem"] if found else ""


def _box(folder: Path, stem: str) -> BlackBox:
    numbered: dict[int, Path] = {}
    current: list[Path] = []
    for path in folder.glob(f"*{BOX}*{BOX_SUFFIX}"):
        found = _PART.fullmatch(path.name)
        if found and found["stem"] == stem:
            if found["number"]:
                numbered[int(found["number"])] = path
            else:
                current.append(path)
    parts = (*(numbered[number] for number in sorted(numbered)), *current)
    return BlackBox(stem, parts, tuple(_missing(stem, numbered, bool(current))))


def _missing(stem: str, numbered: Iterable[int], current: bool) -> Iterator[str]:
    numbers = sorted(numbered)
    for before, after in pairwise((0, *numbers)):
        if after > before + 1:
            alone = after == before + 2
            which = f"part {before + 1}" if alone else f"parts {before + 1} to {after - 1}"
            yield f"{stem}{BOX}: {which} of {numbers[-1]} {'is' if alone else 'are'} missing"
    if numbers and not current:
        yield f"{stem}{BOX}: its last part, {stem}{BOX}{BOX_SUFFIX}, is missing"
