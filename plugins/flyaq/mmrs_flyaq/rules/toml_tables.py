"""Tables of a TOML file, taken apart key by key so that misspelt and ill-typed keys are reported."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar, cast

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
        """Do nothing if every key was taken.

        Raises:
            UnreadableError: if one is left, with the nearest key that is known.
        """
        for key in self._rest:
            hint = nearest(key, self._known)
            raise self.fault(f"{key}: no such key here{hint and '; ' + hint}")

    def fault(self, message: str) -> UnreadableError:
        """Return an error with its position in the file."""
        return UnreadableError(f"{self.where}: {message}")


_NAMES: Mapping[type, str] = {str: "a text", float: "a number", bool: "true or false", int: "a whole number"}


def _called(value: object) -> str:
    """Return what a value is called in messages."""
    return "a table" if isinstance(value, Mapping) else f"{value!r}"[:60]
