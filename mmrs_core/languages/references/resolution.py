"""References from texts to elements, within a file and across files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Protocol

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import shown
from mmrs_core.languages.element import Element, Unknown, descendants, label_of
from mmrs_core.languages.links import raw, store
from mmrs_core.languages.metaclass import Feature
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.references.addresses import Addresses
from mmrs_core.languages.references.documents import Draft, Pending, Quick
from mmrs_core.languages.references.hidden import hidden_in, note_links
from mmrs_core.languages.references.hrefs import linked_file
from mmrs_core.languages.registry import Registry

_BLANKS = re.compile("[ \t\n\r\f]+")
"""What stands between references; others may stand in an identifier."""

_HELPED_FAULTS = 20
"""Looking for what was meant goes over the whole model; skipped beyond this many faults."""


class Library(Protocol):
    """Where the documents are that others refer to."""

    def open(self, path: Path) -> Draft:
        """Read another file, or return it when it was read before; UnreadableError if that cannot be."""

    def described(self, ns_uri: str) -> Draft:
        """Return the description of a metamodel that is at hand, as a model of Ecore."""


def resolve(
    draft: Draft, library: Library, root: Path | None, registry: Registry
) -> list[tuple[Pending, Element]]:
    """Set every reference of a file; what leads nowhere becomes a fault of that file.

    Args:
        draft: the file; its pending references are emptied.
        library: where the documents are that it refers to.
        root: the folder that references must not leave; None where there are no files.
        registry: the metamodels that are installed.

    Returns:
        The references whose other ends are to be notified, with their targets, once all files are read.
    """
    pending, draft.pending = draft.pending, []
    doubled = []
    for reference in _left(pending, draft):
        for uri in _uris(reference.text):
            target = _target(uri, reference, draft, library, root, registry)
            if target is not None and _set(reference, target, draft):
                doubled.append((reference, target))
    note_links(draft)
    return doubled


def tell_other_ends(draft: Draft, doubled: Iterable[tuple[Pending, Element]]) -> None:
    """Make the other ends of a file's references know of them; a contradiction becomes a fault of it."""
    known: dict[int, set[int]] = {}
    for reference, target in doubled:
        _tell_other_end(reference, target, draft, known)


def _left(pending: Iterable[Pending | Quick], draft: Draft) -> Iterator[Pending]:
    """Set the references whose text is one path into a list, to an element that they take; yield all others.

    This runs for nearly every reference of a large model, hence makes no calls of its own.
    """
    lists = draft.lists
    for reference in pending:
        if not isinstance(reference, tuple):
            yield reference
            continue
        element, feature, text, _ = reference
        head, _, index = text.rpartition(".")
        values = lists.get(head) or draft.list_at(head)
        if index.isdecimal() and index.isascii() and len(index) < 10 and (at := int(index)) < len(values):
            target = values[at]
            if isinstance(target, feature.type.interface):  # type: ignore[union-attr]  # it is a reference
                if feature.many:
                    getattr(element, feature.attribute).append(target)
                else:
                    setattr(element, feature.attribute, target)
                continue
        yield Pending(*reference)


def _uris(text: str) -> Iterator[str]:
    """Yield the URIs in a text, without the types that may stand before references to other files."""
    words = [word for word in _BLANKS.split(text) if word]
    for index, word in enumerate(words):
        following = words[index + 1] if index + 1 < len(words) else ""
        if not (":" in word and "#" not in word and not word.startswith("/") and "#" in following):
            yield word


def _target(
    uri: str, reference: Pending, draft: Draft, library: Library, root: Path | None, registry: Registry
) -> Element | None:
    document, _, fragment = uri.rpartition("#") if "#" in uri else ("", "", uri)
    where = draft
    if document:
        opened = _opened(document, reference, draft, library, root, registry)
        if opened is None:
            return None
        where = opened
    target = where.find(fragment or "/")
    if target is None and not reference.feature.containment:
        target = _hidden(uri, reference, draft, where, registry)
    if target is None:
        _fault(
            "XMI006",
            f"{reference.feature.name}: {shown(uri)} leads to no element",
            reference,
            draft,
            _hint(uri, reference.feature, draft),
        )
    return target


def _hidden(uri: str, reference: Pending, draft: Draft, where: Draft, registry: Registry) -> Element | None:
    """Return what stands inside an element that was not read; a fault where its language is not installed."""
    hidden = hidden_in(where, uri.rpartition("#")[2], reference.claimed)
    if hidden is None:
        return None
    ns_uri, _, name = hidden._mmrs_outer._mmrs_type.rpartition("#")
    if ns_uri and not registry.has(ns_uri):
        message = (
            f"{reference.feature.name}: leads into a {name} of {ns_uri}, which is not installed: {shown(uri)}"
        )
        hint = hint_for(ns_uri, registry, "the reference is kept as it is")
        draft.fault("XMI001", message, reference.line, reference.element, hint)
    return hidden


def _hint(uri: str, feature: Feature, draft: Draft) -> str:
    """Return the path of what was probably meant: people write names where XMI wants paths."""
    if "/" in uri or len(draft.diagnostics) >= _HELPED_FAULTS:
        return ""
    for root in draft.roots:
        for element in (root, *descendants(root)):
            if feature.type.accepts(element) and label_of(element) == uri:
                path = Addresses(draft.roots, None).fragment(element)
                return f"write {path}, the path of the {type(element).__name__} {uri!r}"
    return "write the path of an element, such as //@tasks.0"


def _opened(
    document: str,
    reference: Pending,
    draft: Draft,
    library: Library,
    root: Path | None,
    registry: Registry,
) -> Draft | None:
    if registry.has(document):
        return library.described(document)
    path = draft.source.path
    if path is None or root is None:
        message = f"{reference.feature.name}: {document}: a text that is not a file cannot refer to files"
        _fault("XMI007", message, reference, draft)
        return None
    try:
        real = linked_file(document, path.parent, root)
        return draft if real == path else library.open(_as_given(document, draft, real))
    except ValueError as fault:
        _fault("XMI007", f"{reference.feature.name}: {fault}", reference, draft)
    except UnreadableError as fault:
        _fault("XMI016", f"{reference.feature.name}: {fault}", reference, draft)
    return None


def _as_given(document: str, draft: Draft, real: Path) -> Path:
    """Return the path in the terms in which the user named the referring file, where that is the same."""
    given = Path(draft.source.file).parent / document
    return given if given.resolve() == real else real


def _set(reference: Pending, target: Element, draft: Draft) -> bool:
    """Put the target into the reference; return whether the other end has to be notified."""
    element, feature = reference.element, reference.feature
    if isinstance(target, Unknown):
        draft.broken.add((element, feature.name))
    elif not feature.type.accepts(target):
        label = label_of(target)
        what = f"{type(target).__name__}{label and f' {label!r}'}"
        message = f"{feature.name}: leads to the {what}, not to a {feature.type.name}"
        _fault("XMI008", message, reference, draft)
        return False
    if feature.containment:
        return _contain(reference, target, draft)
    if feature.many:
        values = getattr(element, feature.attribute)
        values.put(target) if feature.linked else values.append(target)
        return feature.linked
    if raw(element, feature) not in (None, target):
        _fault("XMI009", f"{feature.name}: refers to more than one element, takes one", reference, draft)
        return False
    type(element)._mmrs_slots[feature.attribute].__set__(element, target)
    return feature.linked


def _contain(reference: Pending, target: Element, draft: Draft) -> bool:
    """Contain the root of another file, which stays in that file."""
    element, feature = reference.element, reference.feature
    try:
        if target._mmrs_container is not None:
            raise ValueError(f"{feature.name}: leads to an element that stands elsewhere already")
        if feature.many:
            getattr(element, feature.attribute).append(target)
        else:
            setattr(element, feature.attribute, target)
    except ValueError as fault:
        _fault("XMI017", str(fault), reference, draft)
    return False


def _tell_other_end(reference: Pending, target: Element, draft: Draft, known: dict[int, set[int]]) -> None:
    """Notify one other end; what each list held before is `known`, so that no list is searched again."""
    element, opposite = reference.element, reference.feature.opposite
    if opposite is None or opposite.attribute not in type(target)._mmrs_slots:
        return
    present = raw(target, opposite)
    if opposite.containment:
        if element._mmrs_container is not target:
            message = f"{reference.feature.name}: leads to an element that does not contain this one"
            _fault("XMI013", message, reference, draft)
    elif opposite.many:
        values = getattr(target, opposite.attribute)
        there = known.get(id(values))
        if there is None:
            there = known[id(values)] = set(map(id, values))
        if id(element) not in there:
            there.add(id(element))
            values.put(element)
    elif present is None:
        store(target, opposite, element)
    elif present is not element:
        message = f"{reference.feature.name}: the other end, {opposite.name}, refers to another element"
        _fault("XMI013", message, reference, draft)


def _fault(code: str, message: str, reference: Pending, draft: Draft, hint: str = "") -> None:
    draft.fault(code, message, reference.line, reference.element, hint)
    draft.broken.add((reference.element, reference.feature.name))
