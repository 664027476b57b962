"""Copies of elements."""

from __future__ import annotations

from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.registry import Registry


def copied(element: Element, registry: Registry) -> Element:
    """Return an element that says the same as another, with copies of what that one contains."""
    found = registry.create(*metaclass_of(element).key)
    for feature in metaclass_of(element).features:
        if feature.is_container or not feature.stored:
            continue
        values = [_value(each, feature.containment, registry) for each in held(element, feature)]
        if feature.many:
            getattr(found, feature.attribute).extend(values)
        elif values:
            setattr(found, feature.attribute, values[0])
    return found


def _value(value: object, contained: bool, registry: Registry) -> object:
    return copied(value, registry) if contained and isinstance(value, Element) else value
