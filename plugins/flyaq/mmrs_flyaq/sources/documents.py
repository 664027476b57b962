"""Source files, in XMI or JSON, as documents of nodes."""

from __future__ import annotations

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.json_form.tree import Node as Object
from mmrs_core.languages.json_form.tree import Tree
from mmrs_core.languages.metamodels.ecore_file import EcoreFile
from mmrs_core.languages.missing import is_own
from mmrs_core.languages.xmi.events import XMI, XSI, Document, read_bytes
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


CLASS = "eClass"
REFERENCE = "$ref"
NAMESPACES = "@ns"


def node_of(tree: Tree, value: Object) -> SourceNode:
    """Return the element that an object describes.

    Raises:
        UnreadableError: if it nests deeper than 100 levels.
    """
    return _Reader(tree, _namespaces(value)).node(value, 0)


def text_in(value: Object, key: str) -> str:
    """Return the text of a member, or an empty one where it is missing or something else."""
    found = value.members.get(key)
    return found if isinstance(found, str) else ""


def claim_of(text: str, namespaces: Mapping[str, str]) -> Claim | None:
    """Return the class that a text names; None for an empty one.

    >>> claim_of("shop://Order", {"shop": "http://shop"})
    Claim(document='http://shop', name='Order')
    >>> claim_of("file:/C:/models/shop.ecore#//Order", {}).document
    'file:/C:/models/shop.ecore'
    """
    document, _, name = text.rpartition("//")
    if not name:
        return None
    if document.endswith(":"):
        return Claim(namespaces.get(document[:-1], document[:-1]), name)
    return Claim(document.removesuffix("#"), name)


def _namespaces(value: Object) -> dict[str, str]:
    declared = value.members.get(NAMESPACES)
    members = declared.members if isinstance(declared, Object) else {}
    return {prefix: uri for prefix, uri in members.items() if isinstance(uri, str)}


class _Reader:
    def __init__(self, tree: Tree, namespaces: Mapping[str, str]) -> None:
        self._tree = tree
        self._namespaces = namespaces

    def node(self, value: Object, depth: int) -> SourceNode:
        if depth > DEEPEST_NESTING:
            raise too_deep(self._tree.file, value.line)
        node = SourceNode(self._tree.file, value.line, claim_of(text_in(value, CLASS), self._namespaces))
        for key, member in value.members.items():
            if key not in (CLASS, NAMESPACES):
                self._add(node, key, member, self._tree.line_of(value, key), depth)
        return node

    def _add(self, node: SourceNode, key: str, value: object, line: int, depth: int) -> None:
        match value:
            case list():
                for item in value:
                    self._add(node, key, item, line, depth + 1)
            case Object() if REFERENCE in value.members:
                node.add(key, Link(text_in(value, REFERENCE), value.line))
            case Object():
                node.add(key, self.node(value, depth + 1))
            case bool():
                node.add(key, Text("true" if value else "false", line))
            case str():
                node.add(key, Text(str(value), line))


@dataclass(frozen=True, slots=True)
class KnownDocument:
    """A file that is recognised by its form.

    Attributes:
        name: what it is called.
        under: the key of the root object that tells it, or empty.
        keys: the keys that every item of the list has.
        holds: whether models stand in the list.
    """

    name: str
    under: str
    keys: tuple[str, ...]
    holds: bool


@dataclass(frozen=True, slots=True)
class Opened:
    """A file that was opened.

    Attributes:
        what: what it is called: "a model", "a metamodel", or as the mapping says.
        document: its elements; None where there is nothing to migrate.
        form: as which it was recognised; None where its elements state their classes.
    """

    file: str
    what: str
    document: SourceDocument | None = None
    form: KnownDocument | None = None


def open_document(path: Path, known: Iterable[KnownDocument]) -> Opened:
    """Return what a file is.

    Raises:
        UnreadableError: if it cannot be read, is neither XML nor JSON, or is of no known form.
    """
    return open_text(read_bytes(path), str(path), known)


def open_text(data: bytes, file: str, known: Iterable[KnownDocument]) -> Opened:
    """Return what the text of a file is; errors as in `open_document`."""
    start = first_letter(data)
    if start in ("{", "["):
        return _json(Tree(data, file), known)
    if start != "<":
        reason = "its root is neither an object nor a list" if is_json(file) else "neither XML nor JSON"
        raise UnreadableError(f"{file}:1: {reason}")
    document = parse_xmi(data, file)
    claims = [root.claim for root in document.roots]
    if any(claim is not None and claim.document == ECORE for claim in claims):
        named = ", ".join(EcoreFile(data, file).ns_uris)
        return Opened(file, f"a metamodel, {named}: nothing to migrate")
    if all(claim is not None and is_own(claim.document) for claim in claims):
        return Opened(file, "already a model of MMRS: nothing to migrate")
    return Opened(file, "a model", document)


def first_letter(data: bytes) -> str:
    """Return the first letter that is not a blank, whichever Unicode encoding the text is in."""
    letters = data[:4096].translate(None, b"\0").removeprefix(BOM_UTF8)
    for mark in (BOM_UTF16_LE, BOM_UTF16_BE):
        letters = letters.removeprefix(mark)
    return letters.lstrip()[:1].decode("latin-1")


def _json(tree: Tree, known: Iterable[KnownDocument]) -> Opened:
    top = tree.top
    if isinstance(top, Object) and text_in(top, CLASS):
        return Opened(tree.file, "a model", _document(tree, (top,)))
    for form in known:
        items = _items_of(top, form)
        if items and form.holds:
            return Opened(tree.file, form.name, _document(tree, items), form)
        if items:
            return Opened(tree.file, f"{form.name}: nothing to migrate", None, form)
    if isinstance(top, Object) and text_in(top, "nsURI"):
        return Opened(tree.file, f"a metamodel, {text_in(top, 'nsURI')}: nothing to migrate")
    message = f"not a model: the root has no {CLASS!r}, and is not a list that the mapping knows"
    raise UnreadableError(f"{tree.file}: {message}")


def _document(tree: Tree, items: Iterable[Object]) -> SourceDocument:
    return SourceDocument(tree.file, tuple(node_of(tree, item) for item in items))


def _items_of(value: object, form: KnownDocument) -> tuple[Object, ...]:
    """Return the items of a list of that form; none where the value is of another."""
    if form.under:
        value = value.members.get(form.under) if isinstance(value, Object) else None
    items = value if isinstance(value, list) else []
    objects = tuple(item for item in items if isinstance(item, Object))
    fits = len(objects) == len(items) and all(key in item.members for item in objects for key in form.keys)
    return objects if fits else ()
