"""Whether one element says nothing that another does not say."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.languages.element import Element, held, metaclass_of


def says_no_more(element: Element, other: Element) -> bool:
    """Return whether every value of an element is that of another, which may have further ones.

    So may its lists of elements, in between and at their ends.

    References are not looked at. Robot types have none.
    """
    if metaclass_of(element) is not metaclass_of(other):
        return False
    for feature in metaclass_of(element).features:
        own, others = held(element, feature), held(other, feature)
        if own and not feature.is_reference and list(map(_plain, own)) != list(map(_plain, others)):
            return False
        if own and feature.containment and not _all_among(own, others):
            return False
    return True


def _plain(value: object) -> object:
    """Return a value; a number for a text that is one, which may be written in several ways."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def _all_among(own: Iterable[object], others: Iterable[object]) -> bool:
    """Return whether elements say no more than some of others do, in the same order."""
    rest = iter(others)
    return all(any(_pair(one, other) for other in rest) for one in own)


def _pair(one: object, other: object) -> bool:
    return isinstance(one, Element) and isinstance(other, Element) and says_no_more(one, other)
