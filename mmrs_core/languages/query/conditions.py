"""Whether elements say what a path asks for."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from typing import Any

from mmrs_core.languages.datatypes import parse_date, shown
from mmrs_core.languages.element import Element, get, label_of, path_of
from mmrs_core.languages.metaclass import Enumeration, Feature
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.query.path import Condition

_ORDERS: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def known_features(elements: Sequence[Element]) -> frozenset[str]:
    """Return the names of the features that any of the elements has."""
    kinds = {metaclass for each in elements if (metaclass := type(each)._mmrs_metaclass) is not None}
    return frozenset(name for kind in kinds for name in kind.by_name)


def meets(condition: Condition, elements: Sequence[Element]) -> Callable[[Element], bool]:
    """Return what decides whether one of the elements meets a condition.

    Raises:
        ValueError: if none of them has such a feature, with the nearest name.
    """
    first = condition.names[0]
    known = known_features(elements)
    if elements and first not in known:
        hint = nearest(first, known)
        raise ValueError(f"no feature {first} of {type(elements[0]).__name__}{hint and '; ' + hint}")

    def decide(element: Element) -> bool:
        said = list(_said(element, condition.names))
        if condition.sign == "!=":
            return not any(_equals(feature, value, condition.value) for feature, value in said)
        return any(_is_so(feature, value, condition) for feature, value in said)

    return decide


def _said(element: Element, names: tuple[str, ...]) -> Iterator[tuple[Feature, object]]:
    """Yield the values at the end of a chain of features, each with the last feature."""
    metaclass = type(element)._mmrs_metaclass
    feature = metaclass.by_name.get(names[0]) if metaclass is not None else None
    if feature is None:
        return
    value = get(element, feature.name)
    for each in value if isinstance(value, list) else [value]:
        if len(names) > 1:
            if isinstance(each, Element):
                yield from _said(each, names[1:])
        elif each is not None:
            yield feature, each


def _is_so(feature: Feature, value: object, condition: Condition) -> bool:
    if not condition.sign:
        return True
    if condition.sign == "=":
        return _equals(feature, value, condition.value)
    if isinstance(value, datetime):
        return _ORDERS[condition.sign](value, parse_date(condition.value))
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{feature.name}: no number, cannot be compared by {condition.sign}")
    return _ORDERS[condition.sign](value, _number(condition.value))


def _equals(feature: Feature, value: object, wanted: str) -> bool:
    if isinstance(value, Element):
        return wanted in (label_of(value), path_of(value))
    kind = feature.type
    if isinstance(kind, Enumeration):
        return wanted in (value, kind.render(value))
    if isinstance(value, bool):
        return wanted == ("true" if value else "false")
    if isinstance(value, int | float):
        return value == _number(wanted)
    return str(value) == wanted


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{shown(text)}: not a number to compare with") from None
