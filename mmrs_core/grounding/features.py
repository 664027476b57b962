"""The values of features by name, asked of elements that may lack the feature, the value, or both.

Models are checked and grounded while they may still be half done, and by code that does not know the
metaclasses of plug-ins. So nothing here raises: what is not there, or is not of the kind asked for, is
None or empty.
"""

from __future__ import annotations

from sys import float_info
from typing import TypeVar

from mmrs_core.languages.element import Element
from mmrs_core.scene import Policy
from mmrs_runtime.policies import EVENTS, RESPONSES

Literal = TypeVar("Literal", bound=str)


def value(element: Element, name: str) -> object:
    """Return what the feature of that name in the metamodel holds; None where there is no such feature."""
    metaclass = type(element)._mmrs_metaclass
    feature = metaclass.by_name.get(name) if metaclass else None
    return None if feature is None else getattr(element, feature.attribute)


def number(element: Element, name: str) -> float | None:
    """Return a number as a float; None for one without end, which no model may hold (ECO009)."""
    found = value(element, name)
    if not isinstance(found, (int, float)) or isinstance(found, bool):
        return None
    return float(found) if abs(found) <= float_info.max else None


def text(element: Element, name: str) -> str:
    """Return a text or the name of an enumeration's literal."""
    found = value(element, name)
    return found if isinstance(found, str) else ""


def literal(element: Element | None, name: str, known: tuple[Literal, ...], default: Literal) -> Literal:
    """Return the name of an enumeration's literal; the default where it is absent or not among the known."""
    found = text(element, name) if element is not None else ""
    return next((each for each in known if each == found), default)


def texts(element: Element, name: str) -> tuple[str, ...]:
    """Return all texts of a many-valued attribute."""
    return tuple(each for each in _items(value(element, name)) if isinstance(each, str))


def child(element: Element, name: str) -> Element | None:
    """Return the element that a single-valued reference leads to, contained or not."""
    found = value(element, name)
    return found if isinstance(found, Element) else None


def children(element: Element | None, name: str) -> tuple[Element, ...]:
    """Return all elements that a many-valued reference leads to, contained or not."""
    found = value(element, name) if element is not None else ()
    return tuple(each for each in _items(found) if isinstance(each, Element))


def _items(found: object) -> tuple[object, ...]:
    return tuple(found) if isinstance(found, (list, tuple)) else ()


def policies_of(element: Element) -> tuple[Policy, ...]:
    """Return the policies that a mission, robot type, robot or transition declares."""
    return tuple(
        Policy(
            literal(each, "event", EVENTS, "LINK_LOST"),
            literal(each, "response", RESPONSES, "HOLD"),
            number(each, "after"),
        )
        for each in children(element, "policies")
    )
