"""Tables of a TOML file, taken apart key by key so that misspelt and ill-typed keys are reported."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, fields
from itertools import islice
from typing import Any, TypeVar, cast

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.naming import nearest

Value = TypeVar("Value")


class Table:
    """A table whose keys are taken one after the other; those left over are errors.

    Attributes:
        where: file and dotted key, for messages.
    """

    def __init__(self, where: str, value: object) -> None:
        """Take a value that has to be a table.

        Raises:
            UnreadableError: if it is none.
        """
        if not isinstance(value, Mapping):
            raise UnreadableError(f"{where}: expected a table, not {_called(value)}")
        self.where = where
        self._rest: dict[str, object] = dict(cast(Mapping[str, object], value))
        self._known: list[str] = []

    def __contains__(self, key: str) -> bool:
        """Return whether the key is there and not taken yet."""
        return key in self._rest

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that are not taken yet."""
        return tuple(self._rest)

    def take(self, key: str, kind: type[Value], otherwise: Value) -> Value:
        """Return the value of a key, or another where it is missing; whole numbers pass for real ones.

        Raises:
            UnreadableError: if it is not of that type.
        """
        self._known.append(key)
        if key not in self._rest:
            return otherwise
        value = self._rest.pop(key)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or (isinstance(value, bool) and kind not in (bool, object)):
            raise self.fault(f"{key}: expected {_NAMES.get(kind, kind.__name__)}, not {_called(value)}")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of texts, which a single text stands for, too; empty where the key is missing."""
        value = self.take(key, object, [])
        items = [value] if isinstance(value, str) else value
        if not isinstance(items, list) or not all(isinstance(item, str) for item in items):
            raise self.fault(f"{key}: expected a text or a list of texts, not {_called(value)}")
        return tuple(items)

    def plain(self, kind: type, *but: str, **keys: str) -> dict[str, Any]:
        """Return by name the fields of a dataclass that are texts, numbers, truth values or lists of texts.

        Args:
            kind: the dataclass; a key that is missing stands for the field's default, or an empty value.
            but: fields that come from elsewhere.
            keys: of fields that are called otherwise in the file.
        """
        found: dict[str, Any] = {}
        for each in fields(kind):
            key = keys.get(each.name, each.name)
            if each.name in but or each.type not in _PLAIN:
                continue
            if (plain := _PLAIN[each.type]) is tuple:
                found[each.name] = self.texts(key)
            else:
                found[each.name] = self.take(key, plain, plain() if each.default is MISSING else each.default)
        return found

    def table(self, key: str) -> Table:
        """Return a table within it; an empty one where the key is missing."""
        return Table(f"{self.where}: {key}", self.take(key, object, {}))

    def tables(self) -> dict[str, Table]:
        """Return all that is left as tables, by key."""
        return {key: self.table(key) for key in self.keys}

    def text_by_key(self) -> dict[str, str]:
        """Return all that is left as texts, by key."""
        return {key: self.take(key, str, "") for key in self.keys}

    def done(self) -> None:
        """Require that every key was taken.

        Raises:
            UnreadableError: if one is left, with the nearest key that is known.
        """
        for key in self._rest:
            hint = nearest(key, self._known)
            raise self.fault(f"{key}: no such key here{hint and '; ' + hint}")

    def fault(self, message: str) -> UnreadableError:
        """Return an error with its position in the file."""
        return UnreadableError(f"{self.where}: {message}")


_PLAIN: Mapping[object, type] = {
    "str": str,
    "float": float,
    "bool": bool,
    "int": int,
    "tuple[str, ...]": tuple,
}
"""Types as annotations name them."""
_NAMES: Mapping[type, str] = {str: "a text", float: "a number", bool: "true or false", int: "a whole number"}


def _called(value: object) -> str:
    """Return what a value is called in messages."""
    return "a table" if isinstance(value, Mapping) else f"{value!r}"[:60]


_HEADER = re.compile(r"\s*(\[[^\[\]]+\])\s*(#.*)?")
_TRANSPARENT = "features"
"""The table that messages leave out: messages about its content name the class."""
_MOST_SIGNS = 50
"""Signs of equality in a key, in quotes."""


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
