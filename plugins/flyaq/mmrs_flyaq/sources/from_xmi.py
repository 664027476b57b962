"""Nodes from XMI, without asking what the metamodel says."""

from __future__ import annotations

from mmrs_core.languages.xmi.events import XMI, XSI, Document
from mmrs_flyaq.sources.nodes import (
    DEEPEST_NESTING,
    STRAY,
    Claim,
    Link,
    SourceDocument,
    SourceNode,
    Text,
    too_deep,
)

_LOCATION = f"{XSI} schemaLocation"
_TYPES = (f"{XSI} type", f"{XMI} type")
_ID = f"{XMI} id"
_OF_THE_FORMAT = (f"{XMI} ", f"{XSI} ")
_WRAPPER = f"{XMI} XMI"


def parse_xmi(data: bytes, file: str) -> SourceDocument:
    """Return the elements of an XMI file, whatever language it is in.

    Raises:
        UnreadableError: if it is not well-formed, has a DOCTYPE, or nests deeper than 100 levels.
    """
    document = Document(data, file)
    listener = _Listener(document)
    document.parse(listener)
    return SourceDocument(file, tuple(listener.roots), tuple(listener.locations), listener.ids)


class _Listener:
    def __init__(self, document: Document) -> None:
        self._document = document
        self.roots: list[SourceNode] = []
        self.locations: list[tuple[str, str]] = []
        self.ids: dict[str, SourceNode] = {}
        self._open: list[SourceNode] = []
        self._words: list[str] = []
        self._wrapped = False

    def start(self, tag: str, attributes: list[str]) -> None:
        if len(self._open) >= DEEPEST_NESTING:
            raise too_deep(self._document.file, self._document.line)
        self._keep_stray(self._said())
        named = dict(zip(attributes[::2], attributes[1::2], strict=True))
        places = named.get(_LOCATION, "").split()
        self.locations += zip(places[::2], places[1::2], strict=False)
        if tag == _WRAPPER and not self._open:
            self._wrapped = True
            return
        self._begin(tag, named)

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        ns_uri, _, name = tag.rpartition(" ")
        node = SourceNode(self._document.file, self._document.line)
        if self._open:
            node.claim = self._claim(attributes)
            self._open[-1].add(name, node)
        else:
            node.claim = Claim(ns_uri, name)
            self.roots.append(node)
        self._open.append(node)
        for key, text in attributes.items():
            if key == _ID:
                self.ids.setdefault(text, node)
            elif not key.startswith(_OF_THE_FORMAT):
                node.add(key, Text(text, self._document.line))

    def _claim(self, attributes: dict[str, str]) -> Claim | None:
        kind = next((attributes[key] for key in _TYPES if key in attributes), "")
        prefix, _, name = kind.rpartition(":")
        return Claim(self._document.namespaces.uri(prefix) or prefix, name) if name else None

    def end(self, tag: str) -> None:
        if not self._open:
            return
        node, words, inner = self._open[-1], self._said(), len(self._open) > 1
        if inner and not node.values and node.claim is None and words:
            _instead(node, Text(words, node.line))
        else:
            self._keep_stray(words)
            if inner and node.claim is None and node.text("href"):
                _instead(node, Link(node.text("href"), node.line))
        self._open.pop()

    def text(self, text: str) -> None:
        self._words.append(text)

    def _said(self) -> str:
        """Return the text since the last tag."""
        words = "".join(self._words).strip()
        self._words.clear()
        return words

    def _keep_stray(self, words: str) -> None:
        if words and self._open:
            self._open[-1].add(STRAY, Text(words, self._document.line))


def _instead(node: SourceNode, value: Text | Link) -> None:
    """Let an element that only spells out a value or a reference be that value."""
    assert node.parent is not None  # the root is never replaced
    node.parent.values[node.feature][node.index] = value
