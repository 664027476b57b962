"""Where a model says that its metamodels lie: by ``xsi:schemaLocation``, or ``$schemaLocation`` in JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

from mmrs_core.languages.evolution.migrating import class_of
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.json_form.stream import (
    END,
    LANGUAGES,
    LIST,
    OBJECT,
    PLACES,
    ROOTS,
    TEXT,
    TYPE,
    Event,
    is_own,
    skip,
    texts_in,
)
from mmrs_core.languages.json_form.text import Text
from mmrs_core.languages.json_form.tree import Node
from mmrs_core.languages.xmi.events import XMI, XSI, Document, read_bytes

_SCHEMA_LOCATION = f"{XSI} schemaLocation"
_WRAPPER = f"{XMI} XMI"


class _SeenError(Exception):
    """Enough of a document was read."""


class _Top:
    """Listens to the first element of a model, and to nothing after it."""

    def __init__(self) -> None:
        self.words: list[str] = []
        self.kind = ("", "")

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take its class and where its metamodels are; stop, unless more elements like it may follow."""
        named = dict(zip(attributes[::2], attributes[1::2], strict=True))
        self.words += named.get(_SCHEMA_LOCATION, "").split()
        if tag != _WRAPPER:
            ns_uri, _, name = tag.rpartition(" ")
            self.kind = ns_uri, name
            raise _SeenError

    def end(self, tag: str) -> None:
        """Take nothing."""

    def text(self, text: str) -> None:
        """Take nothing."""


def stated_places(path: Path) -> Mapping[str, str]:
    """Return where a model's metamodels lie, by nsURI, as the file says it.

    Raises:
        UnreadableError: if the file is missing or not well-formed.
    """
    data = read_bytes(path)
    return _in_json(data, str(path)) if is_json(path.name) else _in_xmi(data, str(path))


def first_kind(path: Path) -> tuple[str, str]:
    """Return nsURI and name of the class that the first element of a model claims to be of.

    Raises:
        UnreadableError: if the file is missing, or not well-formed up to there.
    """
    data = read_bytes(path)
    if not is_json(path.name):
        return first_kind_in_xmi(data, str(path))
    return _kind_in_json(Text(data, str(path)))


def first_kind_in_xmi(data: bytes, file: str) -> tuple[str, str]:
    """Return the same of the text of an XMI file; errors as in `first_kind`."""
    return _top_of(data, file).kind


def _kind_in_json(text: Text) -> tuple[str, str]:
    """Return the class of the first element of a JSON file, read no further than needed."""
    claimed, languages = "", dict[str, str]()
    events = text.events()
    if next(events)[0] != OBJECT:
        return "", ""
    ordered = all(text.late(key) is None for key in (LANGUAGES, ROOTS, TYPE))
    for event in events:
        if event[1] == LANGUAGES:
            languages = texts_in(event, events) or {}
        elif event[1] == ROOTS and event[0] == LIST:
            claimed = _first_type(events)
        elif ordered and not is_own(event[1]):
            break
        else:
            claimed = event[2] if event[:2] == (TEXT, TYPE) else claimed
            skip(event, events)
    return class_of(Node({TYPE: claimed}), languages)


def _first_type(events: Iterator[Event]) -> str:
    """Return what the first object of a list says to be, and go to the end of the list."""
    found: list[str] = []
    while (event := next(events))[0] != END:
        if event[0] != OBJECT or found:
            skip(event, events)
            continue
        found = [""]
        while (member := next(events))[0] != END:
            found = [member[2]] if member[:2] == (TEXT, TYPE) else found
            skip(member, events)
    return found[0] if found else ""


def _in_xmi(data: bytes, file: str) -> Mapping[str, str]:
    words = _top_of(data, file).words
    return dict(zip(words[::2], words[1::2], strict=False))


def _top_of(data: bytes, file: str) -> _Top:
    top = _Top()
    with suppress(_SeenError):
        Document(data, file).parse(top)
    return top


def _in_json(data: bytes, file: str) -> Mapping[str, str]:
    text = Text(data, file)
    if f'"{PLACES}"'.encode() not in text.data:
        return {}
    events = text.events()
    next(events)
    for event in events:
        if event[1] == PLACES:
            return texts_in(event, events) or {}
        skip(event, events)
    return {}
