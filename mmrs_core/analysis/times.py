"""When moves may begin and end: bounds over all runs, in seconds after the mission's start.

The earliest times are those of a run in which every Choice takes every branch at once and every move is as
quick as it can be: Knuth's generalisation of Dijkstra's algorithm to sums and maxima finds them. The
latest times follow the moves and the slots in the order of their dependencies; what depends on itself
(a loop) has no latest time. Both hold for runs that end: whether they do is another check's matter.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import count
from math import inf

from mmrs_core.analysis.dependencies import At, Dependencies
from mmrs_core.analysis.durations import Durations, durations_of
from mmrs_core.analysis.motion import motions
from mmrs_core.analysis.order import HappensBefore, passing_slots
from mmrs_core.analysis.verdicts import once
from mmrs_core.behaviour.program import Program, RobotProgram, SlotId
from mmrs_core.contributions.checks import CheckInput


@dataclass(frozen=True, slots=True)
class Times:
    """Bounds on the run of a whole behaviour.

    Attributes:
        durations: of every robot's moves. dependencies: what waits for what.
        earliest, latest: bounds of when a move begins; a move that can never begin is missing from
            the earliest, one without a bound is inf in the latest.
        slots: (earliest, latest) activation of each slot that some robot activates.
    """

    durations: Mapping[str, Durations]
    dependencies: Dependencies
    earliest: Mapping[At, float]
    latest: Mapping[At, float]
    slots: Mapping[SlotId, tuple[float, float]]

    def earliest_end(self, robot: str, move: int) -> float:
        """Return when a move and its actions have ended at the earliest; inf where it never begins."""
        return self.earliest.get((robot, move), inf) + self.durations[robot].of[move].whole.low

    def latest_end(self, robot: str, move: int) -> float:
        """Return when a move and its actions have ended at the latest."""
        return self.latest.get((robot, move), inf) + self.durations[robot].of[move].whole.high

    def earliest_release(self, robot: RobotProgram, waits: tuple[str, ...]) -> float:
        """Return before when not all these slots of a robot are active; 0 where none is ever activated."""
        slots = ((robot.id, slot) for slot in waits)
        return max((self.slots[slot][0] for slot in slots if slot in self.slots), default=0.0)

    def latest_release(self, robot: RobotProgram, waits: tuple[str, ...]) -> float:
        """Return by when all these slots of a robot have been activated; -inf where there are none."""
        unset = (inf, inf)
        return max((self.slots.get((robot.id, slot), unset)[1] for slot in waits), default=-inf)


def times_of(input: CheckInput) -> Times:
    """Return the bounds for all robots; found once for all checks. Time n log n in the moves."""
    return once(input, _times)


def order_of(input: CheckInput) -> HappensBefore:
    """Return what is over when moves begin; found once for all checks."""
    return once(input, _order)


def _order(input: CheckInput) -> HappensBefore:
    return HappensBefore(input.program, times_of(input).dependencies)


def _times(input: CheckInput) -> Times:
    moving = motions(input)
    durations = {robot.id: durations_of(input, robot, moving[robot.id]) for robot in input.program.robots}
    earliest, first = _Earliest(input.program, durations).run()
    dependencies = Dependencies(input.program, durations)
    latest, last = _latest(dependencies, durations, _passing(input.program, dependencies))
    slots = {slot: (time, last.get(slot, inf)) for slot, time in first.items()}
    return Times(durations, dependencies, earliest, latest, slots)


@dataclass(slots=True)
class _Earliest:
    """A run in which everything that may happen happens, as early as it may."""

    program: Program
    durations: Mapping[str, Durations]
    begins: dict[At, float] = field(default_factory=dict)
    slots: dict[SlotId, float] = field(default_factory=dict)
    ended: dict[SlotId, list[At]] = field(default_factory=lambda: defaultdict(list))
    agenda: list[tuple[float, int, str, At | SlotId]] = field(default_factory=list)
    order: Iterator[int] = field(default_factory=count)

    def run(self) -> tuple[dict[At, float], dict[SlotId, float]]:
        robots = {robot.id: robot for robot in self.program.robots}
        for robot in self.program.robots:
            self._plan(0.0, "begin", (robot.id, robot.start))
        while self.agenda:
            now, _, event, subject = heappop(self.agenda)
            if event == "slot":
                self._activate(now, (subject[0], str(subject[1])))
            else:
                at = (subject[0], int(subject[1]))
                self._begin(now, at) if event == "begin" else self._end(now, at, robots[at[0]])
        return self.begins, self.slots

    def _plan(self, time: float, event: str, subject: At | SlotId) -> None:
        heappush(self.agenda, (time, next(self.order), event, subject))

    def _begin(self, now: float, at: At) -> None:
        if at in self.begins:
            return
        self.begins[at] = now
        duration = self.durations[at[0]].of[at[1]]
        for setting in duration.settings:
            for slot in setting.slots if setting.active else ():
                self._plan(now + setting.after.low, "slot", slot)
        self._plan(now + duration.whole.low, "end", at)

    def _end(self, now: float, at: At, robot: RobotProgram) -> None:
        transition = robot.transitions.get(at[1])
        if transition is None:
            return
        for name in transition.waits:
            if (robot.id, name) not in self.slots:
                self.ended[robot.id, name].append(at)
                return
        for after in transition.next_moves:
            self._plan(now, "begin", (robot.id, after))

    def _activate(self, now: float, slot: SlotId) -> None:
        if slot in self.slots:
            return
        self.slots[slot] = now
        for at in self.ended.pop(slot, ()):
            self._plan(now, "end", at)


def _passing(program: Program, dependencies: Dependencies) -> frozenset[SlotId]:
    if not dependencies.resets:
        return frozenset()
    return passing_slots(dependencies, HappensBefore(program, dependencies))


def _latest(
    dependencies: Dependencies, durations: Mapping[str, Durations], passing: frozenset[SlotId]
) -> tuple[dict[At, float], dict[SlotId, float]]:
    """Return the latest begins and activations; what is in a loop, or behind one, is missing."""
    begins: dict[At, float] = {}
    slots: dict[SlotId, float] = {}
    for node in dependencies.in_order():
        if dependencies.is_slot(node):
            slot = (node[0], str(node[1]))
            slots[slot] = inf if slot in passing else _latest_activation(dependencies, begins, slot)
        else:
            at = (node[0], int(node[1]))
            begins[at] = _latest_begin(dependencies, durations, begins, slots, at)
    return begins, slots


def _latest_activation(dependencies: Dependencies, begins: Mapping[At, float], slot: SlotId) -> float:
    """Return when a slot is active at the latest.

    Any activation that is certain bounds it; and some activation comes, or the run does not end.
    """
    activations = dependencies.activations_of(slot)
    latest = [(begins.get(each.at, inf) + each.after, each.certain) for each in activations]
    certain = min((time for time, sure in latest if sure), default=inf)
    return min(certain, max((time for time, _ in latest), default=inf))


def _latest_begin(
    dependencies: Dependencies,
    durations: Mapping[str, Durations],
    begins: Mapping[At, float],
    slots: Mapping[SlotId, float],
    at: At,
) -> float:
    latest = 0.0
    for source, waits in dependencies.arrivals_at(at):
        ended = begins[source] + durations[source[0]].of[source[1]].whole.high
        latest = max(latest, ended, *(slots.get(slot, inf) for slot in waits))
    return latest
