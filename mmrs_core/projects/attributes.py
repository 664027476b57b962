"""The values of attributes: initial ones, those that a drawing has, and those that the user gives."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import isfinite
from typing import TYPE_CHECKING

from mmrs_core.languages.element import Element, holds, metaclass_of
from mmrs_core.languages.metaclass import Metaclass

if TYPE_CHECKING:
    from mmrs_core.drawings.drawing import MapFeature
    from mmrs_core.languages.metaclass import Feature
    from mmrs_core.projects.kinds import Kind

_LONGEST = 80


def drawn_values(
    feature: MapFeature, kind: Kind, metaclass: Metaclass
) -> tuple[dict[str, object], list[str]]:
    """Return the properties of a feature that are attributes of an element, and notes on those that fail."""
    found: dict[str, object] = {}
    notes = []
    for name, value in feature.properties.items():
        attribute = name.removeprefix(f"{kind.name}.")
        if (name, kind.feature) == ("height", "obstacles"):
            attribute = "maxHeight"
        at = metaclass.by_name.get(attribute)
        if at is None or at.is_reference or at.name == "name" or value == kind.name:
            continue
        text = str(value).lower() if isinstance(value, bool) else str(value)
        try:
            if at.many:
                parts = re.split(r"(?<!\\), *", text)
                found[at.name] = [_parsed(at, part.replace("\\,", ",")) for part in parts]
            else:
                found[at.name] = _parsed(at, text)
        except ValueError:
            notes.append(f"its property {name} does not fit {at.name}")
    return found, notes


def asked_values(
    asked: Mapping[str, tuple[str, ...]], metaclass: Metaclass
) -> tuple[dict[str, object], list[str]]:
    """Return the values that the user gives, None for one to be left out, and what is wrong with them."""
    found: dict[str, object] = {}
    faults = []
    for name, texts in asked.items():
        try:
            at = metaclass.feature(name)
            values = [_parsed(at, text) for text in texts if text]
            found[name] = (values if at.many else values[-1]) if values else None
        except ValueError as fault:
            faults.append(str(fault))
    return found, faults


def decided(kind: Kind, given: Mapping[str, object]) -> set[str]:
    """Return the attributes that are given, and those that these exclude."""
    names = set(given)
    for group in kind.symbol.alternatives if kind.symbol is not None else ():
        if any(given.get(name) is not None for name in group):
            names |= group
    return names


def set_values(element: Element, kind: Kind, given: Mapping[str, object]) -> None:
    """Set the attributes of a new element: those given, and initial ones that these do not replace."""
    metaclass, names = metaclass_of(element), decided(kind, given)
    initial = kind.symbol.initial.items() if kind.symbol is not None else ()
    for name, value in (*((name, value) for name, value in initial if name not in names), *given.items()):
        if value is not None:
            setattr(element, metaclass.feature(name).attribute, value)


def missing(element: Element, kind: Kind) -> Iterator[str]:
    """Yield the attributes that an element must have and has not, with what they are."""
    for each in metaclass_of(element).features:
        if each.required and not each.is_reference and each.default is None and not holds(element, each):
            yield f"{kind.name} needs {each.name}: {each.documentation}"


def _parsed(at: Feature, text: str) -> object:
    if isinstance(at.type, Metaclass):
        raise ValueError(f"{at.name}: refers to another element, which is done in the model")
    try:
        value = at.type.parse(text)
    except ValueError as fault:
        raise ValueError(f"{at.name}={text[:_LONGEST]}: {fault}"[:300]) from None
    if isinstance(value, float) and not isfinite(value):
        raise ValueError(f"{at.name}={text[:_LONGEST]}: not a finite number")
    return value
