"""What one robot can do of a work from some portion on, sortie after sortie, and when it is back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from mmrs_core.planning.materials import Material
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Ready, State

_ANY_TIME = Ready()


@dataclass(frozen=True, slots=True)
class _Sortie:
    """Portions first to last at most, begun in a state in which the robot is at the first one.

    `turn`: the last portion after which the robot still gets home for another sortie; one before the
    first: none. It is before `last` only for a robot that need not return in the end.
    """

    first: int
    last: int
    turn: int
    state: State


class PortionRun:
    """A robot's run through the portions of a material, made only as far as it is asked about.

    The time at which the robot is back home after a portion never falls from portion to portion, since
    returning is never longer than over the next portion: so both limits are found by bisection.
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
        self._pilot, self.material, self._record = pilot, material, record
        self.begin = begin
        self._sorties: list[_Sortie] = []
        self._stuck = False
        self._add(state, begin, ready)

    def _add(self, state: State, first: int, ready: Ready) -> None:
        pilot, material = self._pilot, self.material
        need = material.longest(first, first) + pilot.exit_longest(material.last(first))
        there = pilot.reach(state, material.approach(first), need, ready, material.task)
        if there is None:
            self._stuck = True
            return
        last = _largest(first, len(material) - 1, lambda j: self._fits(there, first, j))
        turn = last if pilot.homebound else self._turn(there, first, last)
        self._sorties.append(_Sortie(first, last, turn, there))

    def _fits(self, state: State, first: int, last: int) -> bool:
        seconds = self.material.longest(first, last)
        return self._pilot.affords(state, seconds, self.material.last(last))

    def _turn(self, state: State, first: int, last: int) -> int:
        """Return the last portion after which the robot gets home; the one before the first if none."""

        def returns(portion: int) -> bool:
            seconds = self.material.longest(first, portion)
            return self._pilot.affords_home(state, seconds, self.material.last(portion))

        return _largest(first, last, returns) if returns(first) else first - 1

    def _extend(self) -> bool:
        if self._stuck or not self._sorties or self._end == len(self.material) - 1:
            return False
        full = self._sorties[-1]
        if full.turn < full.first:
            return False
        self._add(self._after(full, full.turn, final=False), full.turn + 1, _ANY_TIME)
        return not self._stuck

    @property
    def _end(self) -> int:
        return max(sortie.last for sortie in self._sorties)

    def can_do(self, portion: int) -> bool:
        """Return whether the robot can do all portions from the first to this one."""
        while not self._sorties or self._end < portion:
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
        return sortie.state.time + self.material.seconds(sortie.first, portion)

    def back(self, portion: int) -> float:
        """Return when the robot is back if it ends with a portion; inf if it cannot do that."""
        if not self.can_do(portion):
            return inf
        return self.ended(portion) + self._pilot.end_seconds(self.material.last(portion))

    def until(self, time: float) -> int:
        """Return the last portion after which the robot is back by a time; the one before `begin` if none."""
        while self._sorties and self.back(self._end) <= time:
            if not self._extend():
                return self._end
        for sortie in reversed(self._sorties):
            is_back = self._is_back(sortie, time)
            if is_back(sortie.first):
                return _largest(sortie.first, sortie.last, is_back)
        return self.begin - 1

    def _is_back(self, sortie: _Sortie, time: float) -> Callable[[int], bool]:
        """Return whether the robot is back by a time after a portion of a sortie."""
        began, seconds, last = sortie.state.time, self.material.seconds, self.material.last
        end, first = self._pilot.end_seconds, sortie.first

        def is_back(portion: int) -> bool:
            ended = began + seconds(first, portion)
            return ended <= time and ended + end(last(portion)) <= time

        return is_back

    def state(self, portion: int) -> State:
        """Return the state after ending with a portion that can be done."""
        return self._after(self._sortie_of(portion), portion, final=True)

    def _after(self, sortie: _Sortie, portion: int, *, final: bool) -> State:
        material, state = self.material, sortie.state
        seconds = material.bounds(sortie.first, portion)
        done = state.later(seconds, 0.0, material.last(portion))
        if not self._record:
            return done
        strokes = material.strokes(sortie.first, portion)
        for i, stroke in enumerate(strokes):
            state = self._pilot.hop(state, stroke, material.task)
            first = i == 0 and sortie.first == self.begin
            last = final and i == len(strokes) - 1
            state = self._pilot.serve(state, stroke, material.task, material.rule, first, last)
        return state._replace(used=done.used, early=done.early, late=done.late)


def _largest(low: int, high: int, holds: Callable[[int], bool]) -> int:
    """Return the largest index that something holds for; it holds for `low`, and for all up to some."""
    if holds(high):
        return high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
