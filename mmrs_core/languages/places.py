"""Where a model says that its metamodels lie: by ``xsi:schemaLocation``, or ``$schemaLocation`` in JSON."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from mmrs_core.languages.evolution.migrating import class_of
from mmrs_core.languages.json_form.reader import LANGUAGES, PLACES, ROOTS
from mmrs_core.languages.json_form.tree import Node, Tree, is_json
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
        """Take what it is and says of its metamodels; stop, unless more elements like it may follow."""
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
        return _top_of(data, str(path)).kind
    top = Tree(data, str(path)).top
    listed = top.members.get(ROOTS, [top]) if isinstance(top, Node) else []
    prefixes = top.members.get(LANGUAGES) if isinstance(top, Node) else None
    languages = {k: str(v) for k, v in prefixes.members.items()} if isinstance(prefixes, Node) else {}
    roots = [each for each in listed if isinstance(each, Node)] if isinstance(listed, list) else []
    return class_of(roots[0], languages) if roots else ("", "")


def _in_xmi(data: bytes, file: str) -> Mapping[str, str]:
    words = _top_of(data, file).words
    return dict(zip(words[::2], words[1::2], strict=False))


def _top_of(data: bytes, file: str) -> _Top:
    top = _Top()
    with suppress(_SeenError):
        Document(data, file).parse(top)
    return top


def _in_json(data: bytes, file: str) -> Mapping[str, str]:
    top = Tree(data, file).top
    places = top.members.get(PLACES) if isinstance(top, Node) else None
    if not isinstance(places, Node):
        return {}
    return {ns_uri: place for ns_uri, place in places.members.items() if isinstance(place, str)}
