"""What elements say, in a form in which two of them can be compared."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from os.path import relpath
from pathlib import Path

from mmrs_core.languages.element import Element, Unknown, held, holds, label_of, path_of
from mmrs_core.languages.json_form.tree import formatted
from mmrs_core.languages.json_form.unknown import UnknownObject, stated
from mmrs_core.languages.metaclass import Feature, Metaclass

Kind = tuple[str, str]
Slot = tuple[Feature, Callable[[Element], object]]
"""A feature, and what gets its bare slot; that raises AttributeError where it is empty."""

_KEPT = 4096


@dataclass(frozen=True, slots=True)
class Traits:
    """A class, whose metamodel may be missing: then nothing is known of its features.

    Attributes:
        kind: nsURI and name.
        features: by name.
        attributes: those that files hold.
        inside: those that contain elements.
        targets: those, and all other references that files hold but those to the container.
        identifier: the attribute that tells elements from each other, if there is one.
    """

    kind: Kind = ("", "")
    features: Mapping[str, Feature] = field(default_factory=dict)
    attributes: tuple[Slot, ...] = ()
    inside: tuple[Slot, ...] = ()
    targets: tuple[Slot, ...] = ()
    identifier: Feature | None = None


@lru_cache(_KEPT)
def traits_of(made: type[Element]) -> Traits:
    """Return the traits of a class of elements."""
    metaclass = made._mmrs_metaclass
    return Traits() if metaclass is None else _traits(metaclass, made)


def _traits(metaclass: Metaclass, made: type[Element]) -> Traits:
    slots = [(each, made._mmrs_slots[each.attribute].__get__) for each in metaclass.features]
    inside = tuple(slot for slot in slots if slot[0].containment)
    references = [slot for slot in slots if slot[0].is_reference and slot[0].stored]
    links = tuple(slot for slot in references if not (slot[0].containment or slot[0].is_container))
    return Traits(
        metaclass.key,
        metaclass.by_name,
        tuple(slot for slot in slots if slot[0].stored and not slot[0].is_reference),
        inside,
        inside + links,
        next((feature for feature in metaclass.by_name.values() if feature.is_id), None),
    )


def values_in(element: Element, slot: Slot) -> list[Element]:
    """Return the elements that a feature holds now."""
    try:
        value = slot[1](element)
    except AttributeError:
        return []
    if isinstance(value, list):
        return value  # they are not changed here
    return [value] if isinstance(value, Element) else []


_TAG = re.compile(r"""<[^<>"']*(?:"[^"]*"[^<>"']*|'[^']*'[^<>"']*)*>""")
_BLANKS = re.compile(r"""("[^"]*"|'[^']*')|\s+""")
_BEFORE_END = re.compile(r" (/?>)\Z")
_BETWEEN = re.compile(r">\s+<")
_SINGLE = frozenset((str, float, int, bool))


def kind_of(element: Element) -> Kind:
    """Return nsURI and name of an element's class, also where it is not installed."""
    if isinstance(element, Unknown):
        ns_uri, _, name = element._mmrs_type.rpartition("#")
        return ns_uri, name
    return traits_of(element.__class__).kind


def features_of(element: Element) -> Mapping[str, Feature]:
    """Return the features of an element by name; none where its class is not installed."""
    return traits_of(element.__class__).features


def identity_of(element: Element) -> str:
    """Return what tells an element from others of its class: its ids, its name; empty if it has none."""
    source = element._mmrs_source
    if source is not None and source.ids and element in source.ids:
        return source.ids[element]
    identifier = traits_of(element.__class__).identifier
    if identifier is not None:
        return next((str(value) for value in held(element, identifier)), "")
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
    """Return all that is known of an element whose class is not installed; otherwise an empty text.

    How its file lays it out does not count.
    """
    if isinstance(element, UnknownObject):
        return formatted(stated(element), 0)
    return _on_one_line(element._mmrs_xml) if isinstance(element, Unknown) else ""


def _on_one_line(xml: str) -> str:
    """Return XML without what only lays it out: blanks between tags, and more than one between attributes.

    >>> _on_one_line('<a x="1  2"   y="3 >" >  <b /></a>')
    '<a x="1  2" y="3 >"><b/></a>'
    """
    return _BETWEEN.sub("><", _TAG.sub(_closely, xml))


def _closely(tag: re.Match[str]) -> str:
    return _BEFORE_END.sub(r"\1", _BLANKS.sub(lambda part: part[1] or " ", tag.group()))


def _marks(element: Element, traits: Traits) -> list[object]:
    """Return what tells the attributes that are set from others, at less cost than their texts."""
    marks: list[object] = []
    for feature, read in traits.attributes:
        try:
            value = read(element)
        except AttributeError:
            continue
        if value.__class__ in _SINGLE and value != feature.default:
            # the hash of a float does not tell 0.0 from -0.0, nor one NaN from the same
            reported = value if value.__class__ is not float or (value and value == value) else repr(value)
            marks += (feature.name, reported)
        elif holds(element, feature):
            marks += (feature.name, repr(held(element, feature)))
    return marks


def fingerprints(elements: Sequence[Element]) -> dict[int, int]:
    """Return a number for each element that equal subtrees share, references left out, by `id`.

    Args:
        elements: in document order, with all that is inside them.
    """
    found: dict[int, int] = {}
    for element in reversed(elements):
        traits = traits_of(element.__class__)
        inner = [found[id(each)] for slot in traits.inside for each in values_in(element, slot)]
        known = traits.kind if traits.kind[1] else (kind_of(element), raw_text(element))
        found[id(element)] = hash((known, *_marks(element, traits), None, *inner))
    return found


class Paths(dict[int, str]):
    """The path of each element of a model that is asked for, by `id`, as `path_of` has it."""

    def __init__(self, roots: Sequence[Element]) -> None:
        """Take the roots; where there are several, each path begins with the number of one."""
        super().__init__()
        for index, root in enumerate(roots):
            self[id(root)] = f"/{index}" if len(roots) > 1 else "/"

    def of(self, element: Element) -> str:
        """Return the path of an element of the model."""
        chain = [element]
        while id(chain[-1]) not in self:
            container = chain[-1]._mmrs_container
            assert container is not None  # it is not a root
            chain.append(container)
        for outer in chain[:0:-1]:
            self._enter(outer)
        return self[id(element)]

    def _enter(self, outer: Element) -> None:
        """Work out the paths of all elements directly inside another."""
        begin = self[id(outer)].rstrip("/")
        for slot in traits_of(outer.__class__).inside:
            name, many = slot[0].name, slot[0].many
            for index, each in enumerate(values_in(outer, slot)):
                self[id(each)] = f"{begin}/{name}[{index}]" if many else f"{begin}/{name}"


def address_of(element: Element, referrer: Element) -> str:
    """Return how messages call an element of another file than that of what refers to it.

    The file is named as from the referrer's folder, without ending: of two projects, in whatever form, those
    that say the same refer to the same.
    """
    source, home = element._mmrs_source, referrer._mmrs_source
    if source is None or source.path is None or home is None or home.path is None:
        return f"{source.file if source else ''}#{path_of(element)}"
    way = Path(relpath(source.path, home.path.parent)).with_suffix("").as_posix()
    return f"{way}#{path_of(element)}"
