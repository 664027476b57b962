"""Where a model says that its metamodels lie: by ``xsi:schemaLocation``, or ``$schemaLocation`` in JSON."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from mmrs_core.languages.json_form.reader import PLACES
from mmrs_core.languages.json_form.tree import Node, Tree, is_json
from mmrs_core.languages.xmi.events import XSI, Document, read_bytes

_SCHEMA_LOCATION = f"{XSI} schemaLocation"


class _SeenError(Exception):
    """Enough of a document was read."""


class _Top:
    """Listens to the root of a document, and to nothing after it."""

    def __init__(self) -> None:
        self.words: list[str] = []

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the root's attributes and stop."""
        named = dict(zip(attributes[::2], attributes[1::2], strict=True))
        self.words = named.get(_SCHEMA_LOCATION, "").split()
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


def _in_xmi(data: bytes, file: str) -> Mapping[str, str]:
    top = _Top()
    with suppress(_SeenError):
        Document(data, file).parse(top)
    return dict(zip(top.words[::2], top.words[1::2], strict=False))


def _in_json(data: bytes, file: str) -> Mapping[str, str]:
    top = Tree(data, file).top
    places = top.members.get(PLACES) if isinstance(top, Node) else None
    if not isinstance(places, Node):
        return {}
    return {ns_uri: place for ns_uri, place in places.members.items() if isinstance(place, str)}
