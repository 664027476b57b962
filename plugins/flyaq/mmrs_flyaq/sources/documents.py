"""What a file is: models of a dialect, one of its metamodels, or something that holds nothing to migrate."""

from __future__ import annotations

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.json_form.tree import Node as Object
from mmrs_core.languages.json_form.tree import Tree
from mmrs_core.languages.metamodels.ecore_file import EcoreFile
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_flyaq.sources.from_json import CLASS, node_of, text_in
from mmrs_flyaq.sources.from_xmi import parse_xmi
from mmrs_flyaq.sources.nodes import SourceDocument


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
