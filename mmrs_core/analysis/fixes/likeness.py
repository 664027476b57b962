"""Which known word a misspelt one can only be."""

from __future__ import annotations

from collections.abc import Iterable

_SHORT = 5
"""Letters below which two wrong ones make too much of a word."""


def meant(name: str, known: Iterable[str]) -> str | None:
    """Return the known word that a word can only be meant for; None if there is none, or more than one.

    Words that differ by capitals, blanks and signs are the same; others may differ by a letter put in, left
    out, exchanged, or two swapped; long ones by two.

    >>> meant("Capture_Image", ["CaptureImage", "Capture"]), meant("dorne", ["drone", "stone"])
    ('CaptureImage', 'drone')
    >>> meant("save", ["SAFE", "NORMAL"]), meant("cat", ["car", "cut"]) is None
    ('SAFE', True)
    """
    choices = sorted(set(known) - {name})
    alike = [each for each in choices if _letters(each) == _letters(name)]
    allowed = 0
    while not alike and allowed < (1 if len(name) <= _SHORT else 2):
        allowed += 1
        alike = [each for each in choices if _apart(name.casefold(), each.casefold()) <= allowed]
    return alike[0] if len(alike) == 1 and name.strip() else None


def _letters(word: str) -> str:
    return "".join(letter for letter in word.casefold() if letter.isalnum())


def _apart(one: str, other: str) -> int:
    """Return in how many letters two words differ; two neighbours that are swapped count once."""
    if abs(len(one) - len(other)) > 2:
        return 3
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, 1):
        above, row = row, [i]
        row += [0] * len(other)
        for j, wanted in enumerate(other, 1):
            row[j] = min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (letter != wanted))
    return min(row[-1], _swapped(one, other))


def _swapped(one: str, other: str) -> int:
    """Return 1 if two neighbouring letters are swapped and all else is the same, else 3."""
    wrong = [i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b]
    if len(one) != len(other) or len(wrong) != 2 or wrong[1] != wrong[0] + 1:
        return 3
    i, j = wrong
    return 1 if one[i] == other[j] and one[j] == other[i] else 3
