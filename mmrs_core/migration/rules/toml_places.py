"""Where keys stand in a TOML file; its parser tells no lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence

_HEADER = re.compile(r"\s*(\[[^\[\]]+\])\s*(#.*)?")
_TRANSPARENT = "features"
"""The table that messages leave out: what is in it, they tell of the class."""


def line_of(text: str, *ways: Sequence[str]) -> int:
    r"""Return the line, from 1, of the deepest of nested keys that is found; 0 if not even the first is.

    Lines inside texts of several lines may be taken for keys; nobody writes such texts in mappings.

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
    for equals in re.finditer("=", line):
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
    """Return how many keys a path has in common with others, if it leads to one of them; else 0."""
    same = len(path) <= len(keys) and all(one == other for one, other in zip(path, keys, strict=False))
    return len(path) if same else 0
