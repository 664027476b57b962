"""Whether a vehicle is seen to go where it was told to go: what it says of its mode is not enough."""

from __future__ import annotations

from math import hypot

from ..places import offset
from ..program import Place
from ..vehicles.modes import GUIDED
from ..vehicles.vehicle import State
from .ways import NEAR

TURNED = 0.3
"""Metres per second by which a vehicle must come nearer faster than before, or else at all."""


def turns_to(goal: Place, before: State, now: State) -> bool:
    """Return whether a vehicle is at a place or, steered, goes there.

    One on a leg must brake before it can turn back, which takes seconds: that it slows down tells that
    it obeys, and is seen in a fraction of a second.

    Args:
        goal: the place.
        before: what the vehicle told when it was ordered to go there.
        now: what it tells.
    """
    if now.mode != GUIDED:
        return False
    if hypot(*offset(now.place, goal)) <= NEAR:
        return True
    return _approach(goal, now) > min(TURNED, _approach(goal, before) + TURNED)


def _approach(goal: Place, state: State) -> float:
    """Return the speed at which a vehicle comes nearer to a place, metres per second."""
    away = offset(state.place, goal)
    length = hypot(*away)
    return sum(v * each for v, each in zip(state.velocity, away, strict=True)) / length if length else 0.0
