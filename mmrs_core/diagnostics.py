"""Problems of a user's model: what, where, and how to fix them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from itertools import combinations

LONGEST_TEXT = 2000
"""Characters of a message or a hint, in which a model may say a megabyte, and that ten thousand times."""


SAME_LENGTH = 1e-6
"""Metres by which lengths differ that messages need not tell from each other."""


class Severity(Enum):
    """How much a fault matters; only errors stop a mission."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """Where something stands in a user's files.

    Attributes:
        file: the path as the user gave it; empty for a model made in memory.
        line: counted from 1; 0 where it is not known.
        path: the element within its model, such as ``/tasks[2]/shell[0]``; may be empty.
    """

    file: str = ""
    line: int = 0
    path: str = ""

    def __str__(self) -> str:
        """Return ``file:line``, or as much of it as is known."""
        return f"{self.file}:{self.line}" if self.line else self.file or self.path


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem.

    Attributes:
        code: two or more capitals and three digits, such as ``MML014``; stable.
        severity: how much it matters.
        message: lower case, no full stop, the culprit first; truncated if it is too long to read.
        place: its file and line.
        hint: how to fix it; may be empty.
        expected: the expected value or element; may be empty.
    """

    code: str
    severity: Severity
    message: str
    place: Place = Place()
    hint: str = ""
    expected: str = ""

    def __post_init__(self) -> None:
        """Cut texts that are too long."""
        for name in ("message", "hint", "expected"):
            text = getattr(self, name)
            if len(text) > LONGEST_TEXT:
                object.__setattr__(self, name, f"{text[: LONGEST_TEXT - 3]}...")

    def __str__(self) -> str:
        """Return one line in the form compilers use; beneath it where, what was expected, and the hint."""
        where = f"{self.place}: " if str(self.place) else ""
        reported = {"at": self.place.path.strip("/") and self.place.path, "expected": self.expected}
        lines = [f"\n    {word}: {words}" for word, words in {**reported, "hint": self.hint}.items() if words]
        return f"{where}{self.severity.value}: {self.message} [{self.code}]{''.join(lines)}"


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of them is an error."""
    return any(fault.severity is Severity.ERROR for fault in diagnostics)


_RANK = {Severity.ERROR: 0, Severity.WARNING: 1, Severity.NOTE: 2}


_FIGURES = re.compile(r"([0-9]+)")


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return them without repeats: errors first, then as they stand in the files, then by code.

    Numbers within paths and messages count as numbers: ``/tasks[7]`` comes before ``/tasks[106]``.
    """
    return tuple(sorted(dict.fromkeys(diagnostics), key=_rank))


def _rank(fault: Diagnostic) -> tuple[object, ...]:
    place = fault.place
    where = (_counted(place.file), place.line, _counted(place.path))
    # the bare texts tell 07 from 7
    return (_RANK[fault.severity], *where, fault.code, _counted(fault.message), place, fault.message)


def _counted(text: str) -> tuple[tuple[int, int, str], ...]:
    """Return what sorts texts as people count: figures by their value, in front of letters."""
    parts = enumerate(_FIGURES.split(text))
    # figures by their length before their digits: they may be longer than Python reads as a number
    return tuple(
        (0, len(part.lstrip("0")), part.lstrip("0")) if odd % 2 else (1, 0, part) for odd, part in parts
    )


def lengths(*metres: float) -> tuple[str, ...]:
    """Return lengths for a message: with two digits, or as many as distinguish them and 0.

    >>> lengths(7.64, 5.0)
    ('7.64 m', '5.00 m')
    >>> lengths(7.6399715, 7.64)
    ('7.63997 m', '7.64000 m')
    """
    different = [(a, b) for a, b in combinations((0.0, *metres), 2) if abs(a - b) > SAME_LENGTH]
    digits = (n for n in range(2, 7) if all(f"{a:.{n}f}" != f"{b:.{n}f}" for a, b in different))
    chosen = next(digits, 6)
    return tuple(f"{each:.{chosen}f} m" for each in metres)
