"""The values of attributes: initial ones, those that a drawing has, and those that the user gives."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import isfinite
from typing import TYPE_CHECKING, cast

from mmrs_core.drawings.drawing import MapFeature, Role
from mmrs_core.languages.element import Element, holds, metaclass_of
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.projects.kinds import Kind, refers

if TYPE_CHECKING:
    from mmrs_core.languages.metaclass import Feature
    from mmrs_core.languages.registry import Registry

_LONGEST = 80
_INNER = re.compile(r"(?P<list>\w+)\[(?P<number>\d{1,4})\]\.(?P<name>\w+)")


def drawn_values(
    feature: MapFeature, kind: Kind, metaclass: Metaclass, registry: Registry
) -> tuple[dict[str, object], list[str]]:
    """Return the properties of a feature that are attributes of an element, and notes on those that fail.

    Those of an element in it are called, for example, ``parameters[0].key``.
    """
    found: dict[str, object] = {}
    notes, unused = list[str](), list[str]()
    parts: dict[tuple[Feature, int], Element] = {}
    for name, value in feature.properties.items():
        inner = _INNER.fullmatch(name)
        at = metaclass.by_name.get(inner["list"]) if inner is not None else None
        if inner is not None and at is not None and at.containment and isinstance(at.type, Metaclass):
            own = at.type.by_name.get(inner["name"])
            if at.type.abstract or own is None or own.is_reference:
                notes.append(f"its property {name} is left out")
                continue
            key = at, int(inner["number"])
            part = parts[key] = parts.get(key) or registry.create(*at.type.key)
            try:
                setattr(part, own.attribute, _parsed(own, _text(value)))
            except ValueError:
                notes.append(f"its property {name} does not fit {own.name}")
            continue
        attribute = name.removeprefix(f"{kind.name}.")
        if (name, kind.feature) == ("height", "obstacles"):
            attribute = "maxHeight"
        at = metaclass.by_name.get(attribute)
        if at is None and feature.role in (Role.SURVEY, Role.CORRIDOR, Role.STRUCTURE):
            unused.append(name)
        if at is None or at.is_reference or at.name == "name" or value == kind.name:
            continue
        try:
            if at.many:
                texts = re.split(r"(?<!\\), *", _text(value))
                found[at.name] = [_parsed(at, text.replace("\\,", ",")) for text in texts]
            else:
                found[at.name] = _parsed(at, _text(value))
        except ValueError:
            notes.append(f"its property {name} does not fit {at.name}")
    for (at, _), part in sorted(parts.items(), key=lambda each: each[0][1]):
        found[at.name] = [*cast("list[Element]", found.get(at.name, [])), part] if at.many else part
    if unused:
        notes.append(f"{kind.name} has no {', '.join(unused)}")
    return found, notes


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def named_in(feature: MapFeature, kind: Kind, asked: Mapping[str, tuple[str, ...]]) -> dict[str, list[str]]:
    """Return the names of elements that a new one is to refer to, by reference."""
    found: dict[str, list[str]] = {}
    for at in kind.metaclass.features if kind.metaclass is not None else ():
        if refers(at):
            drawn = str(feature.properties.get(at.name, "")) if feature.role is Role.TASK else ""
            texts = asked.get(at.name) or (re.split(r"(?<!\\), *", drawn) if at.many else [drawn])
            found[at.name] = [text for text in texts if text]
    return found


def asked_values(
    asked: Mapping[str, tuple[str, ...]], metaclass: Metaclass
) -> tuple[dict[str, object], list[str]]:
    """Return the values that the user gives, None for one to be left out, and what is wrong with them."""
    found: dict[str, object] = {}
    faults = []
    for name, texts in asked.items():
        try:
            at = metaclass.feature(name)
            if refers(at):
                continue
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
        if each.required and each.default is None and not each.is_container and not holds(element, each):
            yield f"{kind.name} needs {each.name}: {each.documentation}"


def _parsed(at: Feature, text: str) -> object:
    if isinstance(at.type, Metaclass):
        raise ValueError(f"{at.name}: holds other elements, which are written in the model")
    try:
        value = at.type.parse(text)
    except ValueError as fault:
        raise ValueError(f"{at.name}={text[:_LONGEST]}: {fault}"[:300]) from None
    if isinstance(value, float) and not isfinite(value):
        raise ValueError(f"{at.name}={text[:_LONGEST]}: not a finite number")
    return value
