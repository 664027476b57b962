"""What one robot can do of a work from some portion on, sortie after sortie, and when it is back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from mmrs_core.planning.materials import Material
from mmrs_core.planning.sorties import Pilot, Ready, State

_ANY_TIME = Ready()


@dataclass(frozen=True, slots=True)
class _Sortie:
    """Portions first to last at most, begun in a state in which the robot is at the first one."""

    first: int
    last: int
    state: State


class Run:
    """A robot's run through the portions of a material, made only as far as it is asked about.

    The time at which the robot is back home after a portion never falls from portion to portion, since
    no way home is longer than one over the next portion: so both limits are found by bisection.
    """

    def __init__(
        self, pilot: Pilot, material: Material, state: State, begin: int, ready: Ready, *, record: bool
    ) -> None:
        """Begin a run.

        Args:
            pilot: of the robot.
            material: for that robot.
            state: of the robot before.
            begin: index of the first portion.
            ready: what the work waits for.
            record: whether states carry all steps, or only those that lead to the work.
        """
        self._pilot, self._material, self._record = pilot, material, record
        self.begin = begin
        self._sorties: list[_Sortie] = []
        self._stuck = False
        self._add(state, begin, ready)

    def _add(self, state: State, first: int, ready: Ready) -> None:
        """Add the sortie that begins with a portion, if there is one."""
        pilot, material = self._pilot, self._material
        need = material.seconds(first, first) + pilot.exit_seconds(material.last(first))
        there = pilot.reach(state, material.via(first), need, ready, material.task)
        if there is None:
            self._stuck = True
            return
        last = _largest(first, len(material) - 1, lambda j: self._fits(there, first, j))
        self._sorties.append(_Sortie(first, last, there))

    def _fits(self, state: State, first: int, last: int) -> bool:
        seconds = self._material.seconds(first, last)
        return self._pilot.affords(state, seconds, self._material.last(last))

    def _extend(self) -> bool:
        """Go on with one more sortie; return whether there is one."""
        if self._stuck or not self._sorties or self._sorties[-1].last == len(self._material) - 1:
            return False
        full = self._sorties[-1]
        self._add(self._after(full, full.last, final=False), full.last + 1, _ANY_TIME)
        return not self._stuck

    def can_do(self, portion: int) -> bool:
        """Return whether the robot can do all portions from the first to this one."""
        while not self._sorties or self._sorties[-1].last < portion:
            if not self._extend():
                return False
        return True

    def _sortie_of(self, portion: int) -> _Sortie:
        return next(sortie for sortie in self._sorties if sortie.first <= portion <= sortie.last)

    def started(self) -> float:
        """Return when the first portion begins; inf if it cannot."""
        return self._sorties[0].state.time if self._sorties else inf

    def ended(self, portion: int) -> float:
        """Return when a portion that can be done ends."""
        sortie = self._sortie_of(portion)
        return sortie.state.time + self._material.seconds(sortie.first, portion)

    def back(self, portion: int) -> float:
        """Return when the robot is back if it ends with a portion; inf if it cannot do that."""
        if not self.can_do(portion):
            return inf
        return self.ended(portion) + self._pilot.exit_seconds(self._material.last(portion))

    def until(self, time: float) -> int:
        """Return the last portion after which the robot is back by a time; the one before `begin` if none."""
        while self._sorties and self.back(self._sorties[-1].last) <= time:
            if not self._extend():
                return self._sorties[-1].last
        for sortie in reversed(self._sorties):
            if self.back(sortie.first) <= time:
                return _largest(sortie.first, sortie.last, lambda j: self.back(j) <= time)
        return self.begin - 1

    def state(self, portion: int) -> State:
        """Return the state after ending with a portion that can be done."""
        return self._after(self._sortie_of(portion), portion, final=True)

    def _after(self, sortie: _Sortie, portion: int, *, final: bool) -> State:
        material, state = self._material, sortie.state
        if not self._record:
            seconds = material.seconds(sortie.first, portion)
            return self._pilot.skip(state, seconds, 0.0, material.last(portion))
        strokes = material.strokes(sortie.first, portion)
        for i, stroke in enumerate(strokes):
            state = self._pilot.hop(state, stroke.points[0], material.task)
            first = i == 0 and sortie.first == self.begin
            last = final and i == len(strokes) - 1
            state = self._pilot.serve(state, stroke, material.task, material.rule, first, last)
        return state


def _largest(low: int, high: int, holds: Callable[[int], bool]) -> int:
    """Return the largest index that something holds for; it holds for `low`, and for all up to some."""
    if holds(high):
        return high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
