"""When each part of a work begins and ends, where parts done in one go need no stop between them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, pairwise
from math import dist

from mmrs_core.planning.corners import InMissions, runs_between
from mmrs_core.planning.flown_legs import (
    BESIDE,
    FlownLegs,
    due_at,
    flown_legs,
    halts_at_corners,
    passed_at_begin,
    passed_at_end,
)
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import (
    NEAR,
    action_seconds,
    commanded_speed,
    continues,
    joined,
    length_of,
    longest_end,
    stops_of,
    uncertain_seconds,
)
from mmrs_core.planning.timeline import moves_along
from mmrs_core.scene import ActionAt, Position, Stroke
from mmrs_core.scene.passing import Passage, goes_straight, passed
from mmrs_core.scene.timing import MoveSeconds, Rates, acting


def paced(
    parts: Sequence[Stroke], pilot: Pilot, bound: int = 0, beside: tuple[int, int] = BESIDE
) -> list[tuple[float, float]]:
    """Return (begin, end) in seconds of each part of a work, hops included.

    The time for all from one part to another is the end of the latter less the begin of the former: an
    end is when the robot has come to a stop there, a begin is by how much earlier it must set out from a
    standstill to catch up with a robot that does not stop. So parts in the middle may end after the next
    one begins. Exact, but for runs shorter than a robot needs to get up to speed, which count more.

    Args:
        parts: in order.
        pilot: of the robot.
        bound: -1: the robot is as quick as it may be: it does not turn, and does not stop where nothing is
            done and its routes are fluid. Then the time is no more than any run takes. 1: it is as slow as
            it may be. 0: as expected.
        beside: legs before the first part and after the last that may continue it without a stop.
    """
    return paced_between(parts, pilot, (bound,), beside)[0]


def paced_between(
    parts: Sequence[Stroke],
    pilot: Pilot,
    bounds: Sequence[int] = (-1, 0, 1),
    beside: tuple[int, int] = BESIDE,
) -> tuple[list[tuple[float, float]], ...]:
    """Return the same by bound; what all bounds have in common is found out once."""
    found = tuple(list[tuple[float, float]]() for _ in bounds)
    here: Position | None = None
    chains = list(_chains(parts))
    between = [_moves(pilot, one[-1], two[0]) for one, two in pairwise(chains)]
    before = [beside[0], *map(legs_beside, between, (passed_at_end(chain[-1]) for chain in chains))]
    after = [*map(legs_beside, between, (passed_at_begin(chain[0]) for chain in chains[1:])), beside[1]]
    for chain, legs in zip(chains, zip(before, after, strict=False), strict=False):
        hop = MoveSeconds.exactly(0.0) if here is None else pilot.hop_seconds(here, chain[0])
        known = pilot.paces.setdefault((tuple(chain), legs), {})
        for bound, spans in zip(bounds, found, strict=True):
            if bound not in known:
                known[bound] = _of_chain(chain, pilot, bound, legs)
            now = (spans[-1][1] if spans else 0.0) + hop[1 + bound]
            spans += [(now + begin, now + end) for begin, end in known[bound]]
        here = chain[-1].points[-1]
    return found


def _moves(pilot: Pilot, one: Stroke, two: Stroke) -> int:
    """Return the moves of a hop between strokes; 0 where they do not matter, or there is none."""
    if pilot.travel.uploading is None or one.points[-1] == two.points[0]:
        return 0
    route = pilot.travel.hop(one.points[-1], two.points[0]).points
    return len(list(moves_along(list(pairwise(route)))))


def legs_beside(moves: int, passes: bool) -> int:
    """Return the legs that may continue a stroke: a hop, and one beyond that if the robot passes there."""
    return min(max(1, moves) + passes, max(BESIDE))


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


def _of_chain(
    chain: Sequence[Stroke], pilot: Pilot, bound: int, beside: tuple[int, int]
) -> list[tuple[float, float]]:
    (whole,) = joined(chain)
    line = _Line(whole, pilot, bound, beside)
    begin, done = 0.0, 0.0
    spans = []
    for one, two in pairwise(chain):
        done += length_of(one.points)
        end, after = line.pause(done, one, two)
        spans.append((begin, end))
        begin = after
    return [(begin, end + line.beside) for begin, end in [*spans, (begin, line.whole)]]


class _Line:
    """A stroke's stops: arc lengths, seconds at which the robot arrives and leaves.

    Attributes:
        whole: seconds of the whole stroke.
        beside: seconds that the legs before and after it may take longer, as it is flown in one go with them.
    """

    def __init__(
        self, stroke: Stroke, pilot: Pilot, bound: int, beside: tuple[int, int] | InMissions
    ) -> None:
        self._robot, self._timing, self._bound = pilot.robot, pilot.kinematics.timing, bound
        self._rates = pilot.travel.bounds(commanded_speed(stroke, pilot.kinematics))[1 + bound]
        self._eased = bound < 0 and pilot.travel.fluid
        self._transit = pilot.kinematics.cruise
        self._stops = stops_of(stroke)
        self._arcs = [0.0, *accumulate(dist(one, two) for one, two in pairwise(self._stops))]
        due = due_at(stroke, self._arcs)
        certain = FlownLegs() if bound else flown_legs(stroke, pilot.travel)
        uploaded = pilot.travel.uploaded(commanded_speed(stroke, pilot.kinematics)) if bound > 0 else None
        self._uploaded = certain.mission if uploaded is None else uploaded
        halts = halts_at_corners(stroke, pilot.travel) if uploaded is not None else []
        if isinstance(beside, InMissions):
            legs, self.beside = beside.legs, beside.ends * pilot.travel.ending
        else:
            runs = list(runs_between(halts, beside)) if halts else []
            legs = frozenset(leg for run, _ in runs for leg in run).union(certain.legs)
            self.beside = sum(pilot.travel.upload_seconds(ends) for _, ends in runs)
        self._in_runs = legs
        self._halts, self._ending = halts, pilot.travel.ending
        self._hop = pilot.travel.upload_seconds(1) if halts else 0.0
        self._stays = stroke.look is not None
        passes = uploaded is not None and uploaded.timing.passes and pilot.kinematics.turning_radius <= 0.0
        self._saved = (
            dict(self._saved_on(halts, uploaded))
            if legs and passes and uploaded
            else dict(enumerate(certain.saved))
        )
        self._arrivals, self._departures = [0.0], [self._acting(due[0])]
        for i, (one, two) in enumerate(pairwise(self._stops)):
            between = bool(due[i] and due[i + 1])
            saved = self._saved.get(i, 0.0)
            seconds = self._rates.from_stop_to_stop(one, two) if between else self._leg(i, one, two, saved)
            self._arrivals.append(self._departures[-1] + seconds)
            self._departures.append(self._arrivals[-1] + self._acting(due[i + 1]))
        at_the_end = (
            stroke.hold,
            stroke.hold + uncertain_seconds(stroke, pilot.kinematics),
            longest_end(stroke, pilot.kinematics),
        )
        self.whole = self._departures[-1] + at_the_end[1 + bound]

    def _saved_on(self, halts: Sequence[bool], uploaded: Rates) -> Iterator[tuple[int, float]]:
        """Yield the legs of missions that begin and end without a stop, and the seconds that this saves."""
        legs = list(pairwise(self._stops))
        before: Passage | None = None
        for i, (leg, after) in enumerate(pairwise(legs)):
            on = not halts[i] and not halts[i + 1] and goes_straight(*leg, after[1])
            ahead = passed(uploaded, leg, after, before) if on else None
            if before is not None and ahead is not None:
                yield i, before.onward + ahead.saved
            before = ahead

    def _leg(self, index: int, one: Position, two: Position, saved: float = 0.0) -> float:
        if self._eased:
            return self._rates.eased(one, two, 0.0 if index else self._transit)
        seconds = self._rates.from_stop_to_stop(one, two)
        if self._uploaded is None or index not in self._in_runs:
            return seconds if self._bound else seconds - saved
        flown = self._uploaded.from_stop_to_stop(one, two) - saved
        return max(seconds, flown) if self._bound else flown

    def _acting(self, actions: Iterable[ActionAt]) -> float:
        each = (action_seconds(self._robot.type, action) for action in actions)
        return sum(acting(seconds, self._timing)[1 + self._bound] for seconds in each)

    def pause(self, arc: float, one: Stroke, two: Stroke) -> tuple[float, float]:
        """Return when the robot has come to the end of a part, and when the next one must begin.

        Where a repetition is cut, that of the one ends and that of the other begins, which takes time. The
        first leg from there begins with a stop; it ends with one unless a hop and it are expected to be one
        mission. What is cut may be part of missions with hops.
        """
        stop, length, place = bisect_left(self._arcs, arc - NEAR), length_of(one.points), one.points[-1]
        before, after = stop - 1, stop + (self._arcs[stop] <= arc + NEAR)
        ending = self._acting(each for each in one.commands if each.at > length - NEAR)
        beginning = self._acting(each for each in two.commands if each.at <= NEAR)
        end = self._departures[before] + self._leg(before, self._stops[before], place)
        begin = self._arrivals[after] - self._leg(after - 1, place, self._stops[after])
        if self._bound:
            begin -= self._saved.get(after, 0.0)
        elif two.look is None or after - 1 not in self._in_runs:
            begin += self._saved.get(after - 1, 0.0)
        if self._eased and after == before + 1:  # parts of a leg take longer than the whole, at least
            end = min(end, begin)
        end += ending
        begin -= beginning
        if self._bound > 0 and self._halts:
            first = max((i for i in range(before + 1) if self._halts[i]), default=0)
            last = next((i for i in range(after, len(self._halts)) if self._halts[i]), len(self._stops) - 1)
            end += self._led_on(first, [*self._stops[first:stop], place], self._ending, not ending)
            begin -= self._led_on(after - 1, [place, *self._stops[after : last + 1]], 0.0, not beginning)
        return end, begin

    def _led_on(self, first: int, stops: Sequence[Position], ending: float, passes: bool) -> float:
        """Return how much longer legs on one side of a cut may take there, as a mission with a hop beyond it.

        Args:
            first: number of the first leg.
            stops: of the legs, to or from where the robot stops for certain.
            ending: seconds of the end of a mission there.
            passes: whether nothing is done at the cut.
        """
        legs = [*enumerate(pairwise(stops), first)]
        if self._stays:
            return ending * (legs[-1][0] in self._in_runs)
        if not passes or self._uploaded is None:
            return 0.0
        more = (
            self._uploaded.from_stop_to_stop(*leg) - self._rates.from_stop_to_stop(*leg)
            for i, leg in legs
            if i not in self._in_runs
        )
        return self._hop + sum(max(0.0, each) for each in more)


def longest_of(stroke: Stroke, pilot: Pilot, flown: InMissions) -> float:
    """Return the seconds that a stroke takes at most of which it is known what is flown as missions."""
    line = _Line(stroke, pilot, 1, flown)
    return line.whole + line.beside
