"""The conditions of a query path."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, datetime
from decimal import Decimal
from math import isfinite
from typing import Any

from mmrs_core.languages.datatypes import DataType, parse_date, parse_real, shown
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
    order = _ORDERS[condition.sign]
    if isinstance(value, datetime):
        return order(value, _moment(condition.value))
    number = _exact(value)
    if number is None:
        raise ValueError(f"{feature.name}: no number and no date, cannot be compared by {condition.sign}")
    bound = _number(condition.value)
    return number == number and bound == bound and order(number, bound)  # NaN compares with nothing


def _equals(feature: Feature, value: object, wanted: str) -> bool:
    if isinstance(value, Element):
        return wanted in (label_of(value), path_of(value))
    kind = feature.type
    if isinstance(kind, Enumeration):
        return wanted in (value, kind.render(value))
    if isinstance(value, datetime):
        return value == _moment(wanted)
    number = _exact(value)
    if number is not None:
        return number == _number(wanted)
    if isinstance(kind, DataType) and kind.accepts(value):
        text = kind.render(value)
        return wanted in (text, value) or (isinstance(value, bytes) and wanted.upper() == text)
    return str(value) == wanted


def _moment(text: str) -> datetime:
    """Return the date that a person means: by ISO 8601 if it is one, else as a file's text is read."""
    try:
        date = datetime.fromisoformat(text)
    except ValueError:
        return parse_date(text)
    return date if date.tzinfo else date.replace(tzinfo=UTC)


def _exact(value: object) -> Decimal | float | None:
    """Return a number of any kind in a form that compares without rounding; None for what is not a number.

    A whole number beyond 2**53 and a decimal one keep all their digits; what is not finite stays a float.
    """
    if isinstance(value, bool):
        return None
    if isinstance(value, float):
        return Decimal(repr(value)) if isfinite(value) else value
    return Decimal(value) if isinstance(value, int | Decimal) else None


def _number(text: str) -> Decimal | float:
    try:
        number = parse_real(text)
        return Decimal(text.strip().rstrip("fFdD")) if isfinite(number) else number
    except (ValueError, ArithmeticError):
        raise ValueError(f"{shown(text)}: not a number to compare with") from None
