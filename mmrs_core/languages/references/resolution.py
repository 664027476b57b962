"""References from texts to elements, within a file and across files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Protocol

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import shown
from mmrs_core.languages.element import Element, Unknown, descendants, label_of, place_of
from mmrs_core.languages.links import raw, store
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft, Pending, Quick
from mmrs_core.languages.references.hidden import hidden_in, note_links
from mmrs_core.languages.references.hrefs import linked_file
from mmrs_core.languages.references.named import LONGEST_COMPARED, MOST_NAMED
from mmrs_core.languages.references.spelling import Name, is_address, quoted, references_in, spelt
from mmrs_core.languages.registry import Registry

_HELPED_FAULTS = 20
"""Looking for what was meant goes over the whole model; skipped beyond this many faults."""
_COMPARED_NAMES = 5_000
"""Comparing a misspelt name with so many takes a tenth of a second."""


class Library(Protocol):
    """Where the documents are that others refer to."""

    def open(self, path: Path) -> Draft:
        """Read another file, or return it when it was read before; UnreadableError if that cannot be."""

    def described(self, ns_uri: str) -> Draft:
        """Return the description of a metamodel that is at hand, as a model of Ecore."""

    def beside(self, draft: Draft) -> Iterable[Draft]:
        """Return the other files in which elements may be that a file refers to by name."""

    def opened(self, element: Element) -> Element:
        """Return an element of such a file as it is once the file is read, or of any other as it is."""


def resolve(
    draft: Draft, library: Library, root: Path | None, registry: Registry
) -> list[tuple[Pending, Element]]:
    """Set every reference of a file; what leads nowhere becomes a fault of that file.

    References by name, and what follows them in the same list, are left for `resolve_names`.

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
    late: set[tuple[Element, Feature]] = set()
    for reference in _left(pending, draft):
        many, key = reference.feature.many, (reference.element, reference.feature)
        for uri in references_in(reference.text, many):
            if isinstance(uri, Name):
                target: Element | str | None = draft.ids.get(uri.said, uri)
            else:
                target = _target(uri, reference, draft, library, root, registry)
            if target is None:
                continue
            if isinstance(target, str) or (late and key in late):
                late.add(key)
                draft.late.append((reference, target))
            elif _set(reference, target, draft):
                doubled.append((reference, target))
    note_links(draft)
    return doubled


def resolve_names(draft: Draft, library: Library, registry: Registry) -> list[tuple[Pending, Element]]:
    """Set the references that `resolve` has left; as that, once it has seen every file."""
    late, draft.late = draft.late, []
    doubled = []
    for reference, said in late:
        target = _named(said, reference, draft, library, registry) if isinstance(said, str) else said
        if target is not None and _set(reference, target, draft):
            doubled.append((reference, target))
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


def _target(
    uri: str, reference: Pending, draft: Draft, library: Library, root: Path | None, registry: Registry
) -> Element | str | None:
    """Return what a reference leads to, the text of one that may be a name, or None after a fault."""
    document, _, fragment = uri.rpartition("#") if "#" in uri else ("", "", uri)
    where = draft
    if document:
        opened = _opened(uri, reference, draft, library, root, registry)
        if opened is None:
            return None
        where = opened
    target = where.find(fragment or "/")
    if target is None and not reference.feature.containment:
        if not is_address(uri):
            return uri
        target = _hidden(uri, reference, draft, where, registry)
    if target is None:
        _nowhere(uri, reference, draft)
    return target


def _nowhere(uri: str, reference: Pending, draft: Draft, hint: str = "") -> None:
    message = f"{reference.feature.name}: {shown(uri)} leads to no element"
    _fault("XMI006", message, reference, draft, hint or _hint(uri, reference, draft))


def _named(
    name: str, reference: Pending, draft: Draft, library: Library, registry: Registry
) -> Element | None:
    """Return the element that a name means, in the file or else in one beside it; None after a fault."""
    feature = reference.feature
    kind = feature.type
    assert isinstance(kind, Metaclass)  # it is a reference
    found = draft.named().nearest(name, kind, reference.element)
    if not found:
        others = (each for other in library.beside(draft) for each in other.named().nearest(name, kind, None))
        found = list(islice(dict.fromkeys(others), MOST_NAMED + 1))
    if len(found) == 1:
        return library.opened(found[0])
    if found:
        _ambiguous(name, found, reference, draft)
        return None
    # of another class, as is said when it is set; or in what was not read
    other = draft.named().any(name) or _hidden(name, reference, draft, draft, registry)
    if other is None:
        _misspelt(name, reference, draft, library)
    return other


def _ambiguous(name: str, found: list[Element], reference: Pending, draft: Draft) -> None:
    listed = [f"{type(each).__name__} at {place_of(each)}" for each in found[:MOST_NAMED]]
    more = " and more" if len(found) > MOST_NAMED else ""
    message = f"{reference.feature.name}: {shown(name)} is the name of {', '.join(listed)}{more}"
    is_here = all(each._mmrs_source is draft.source for each in found)
    paths = " or ".join(each.eURIFragment() for each in found[:MOST_NAMED]) if is_here else ""
    _fault("XMI018", message, reference, draft, paths and f"rename one of them, or write the path: {paths}")


def _misspelt(name: str, reference: Pending, draft: Draft, library: Library) -> None:
    """Report a name of nothing, and which was probably meant."""
    kind = reference.feature.type
    assert isinstance(kind, Metaclass)  # it is a reference
    hint = ""
    if len(draft.diagnostics) < _HELPED_FAULTS and len(name) <= LONGEST_COMPARED:
        names = (each for other in (draft, *library.beside(draft)) for each in other.named().names(kind))
        known = list(islice(names, _COMPARED_NAMES))
        divided = [each for each in known if each != name and _is_divided(each, name, reference)]
        hint = f"in a list, write {quoted(divided[0])}" if divided else nearest(name, known)
    _nowhere(
        name, reference, draft, hint or f"write the name of a {kind.name}, or its path, such as //@tasks.0"
    )


def _is_divided(known: str, name: str, reference: Pending) -> bool:
    """Return whether a name is a part of a known one, which holds blanks and stands in the list."""
    return reference.feature.many and name in known.split() and known in reference.text


def _hidden(uri: str, reference: Pending, draft: Draft, where: Draft, registry: Registry) -> Element | None:
    """Return what stands inside an element that was not read; a fault where its language is not installed."""
    fragment = uri if isinstance(uri, Name) else uri.rpartition("#")[2]
    hidden = hidden_in(where, fragment, reference.claimed)
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


def _hint(uri: str, reference: Pending, draft: Draft) -> str:
    """Return how to write what was probably meant by an address that leads nowhere."""
    return _as_name(uri, reference, draft) or ("" if "/" in uri else "write a path, such as //@tasks.0")


def _as_name(uri: str, reference: Pending, draft: Draft) -> str:
    """Return how to write a name that was taken for an address; empty if nothing has that name."""
    feature, meant = reference.feature, (uri, uri.removeprefix("#"))
    if feature.containment or "/@" in uri or len(draft.diagnostics) >= _HELPED_FAULTS:
        return ""
    for root in draft.roots:
        for element in (root, *descendants(root)):
            if (name := label_of(element)) in meant and feature.type.accepts(element):
                return f"write {spelt(name, feature.many)}, the name of the {type(element).__name__}"
    return ""


def _opened(
    uri: str, reference: Pending, draft: Draft, library: Library, root: Path | None, registry: Registry
) -> Draft | None:
    """Return the file that an address leads to; None after a fault."""
    document = uri.rpartition("#")[0]
    if registry.has(document):
        return library.described(document)
    path = draft.source.path
    try:
        if path is None or root is None:
            raise ValueError(f"{document}: a text that is not a file cannot refer to files")
        real = linked_file(document, path.parent, root)
        return draft if real == path else library.open(_as_given(document, draft, real))
    except (ValueError, UnreadableError) as fault:
        code = "XMI007" if isinstance(fault, ValueError) else "XMI016"
        _fault(code, f"{reference.feature.name}: {fault}", reference, draft, _as_name(uri, reference, draft))
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
    draft.fault(code, message, reference.line, reference.element, hint, reference.feature)
