"""TOML with bounds that hostile files run into, and where keys stand in it; its parser tells no lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

_HEADER = re.compile(r"\s*(\[[^\[\]]+\])\s*(#.*)?")
_TRANSPARENT = "features"
"""The table that messages leave out: messages about its content name the class."""


LONGEST_LINE = 4_000
"""Characters of a line: far more than any mapping has."""
MOST_BRACKETS = 100
"""Opened on one line, or not closed yet: the parser goes deeper with each."""
MOST_KEYS = 50
"""Parts of a dotted key on one line."""
_MOST_SIGNS = 50
"""Signs of equality in a key, in quotes."""

_LONG_KEY = re.compile(r"^\s*+\[*+(?:[^.=\"']*+\.){50}")
_LONG_NUMBER = re.compile(r"[0-9_]{400}")


class TooMuchError(ValueError):
    """A line that holds more than any mapping has.

    Attributes:
        line: counted from 1.
    """

    def __init__(self, line: int, what: str) -> None:
        super().__init__(what)
        self.line = line


def parsed(text: str) -> dict[str, Any]:
    """Return what a text of TOML holds.

    Raises:
        TooMuchError: if a line is longer, nests deeper or has longer numbers or keys than any mapping's.
        tomllib.TOMLDecodeError: if it is not TOML.
    """
    deep = 0
    for number, line in enumerate(text.split("\n"), 1):
        if len(line) > LONGEST_LINE:
            raise TooMuchError(number, f"longer than {LONGEST_LINE} characters: divide the line")
        if _LONG_NUMBER.search(line):
            raise TooMuchError(number, "a number of more than 400 digits")
        if _LONG_KEY.search(line):
            raise TooMuchError(number, f"a key of more than {MOST_KEYS} parts")
        deep = max(0, deep + sum(map(line.count, "[{")) - sum(map(line.count, "]}")))
        if max(deep, line.count("["), line.count("{")) > MOST_BRACKETS:
            raise TooMuchError(number, f"nested deeper than {MOST_BRACKETS} brackets, or as many on one line")
    return tomllib.loads(text)


def line_of(text: str, *ways: Sequence[str]) -> int:
    r"""Return the line, from 1, of the deepest of nested keys that is found; 0 if not even the first is.

    Lines inside texts of several lines may be taken for keys; mappings contain no such texts.

    Args:
        ways: the keys from the root; several, where it is not known which of their dots divide keys.

    >>> line_of('name = "x"\n[rules.port.Boat]\nto = "y"', ("rules", "port", "Boat", "to"))
    3
    """
    wanted = [[key for key in keys if key != _TRANSPARENT] for keys in ways]
    best, deepest = 0, 0
    for number, path in _paths(text):
        depth = max(_shared(path, keys) for keys in wanted)
        if depth > deepest:
            best, deepest = number, depth
    return best


def _paths(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield (line, keys from the root) of every table's header and every key at a line's beginning."""
    header: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        if found := _HEADER.fullmatch(line):
            header = _keys(found[1]) or header
            yield number, header
        elif inner := _assigned(line):
            yield number, header + inner


def _assigned(line: str) -> list[str]:
    for equals in islice(re.finditer("=", line), _MOST_SIGNS):
        if found := _keys(f"{line[: equals.start()]} = 0"):
            return found
    return []


def _keys(line: str) -> list[str]:
    """Return the nested keys that one line of TOML makes; none if it is no such line."""
    try:
        value: object = tomllib.loads(line)
    except tomllib.TOMLDecodeError:
        return []
    found: list[str] = []
    while isinstance(value, dict) and value:
        key, value = next(iter(value.items()))
        found.append(key)
    return [key for key in found if key != _TRANSPARENT]


def _shared(path: Sequence[str], keys: Sequence[str]) -> int:
    """Return how many keys a path has in common with others, if it leads to one of them; otherwise 0."""
    same = len(path) <= len(keys) and all(one == other for one, other in zip(path, keys, strict=False))
    return len(path) if same else 0
