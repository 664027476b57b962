"""A craft that is not there: it goes where it is told at a steady speed, for trials without a vehicle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import dist

from auv_vessel.api import Craft, State
from auv_vessel.goals import Goal
from auv_vessel.sheet import Sheet, Vector
from auv_vessel.wire.codec import Codec

LEADS = ("GO_TO", "HOLD", "SEARCH")
"""Goals that have a place; the others take the place where they begin."""


class DryCraft(Craft):
    """Takes the time that a real vehicle needs, and does all that it is told."""

    def __init__(self, sheet: Sheet, now: Callable[[], float]) -> None:
        """Lie at home; `now` returns seconds."""
        super().__init__(sheet, Codec(sheet))
        self._clock, self._at, self._since = now, sheet.home, now()

    def operate(self, device: str, action: int, parameter: float = 0.0) -> int:
        """Have a device do something at once."""
        request = super().operate(device, action, parameter)
        self._devices[request] = "REACHED"
        self._requests.pop(request, None)
        return request

    def state(self) -> State:
        """Return where it would be, with a full battery."""
        place = self._move_on()
        there = dist(place, self._target()) < 1e-6
        return replace(
            super().state(),
            time=self._since,
            north=place[0],
            east=place[1],
            depth=place[2],
            heading=self._goal.heading,
            uncertainty=0.0,
            trusted=True,
            position_lost=False,
            age=0.0,
            silent=0.0,
            charge=1.0,
            goal=self._goal.number,
            progress="REACHED" if there else "ACTIVE",
            distance=dist(place, self._target()),
        )

    def _begin(self, goal: Goal) -> int:
        self._move_on()
        return super()._begin(goal)

    def _move_on(self) -> Vector:
        now = self._clock()
        left, target = now - self._since, self._target()
        self._since = now
        away, pace = dist(self._at, target), self._goal.speed or self._sheet.speed
        part = 1.0 if away <= left * pace else left * pace / away
        north, east, depth = (a + (b - a) * part for a, b in zip(self._at, target, strict=True))
        self._at = (north, east, depth)
        return self._at

    def _target(self) -> Vector:
        goal, (north, east, depth) = self._goal, self._at
        if goal.mode in LEADS:
            return (goal.north, goal.east, goal.depth)
        return (north, east, 0.0 if goal.mode == "SURFACE" else depth)
