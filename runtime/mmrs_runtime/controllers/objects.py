"""Finding objects: by functions of the user, within what the behaviour was verified for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import isfinite

from ..faults import FAILURES, OBJECT_NOT_FOUND, Fault
from .places import distance
from .state import State
from .words import Look, Object, Place

Locator = Callable[[State, Place | None], Place]


def where_expected(state: State, expected: Place | None) -> Place:
    """Take an object to be where it is expected, without looking for it.

    Raises:
        LookupError: nobody knows where it is expected.
    """
    if expected is None:
        raise LookupError("nobody knows where it is expected")
    return expected


def not_looked_for(state: State, expected: Place | None) -> Place:
    """Find nothing: stands in objects.py until somebody writes how an object is found.

    Raises:
        NotImplementedError: always; programs with objects that have this are not begun.
    """
    raise NotImplementedError("nobody has said yet how this object is found")


def place_of(target: Place | Object, locators: Mapping[str, Locator], state: State) -> Place:
    """Return where a target is.

    Raises:
        Fault: its locator does not find it, or finds it farther from where it is expected than it may
            be: routes were checked for no other places.
    """
    if not isinstance(target, Object):
        return target
    try:
        found = _somewhere(locators[target.description](state, target.expected), state.place)
    except FAILURES as error:
        raise Fault(OBJECT_NOT_FOUND, f"object {target.description!r}: {error!r}") from error
    if target.expected is not None and target.tolerance is not None:
        away = distance(target.expected, found)
        if away > target.tolerance:
            raise Fault(
                OBJECT_NOT_FOUND, f"object {target.description!r}: {away:.1f} m from where it should be"
            )
    return found


def _somewhere(found: Place, here: Place) -> Place:
    """Return what a function of the user's has found.

    Raises:
        ValueError: it is no place, or not in the frame of the robot's program, or its numbers are none.
    """
    if not isfinite(distance(here, found)):
        raise ValueError(f"{found} is nowhere")
    return found


def look_at(look: Look | None, locators: Mapping[str, Locator], state: State) -> Look | None:
    """Return a look whose target is a place."""
    return None if look is None else replace(look, at=place_of(look.at, locators, state))
