"""A tree as a stream, so that what was migrated is read as what stands in a file is."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mmrs_core.languages.json_form.layout import formatted
from mmrs_core.languages.json_form.stream import (
    END,
    LIST,
    NUMBER,
    OBJECT,
    TEXT,
    WORD,
    Event,
    Place,
    is_own,
)
from mmrs_core.languages.json_form.tree import Node, Number

_Pending = tuple[Iterator[tuple[str, object]], Node | None, Place]
"""What is still to come of an object or a list, the object, and where a list stands."""


class TreeStream:
    """A tree.

    Attributes:
        file: what messages call the file.
    """

    def __init__(self, file: str, top: object, line_of: Callable[[Node, str], int]) -> None:
        """Take what stands at the top, and what tells the line on which an object says something."""
        self.file = file
        self._top = top
        self._line_of = line_of

    def events(self) -> Iterator[Event]:
        """Yield what is said, first what an object says of itself; as `Stream` has it."""
        pending: list[_Pending] = [(iter([("", self._top)]), None, self._top)]
        while pending:
            members, owner, place = pending[-1]
            key, value = next(members, ("", pending))
            if value is pending:
                pending.pop()
                if pending:
                    yield END, "", "", place, place
                continue
            at = (owner, key) if owner is not None else place
            yield _event(key, value, at)
            if isinstance(value, Node):
                pending.append((iter(sorted(value.members.items(), key=_is_other)), value, at))
            elif isinstance(value, list):
                pending.append((iter([("", each) for each in value]), None, at))

    def late(self, key: str) -> Iterator[Event] | None:
        """Return None: nothing stands late."""
        return None

    def line(self, place: Place) -> int:
        """Return the line of an object, or on which it says something; as `Stream` has it."""
        if isinstance(place, tuple):
            return self._line_of(*place)
        return place.line if isinstance(place, Node) else 1

    def source(self, begin: Place, end: Place) -> str:
        """Return an object as JSON writes it; as `Stream` has it."""
        return formatted(begin, 0)


def _is_other(member: tuple[str, object]) -> bool:
    return not is_own(member[0])


def _event(key: str, value: object, place: Place) -> Event:
    if isinstance(value, Node):
        return OBJECT, key, "", place, value
    if isinstance(value, list):
        return LIST, key, "", place, place
    if isinstance(value, str) and not isinstance(value, Number):
        return TEXT, key, value, place, None
    if value is None or isinstance(value, bool):
        return WORD, key, "null" if value is None else str(value).lower(), place, None
    return NUMBER, key, str(value), place, None
