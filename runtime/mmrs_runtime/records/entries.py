"""Reads the black boxes of robots: knowledge, decisions and actions, one JSON object a line.

A box is read although its end was cut off or lines of it were damaged, as after a power failure:
unreadable lines are reported, and the rest is used. Lines are read one by one, so that days fit in memory.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import IO

LONGEST_LINE = 1_000_000

_OWN = frozenset({"run", "robot", "time", "wall", "kind"})


@dataclass(frozen=True, slots=True)
class Entry:
    """One line.

    Attributes:
        time: seconds of the run.
        wall: date and time of day as written, ISO 8601; empty where there is none.
        kind: ``fix``, ``command``, ``decision`` …; unknown kinds are entries, too.
        content: the other values of the line, by key.
    """

    run: str
    robot: str
    time: float
    wall: str
    kind: str
    content: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class Damage:
    """What cannot be read. Attributes: name of the file, line (0: the file as a whole), what is wrong."""

    file: str
    line: int
    what: str

    def __str__(self) -> str:
        """Return one line as printed."""
        return f"{self.file}:{self.line}: {self.what}" if self.line else f"{self.file}: {self.what}"


Tell = Callable[[Damage], None]


def entries_of(path: Path, tell: Tell) -> Iterator[Entry]:
    """Yield the entries of one file; report unreadable lines.

    Raises:
        OSError: the file cannot be read.
    """
    with path.open("rb") as file:
        for number, line in enumerate(_lines(file), start=1):
            entry, fault = entry_in(line)
            if entry is not None:
                yield entry
            elif fault:
                tell(Damage(path.name, number, fault))


def _lines(file: IO[bytes]) -> Iterator[bytes]:
    """Yield lines with their ends; of one that is longer than any entry, only the beginning."""
    while line := file.readline(LONGEST_LINE):
        yield line
        while line and not line.endswith(b"\n") and len(line) == LONGEST_LINE:
            line = file.readline(LONGEST_LINE)


def entry_in(line: bytes) -> tuple[Entry | None, str]:
    """Return an entry, or None and what keeps the line from being one; neither for an empty line."""
    if not line.strip():
        return None, ""
    try:
        value: object = json.loads(line)
    except (ValueError, RecursionError):
        return None, _why(line)
    if not isinstance(value, dict):
        return None, "not an object"
    run, robot, kind = (value.get(name) for name in ("run", "robot", "kind"))
    if not (isinstance(run, str) and isinstance(robot, str) and isinstance(kind, str) and robot and kind):
        return None, "run, robot or kind is missing"
    time = number_of(value.get("time"))
    if time is None or time < 0:
        return None, "its time is not a number from 0 on"
    wall = value.get("wall")
    content = {name: each for name, each in value.items() if name not in _OWN}
    return Entry(run, robot, time, wall if isinstance(wall, str) else "", kind, content), ""


def number_of(value: object) -> float | None:
    """Return a finite number; None for anything else.

    >>> number_of(3), number_of(True), number_of("3"), number_of(float("nan"))
    (3.0, None, None, None)
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if isfinite(number) else None


def _why(line: bytes) -> str:
    if b"\0" in line:
        return "zero bytes, as power loss leaves them"
    if not line.endswith(b"\n"):
        return "longer than any entry" if len(line) == LONGEST_LINE else "cut off while it was written"
    return "not JSON"
