"""What elements say, in a form in which two of them can be compared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_core.languages.element import (
    Element,
    Unknown,
    contents,
    descendants,
    held,
    holds,
    label_of,
    path_of,
)
from mmrs_core.languages.json_form.layout import formatted
from mmrs_core.languages.json_form.unknown import UnknownObject, stated
from mmrs_core.languages.metaclass import Feature, Metaclass

Kind = tuple[str, str]


def kind_of(element: Element) -> Kind:
    """Return nsURI and name of an element's class, also where it is not installed."""
    if isinstance(element, Unknown):
        ns_uri, _, name = element._mmrs_type.rpartition("#")
        return ns_uri, name
    metaclass = type(element)._mmrs_metaclass
    return metaclass.key if metaclass is not None else ("", "")


def features_of(element: Element) -> Mapping[str, Feature]:
    """Return the features of an element by name; none where its class is not installed."""
    metaclass = type(element)._mmrs_metaclass
    return metaclass.by_name if metaclass is not None else {}


def identity_of(element: Element) -> str:
    """Return what tells an element from others of its class: its ids, its name; empty if it has none."""
    source = element._mmrs_source
    if source is not None and element in source.ids:
        return source.ids[element]
    for feature in features_of(element).values():
        if feature.is_id:
            return next((str(value) for value in held(element, feature)), "")
    return label_of(element) if not isinstance(element, Unknown) else ""


def said_by(element: Element, feature: Feature) -> tuple[str, ...] | None:
    """Return the values of an attribute as files write them; None if a file would not say them."""
    kind = feature.type
    if isinstance(kind, Metaclass) or not holds(element, feature):
        return None
    return tuple("null" if value is None else kind.render(value) for value in held(element, feature))


def attributes_of(element: Element) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the attributes that are set, by name, with their values as files write them."""
    for name, feature in features_of(element).items():
        said = said_by(element, feature) if feature.stored else None
        if said is not None:
            yield name, said


def raw_text(element: Element) -> str:
    """Return all that is known of an element whose class is not installed; else an empty text."""
    if isinstance(element, UnknownObject):
        return formatted(stated(element), 0)
    return element._mmrs_xml if isinstance(element, Unknown) else ""


def _marks(element: Element) -> Iterator[tuple[str, str]]:
    """Yield what tells the attributes that are set from others, at less cost than their texts."""
    for name, feature in features_of(element).items():
        if feature.stored and not feature.is_reference and holds(element, feature):
            yield name, repr(held(element, feature))


def fingerprints(root: Element) -> dict[int, int]:
    """Return a number for each element that equal subtrees share, references left out, by `id`."""
    found: dict[int, int] = {}
    for element in reversed([root, *descendants(root)]):
        inner = tuple(found[id(each)] for each in contents(element))
        said = (raw_text(element), *_marks(element))
        found[id(element)] = hash((kind_of(element), said, inner))
    return found


def paths_of(root: Element, lead: str = "") -> dict[int, str]:
    """Return the path of each element, by `id`, as `path_of` does one by one."""
    found = {id(root): lead or "/"}
    for element in (root, *descendants(root)):
        here = found[id(element)].rstrip("/")
        for name, feature in features_of(element).items():
            for index, value in enumerate(held(element, feature) if feature.containment else ()):
                found[id(value)] = f"{here}/{name}[{index}]" if feature.many else f"{here}/{name}"
    return found


def address_of(element: Element) -> str:
    """Return how messages call an element of another file."""
    source = element._mmrs_source
    return f"{source.file if source else ''}#{path_of(element)}"
