"""What is asked of every element of a class to compare it, worked out once for the class."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from mmrs_core.languages.element import Element
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
