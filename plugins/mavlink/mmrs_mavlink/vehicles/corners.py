"""Corners: a vehicle that goes through one without a stop cuts it, and was not checked for that."""

from __future__ import annotations

from math import acos, degrees, hypot

from mmrs_runtime.controllers.geodesy import distance, ends_of, offset

from ..program import GoTo, Notify, Object, Place, Step, Then

STRAIGHT_DEGREES = 10.1
"""Up to where a turn is none, with the rounding of places: as in runs that are uploaded."""


def goes_through(step: Step, following: Step | None, here: Place) -> bool:
    """Return whether a vehicle passes the end of a move without a stop.

    It does if the behaviour asks for it, the only actions there are notifies, and the path continues
    straight. The caller knows whether slots keep it from continuing.

    Args:
        step: of the move.
        following: the step after it; None where unknown.
        here: where the move begins.
    """
    fluid = isinstance(step.then, Then) and step.then.fluid
    if not fluid or following is None:
        return False
    if not all(isinstance(action, Notify) for action in (*step.after, *following.before)):
        return False
    now, then = step.movement, following.movement
    if not (isinstance(now, GoTo) and isinstance(then, GoTo)):
        return False
    if isinstance(now.at, Object) or isinstance(then.at, Object):
        return False
    arriving = [here, *ends_of(here, now.at, now.legs, now.distance)]
    end = arriving[-1]
    leaving = ends_of(end, then.at, then.legs, then.distance)
    before = next((place for place in reversed(arriving) if distance(place, end) > 0.0), None)
    after = next((place for place in leaving if distance(place, end) > 0.0), None)
    return before is not None and after is not None and turn(before, end, after) <= STRAIGHT_DEGREES


def turn(before: Place, here: Place, after: Place) -> float:
    """Return by how many degrees the way turns at a place; 0 is straight on."""
    a, b = offset(before, here), offset(here, after)
    cosine = sum(p * q for p, q in zip(a, b, strict=True)) / (hypot(*a) * hypot(*b))
    return degrees(acos(max(-1.0, min(1.0, cosine))))
