"""JSON as a stream: what is said comes one value after the other, wherever it is read from."""

from __future__ import annotations

import re
from collections.abc import Iterator
from json.encoder import encode_basestring
from typing import Protocol

TEXT, NUMBER, WORD, OBJECT, LIST, END = range(6)
"""What comes: a text, a number, true or false or null, the begin of an object or a list, the end of one."""

TYPE, ID, REF, ROOTS, LANGUAGES, PLACES = "$type", "$id", "$ref", "$roots", "$languages", "$schemaLocation"
HEAD = frozenset((LANGUAGES, PLACES, ROOTS, "$schema"))
"""The keys that may stand at the top of a file only."""

Place = object
"""Where something stands; only the stream that it comes from knows how to take it."""

Event = tuple[int, str, str, Place, Place]
"""What comes, under which key (empty in a list), what it says (empty for objects and lists), where the key or
the value begins, and, for an object or a list, where its bracket is, or for an end, what follows it."""


class Stream(Protocol):
    """Something that JSON can be read from, once."""

    @property
    def file(self) -> str:
        """What messages call the file."""

    def events(self) -> Iterator[Event]:
        """Yield what is said, in file order.

        Raises:
            UnreadableError: at the first place that is not JSON, or says a key twice, or is too deep.
        """

    def late(self, key: str) -> Iterator[Event] | None:
        """Return what the object that began last says under `$type` behind members that are no such keys.

        Of the object at the top, also what it says so under `$languages` and `$roots`. None: nothing.
        """

    def line(self, place: Place) -> int:
        """Return the line of a place, counted from 1."""

    def source(self, begin: Place, end: Place) -> str:
        """Return the text of an object, given its bracket and what follows it."""


def key_of(name: str) -> str:
    """Return the key under which a feature stands: a name that begins with a dollar sign has one more.

    >>> [key_of(name) for name in ("speed", "$speed")]
    ['speed', '$$speed']
    """
    return f"${name}" if name.startswith("$") else name


def is_own(key: str) -> bool:
    """Return whether a key is one of this form, and not the name of a feature.

    >>> [is_own(key) for key in ("$type", "$$type", "type")]
    [True, False, False]
    """
    return key[:1] == "$" and key[:2] != "$$"


def skip(event: Event, events: Iterator[Event]) -> int:
    """Go to the end of the object or list that an event begins; any other event is all there is.

    Returns:
        How many levels of objects and lists there were.
    """
    depth = deepest = 1 if event[0] in (OBJECT, LIST) else 0
    while depth:
        sort = next(events)[0]
        if sort >= OBJECT:
            depth += -1 if sort == END else 1
            deepest = max(deepest, depth)
    return deepest


def texts_in(event: Event, events: Iterator[Event]) -> dict[str, str] | None:
    """Return the texts of the object that an event begins; None where it is none, or says anything else."""
    if event[0] != OBJECT:
        skip(event, events)
        return None
    found: dict[str, str] = {}
    sound = True
    while (inner := next(events))[0] != END:
        sound &= inner[0] == TEXT
        found[inner[1]] = inner[2]
        skip(inner, events)
    return found if sound else None


_LONE = re.compile("[\ud800-\udfff]")


def quoted(text: str) -> str:
    """Return a text as JSON writes it; halves of surrogate pairs as escapes, since no UTF-8 holds them."""
    written = encode_basestring(text)
    return written if written.isascii() else _LONE.sub(lambda match: f"\\u{ord(match.group()):04x}", written)
