"""Whether one element says nothing that another does not say."""

from __future__ import annotations

from itertools import zip_longest

from mmrs_core.languages.element import Element, held, metaclass_of


def says_no_more(element: Element, other: Element) -> bool:
    """Return whether every value of an element is that of another, which may have further ones.

    References are not looked at. Robot types have none.
    """
    if metaclass_of(element) is not metaclass_of(other):
        return False
    for feature in metaclass_of(element).features:
        own, others = held(element, feature), held(other, feature)
        if own and not feature.is_reference and own != others:
            return False
        if own and feature.containment and not all(_pair(*pair) for pair in zip_longest(own, others)):
            return False
    return True


def _pair(one: object, other: object) -> bool:
    return isinstance(one, Element) and isinstance(other, Element) and says_no_more(one, other)
