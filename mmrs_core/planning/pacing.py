"""When each part of a work begins and ends, where parts done in one go need no stop between them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import dist

from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import (
    NEAR,
    action_seconds,
    commanded_speed,
    continues,
    joined,
    length_of,
    stops_of,
    uncertain_seconds,
)
from mmrs_core.scene import ActionAt, Position, Stroke


def paced(parts: Sequence[Stroke], pilot: Pilot, *, soonest: bool = False) -> list[tuple[float, float]]:
    """Return (begin, end) in seconds of each part of a work, hops included.

    The time for all from one part to another is the end of the latter less the begin of the former: an
    end is when the robot has come to a stop there, a begin is by how much earlier it must set out from a
    standstill to catch up with a robot that does not stop. So parts in the middle may end after the next
    one begins. Exact, but for runs shorter than a robot needs to get up to speed, which count more.

    Args:
        parts: in order.
        pilot: of the robot.
        soonest: whether the robot is as quick as it may be: it does not turn, and does not stop
            where nothing is done and its routes are fluid. Then the time is no more than any run takes.
    """
    spans: list[tuple[float, float]] = []
    now = 0.0
    here: Position | None = None
    for chain in _chains(parts):
        if here is not None:
            now += pilot.hop_seconds(here, chain[0], soonest=soonest)
        key = (soonest, tuple(chain))
        if (known := pilot.paces.get(key)) is None:
            known = pilot.paces[key] = _of_chain(chain, pilot, soonest)
        spans += [(now + begin, now + end) for begin, end in known]
        now, here = spans[-1][1], chain[-1].points[-1]
    return spans


def _chains(parts: Sequence[Stroke]) -> Iterator[list[Stroke]]:
    """Yield the runs of parts that are one stroke when one robot does them."""
    chain = list(parts[:1])
    for one, two in pairwise(parts):
        if not continues(one, two):
            yield chain
            chain = []
        chain.append(two)
    if chain:
        yield chain


def _of_chain(chain: Sequence[Stroke], pilot: Pilot, soonest: bool) -> list[tuple[float, float]]:
    (whole,) = joined(chain)
    line = _Line(whole, pilot, soonest)
    begin, done = 0.0, 0.0
    spans = []
    for one, _ in pairwise(chain):
        done += length_of(one.points)
        end, after = line.pause(done, one)
        spans.append((begin, end))
        begin = after
    return [*spans, (begin, line.whole)]


class _Line:
    """A stroke's stops: arc lengths, seconds at which the robot arrives and leaves.

    Attributes:
        whole: seconds of the whole stroke.
    """

    def __init__(self, stroke: Stroke, pilot: Pilot, soonest: bool) -> None:
        self._robot = pilot.robot
        rates = pilot.kinematics.rates(commanded_speed(stroke, pilot.kinematics))
        self._rates = rates.soonest() if soonest else rates
        self._eased = soonest and pilot.travel.fluid
        self._transit = pilot.kinematics.cruise
        self._stops = stops_of(stroke)
        todo = list(stroke.commands)
        due = list(_due(todo, 0.0))
        stands = bool(due)
        self._arcs, self._arrivals, self._departures = [0.0], [0.0], [self._acting(due)]
        for one, two in pairwise(self._stops):
            self._arcs.append(self._arcs[-1] + dist(one, two))
            due = list(_due(todo, self._arcs[-1]))
            stood, stands = stands, bool(due)
            seconds = (
                self._leg(one, two) if not (stood and stands) else self._rates.from_stop_to_stop(one, two)
            )
            self._arrivals.append(self._departures[-1] + seconds)
            self._departures.append(self._arrivals[-1] + self._acting(due))
        turning = 0.0 if soonest else uncertain_seconds(stroke, pilot.kinematics)
        self.whole = self._departures[-1] + stroke.hold + turning

    def _leg(self, one: Position, two: Position) -> float:
        if not self._eased:
            return self._rates.from_stop_to_stop(one, two)
        return self._rates.eased(one, two, 0.0 if self._arcs[-2] else self._transit)

    def _acting(self, actions: Iterable[ActionAt]) -> float:
        return sum(action_seconds(self._robot.type, action) for action in actions)

    def pause(self, arc: float, part: Stroke) -> tuple[float, float]:
        """Return when the robot has come to the end of a part, and when the next one must begin."""
        stop = bisect_left(self._arcs, arc - NEAR)
        if self._arcs[stop] <= arc + NEAR:
            length = length_of(part.points)
            time = self._arrivals[stop] + self._acting(a for a in part.commands if a.at > length - NEAR)
            return time, time
        place = part.points[-1]
        end = self._departures[stop - 1] + self._leg(self._stops[stop - 1], place)
        return end, self._arrivals[stop] - self._leg(place, self._stops[stop])


def _due(todo: list[ActionAt], arc: float) -> Iterator[ActionAt]:
    """Take away and yield the actions up to an arc length."""
    while todo and todo[0].at <= arc + NEAR:
        yield todo.pop(0)
