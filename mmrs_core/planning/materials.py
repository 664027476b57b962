"""The work of a task laid out for one robot: small portions in a row, with the seconds between them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, pairwise
from math import ceil, floor, inf, sqrt

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.diversions import Diversions
from mmrs_core.planning.pacing import paced_between
from mmrs_core.planning.positions import SLACK
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import ApproachRoute
from mmrs_core.planning.strokes import (
    approach_speed,
    can_turn,
    commanded_speed,
    joined,
    length_of,
    missing_action,
    parts_of,
    serve_seconds,
    turned,
)
from mmrs_core.scene import Position, Stroke, Work
from mmrs_core.scene.timing import MoveSeconds

_PORTIONS_PER_ROBOT = 100
"""Portions that a robot's share is made of, if all capable robots share alike: how finely it is balanced."""

_PORTIONS_PER_CHARGE = 10


@dataclass(frozen=True)
class Material:
    """A work as portions that go to one robot each, in one direction.

    Attributes:
        task: name of its task.
        rule: name of the rule that made it.
        portions: strokes of each portion; robots take runs of portions.
        spans: seconds at which each portion begins and ends, see `paced`: where the robot is as quick as it
            may be, as expected, and as slow.
        entry: where the robot with the first portion goes first; None: nowhere.
        speeds: by portion: at which the robot goes to it, metres per second; None: its cruise.
        whole: whether one robot must do all of it in one sortie.
    """

    task: str
    rule: str
    portions: tuple[tuple[Stroke, ...], ...]
    spans: tuple[tuple[tuple[float, float], ...], ...]
    entry: Position | None
    speeds: tuple[float | None, ...]
    whole: bool

    def __len__(self) -> int:
        return len(self.portions)

    def first(self, index: int) -> Position:
        """Return where a portion begins."""
        return self.portions[index][0].points[0]

    def last(self, index: int) -> Position:
        """Return where a portion ends."""
        return self.portions[index][-1].points[-1]

    @cached_property
    def _firsts(self) -> NDArray[np.float64]:
        return np.array([self.first(index) for index in range(len(self))])

    @cached_property
    def _lasts(self) -> NDArray[np.float64]:
        return np.array([self.last(index) for index in range(len(self))])

    def nearest(self, place: Position) -> int:
        """Return the first of the portions that begin nearest to a place."""
        return int(((self._firsts - place) ** 2).sum(axis=1).argmin())

    def metres_to(self, place: Position) -> float:
        """Return the level distance from a place to where the nearest portion begins."""
        return _nearest_metres(self._firsts, place)

    def metres_from(self, place: Position) -> float:
        """Return the level distance to a place from where the nearest portion ends."""
        return _nearest_metres(self._lasts, place)

    def fewest_seconds(self, robots: int, begin: int = 0, end: int = -1) -> float:
        """Return the fewest seconds of work of portions that so many robots share.

        Who begins with one need not come from the one before.
        """
        seconds = self.seconds(begin, end % len(self))
        return max(0.0, seconds - max(0, robots - 1) * self._longest_hop)

    @cached_property
    def _longest_hop(self) -> float:
        """Return the most seconds from the end of a portion to the beginning of the next."""
        return max((max(0.0, two[0] - one[1]) for one, two in pairwise(self.spans[1])), default=0.0)

    @cached_property
    def fastest(self) -> float:
        """Return the highest speed at which a robot goes to a portion; 0: its cruise, at all of them."""
        return max((each for each in self.speeds if each is not None), default=0.0)

    def seconds(self, begin: int, end: int) -> float:
        """Return the seconds from the beginning of one portion to the end of another, hops included."""
        return self._span(1, begin, end)

    def longest(self, begin: int, end: int) -> float:
        """Return the seconds of the same at most."""
        return self._span(2, begin, end)

    def bounds(self, begin: int, end: int) -> MoveSeconds:
        """Return how long the same takes."""
        shortest, expected, longest = (self._span(each, begin, end) for each in range(3))
        return MoveSeconds(min(shortest, expected), expected, longest)

    def _span(self, bound: int, begin: int, end: int) -> float:
        spans = self.spans[bound]
        return spans[end][1] - spans[begin][0]

    def approach(self, index: int) -> ApproachRoute:
        """Return the route by which a robot that begins with a portion comes there."""
        if index == 0 and self.entry is not None and self.entry != self.first(0):
            return ApproachRoute((self.entry, self.first(0)), self.speeds[0])
        return ApproachRoute((self.first(index),), self.speeds[index])

    def only(self, begin: int, end: int) -> Material:
        """Return the material of a run of portions alone."""
        kept = slice(begin, end + 1)
        return replace(
            self,
            portions=self.portions[kept],
            spans=tuple(each[kept] for each in self.spans),
            entry=self.entry if begin == 0 else None,
            speeds=self.speeds[kept],
        )

    def strokes(self, begin: int, end: int) -> tuple[Stroke, ...]:
        """Return the strokes of a run of portions, parts of one stroke put together again; always these."""
        if (begin, end) not in self._strokes:
            parts = (stroke for portion in self.portions[begin : end + 1] for stroke in portion)
            self._strokes[begin, end] = joined(parts)
        return self._strokes[begin, end]

    def numbers(self, index: int) -> range:
        """Return the numbers of a portion's strokes among those of all portions."""
        return range(self._counts[index], self._counts[index + 1])

    @cached_property
    def _counts(self) -> list[int]:
        return [0, *accumulate(map(len, self.portions))]

    def near(self, metres: float) -> list[list[int]]:
        """Return, by number of a stroke, it and those that lie within some metres of it, heights aside."""
        if metres not in self._near:
            lines = [[at[:2] for at in each.points] for portion in self.portions for each in portion]
            shapes = [shapely.LineString(each) if len(each) > 1 else shapely.Point(each) for each in lines]
            found = self._near[metres] = [[] for _ in shapes]
            for one, two in shapely.STRtree(shapes).query(shapes, "dwithin", metres).T.tolist():
                found[one].append(two)
        return self._near[metres]

    @cached_property
    def _near(self) -> dict[float, list[list[int]]]:
        return {}

    @cached_property
    def _strokes(self) -> dict[tuple[int, int], tuple[Stroke, ...]]:
        return {}


def _nearest_metres(places: NDArray[np.float64], place: Position) -> float:
    return sqrt(((places[:, :2] - place[:2]) ** 2).sum(axis=1).min())


@dataclass(frozen=True, slots=True)
class Layout:
    """How works of one sort are divided: the same for all robots that may share them.

    Attributes:
        portions: strokes of each portion.
        can_turn: whether the whole may be done backwards, stroke by stroke.
    """

    portions: tuple[tuple[Stroke, ...], ...]
    can_turn: bool


def layout_of(work: Work, pilot: Pilot, robots: int, *, coarsest: float = 0.0, fine: bool = False) -> Layout:
    """Divide a work into portions, fine enough to balance so many robots and to fit into sorties.

    Args:
        work: to be divided; an indivisible one is a single portion.
        pilot: of one robot that can do it.
        robots: how many may share it.
        coarsest: seconds of a portion that is small enough to balance the mission as a whole.
        fine: whether each part between two cuts is a portion.
    """
    if not work.divisible:
        return Layout((work.strokes,), can_turn=False)
    parts = [part for stroke in work.strokes for part in parts_of(stroke)]
    seconds = [pilot.serve_seconds(part) for part in parts]
    target = max(sum(seconds) / (_PORTIONS_PER_ROBOT * robots), coarsest)
    target = min(target, pilot.charge / _PORTIONS_PER_CHARGE)
    target = 0.0 if fine else target
    turns = not work.ordered and work.entry is None and all(can_turn(stroke) for stroke in work.strokes)
    return Layout(tuple(_gathered(parts, seconds, target)), turns)


def _gathered(
    parts: Sequence[Stroke], seconds: Sequence[float], target: float
) -> Iterator[tuple[Stroke, ...]]:
    run: list[Stroke] = []
    spent = 0.0
    for part, each in zip(parts, seconds, strict=True):
        if run and spent + each / 2 > target:
            yield tuple(run)
            run, spent = [], 0.0
        run.append(part)
        spent += each
    if run:
        yield tuple(run)


def lay_out(task: str, work: Work, layout: Layout, pilot: Pilot, *, backwards: bool = False) -> Material:
    """Return the material of a work for one robot.

    Raises:
        UnreachableError: a stroke is too near to an area, or no route leads from one to the next.
    """
    portions = layout.portions
    if backwards:
        portions = tuple(tuple(turned(part) for part in reversed(portion)) for portion in reversed(portions))
    return Material(
        task=task,
        rule=work.rule,
        portions=portions,
        spans=_spans(portions, pilot),
        entry=_entry(work, pilot),
        speeds=tuple(approach_speed(portion[0], pilot.kinematics) for portion in portions),
        whole=not work.divisible,
    )


def _spans(portions: Sequence[Sequence[Stroke]], pilot: Pilot) -> tuple[tuple[tuple[float, float], ...], ...]:
    """Return by bound when each portion begins and ends."""
    parts = [part for portion in portions for part in portion]
    ends = list(accumulate(map(len, portions)))
    runs = list(zip([0, *ends], ends, strict=False))
    return tuple(
        tuple((spans[begin][0], spans[end - 1][1]) for begin, end in runs)
        for spans in paced_between(parts, pilot)
    )


def _entry(work: Work, pilot: Pilot) -> Position | None:
    """Return the entry at a height at which the robot may travel."""
    if work.entry is None:
        return None
    east, north, up = work.entry
    return (east, north, max(pilot.kinematics.floor, min(up, pilot.kinematics.ceiling)))


def faults(work: Work, pilot: Pilot) -> Iterator[str]:
    """Yield why a robot cannot do a work, whatever the plan: heights, clearance, actions, speed, charge."""
    if not work.strokes or not all(stroke.points for stroke in work.strokes):
        yield "there is nothing to be done"
        return
    if not pilot.kinematics.cruise > 0:
        yield "its cruise speed is zero"
        return
    if pilot.stuck and pilot.diversions is not None:
        yield _no_diversion(pilot, pilot.diversions)
    yield from _height_faults(work.strokes, pilot)
    for stroke in work.strokes:
        near = pilot.travel.space.blockers(stroke.points)
        if near:
            yield f"its route is within the clearance of {near}"
            break
    lacking = {
        missing_action(pilot.robot.type, action) for stroke in work.strokes for action in stroke.commands
    }
    yield from sorted(reason for reason in lacking if reason is not None)
    slow = list(_speed_faults(work.strokes, pilot))
    yield from slow
    if not slow and inf in (serve_seconds(each, pilot.robot, pilot.kinematics) for each in work.strokes):
        yield "it cannot turn on the spot, or change its height, as the work demands"


def _height_faults(strokes: Iterable[Stroke], pilot: Pilot) -> Iterator[str]:
    heights = [point[2] for stroke in strokes for point in stroke.points]
    lowest, highest = pilot.kinematics.floor, pilot.kinematics.ceiling
    if max(heights) > highest + SLACK:
        short = max(heights) - highest
        yield f"it may go up to {highest:g} m, {max(heights):g} m are needed: {short:.1f} m short"
    if min(heights) < lowest - SLACK:
        short = lowest - min(heights)
        yield f"it may go down to {lowest:g} m, {min(heights):g} m are needed: {short:.1f} m short"


def _speed_faults(strokes: Iterable[Stroke], pilot: Pilot) -> Iterator[str]:
    allowed = min((stroke.speed for stroke in strokes if stroke.speed is not None), default=None)
    if allowed is not None and allowed < pilot.kinematics.slowest:
        slowest = pilot.kinematics.slowest
        yield f"it cannot go slower than {slowest:g} m/s, at most {allowed:g} m/s are allowed"
    moving = [
        commanded_speed(stroke, pilot.kinematics)
        for stroke in strokes
        if length_of(stroke.points) > 0.0 or approach_speed(stroke, pilot.kinematics) is not None
    ]
    if min(moving, default=1.0) <= 0.0:
        yield "its speed there is zero"


def charge_faults(material: Material, pilot: Pilot) -> Iterator[str]:
    """Yield why a robot cannot do some portion even in a sortie of its own, and by how much it is short."""
    short = shortages(material, pilot)
    worst = max(range(len(short)), key=short.__getitem__)
    if short[worst] == inf:
        yield _why_unreachable(material, pilot, worst)
    elif short[worst] > 1e-9:
        allowed = allowed_by_charge(pilot)
        yield (
            f"{_words(material, worst)} takes up to {ceil(allowed + short[worst])} s there and back; one"
            f" charge allows {floor(allowed)} s{kept_of_charge(pilot)}: {ceil(short[worst])} s short"
        )


def _no_diversion(pilot: Pilot, diversions: Diversions) -> str:
    """Return why a robot whose charge does not suffice for any diversion cannot set out."""
    why = f"(policy {', '.join(diversions.events)})"
    if diversions.from_home == inf:
        return f"no emergency area can be reached from its home {why}"
    return (
        f"from its home to an emergency area {why} it takes up to {ceil(diversions.from_home)} s; one charge"
        f" allows {floor(pilot.charge)} s: {ceil(diversions.from_home - pilot.charge)} s short"
    )


def allowed_by_charge(pilot: Pilot) -> float:
    """Return the seconds of a charge less those kept for a diversion from above home, at the best height."""
    kept = pilot.diversions.from_home if pilot.diversions is not None and pilot.homebound else 0.0
    return pilot.charge - kept


def kept_of_charge(pilot: Pilot) -> str:
    """Return what is kept of a charge for a diversion, in words; empty where nothing is."""
    kept = pilot.charge - allowed_by_charge(pilot)
    return f" beside {ceil(kept)} s kept to reach an emergency area from home" if kept > 0.5 else ""


def _why_unreachable(material: Material, pilot: Pilot, index: int) -> str:
    try:
        _longest_sortie(material, pilot, index)
    except UnreachableError as error:
        return str(error)
    return f"it cannot get to or from {_words(material, index)}"


def _words(material: Material, index: int) -> str:
    east, north, _ = material.first(index)
    return "it" if material.whole else f"the piece at ({east:.0f}, {north:.0f})"


def shortages(material: Material, pilot: Pilot) -> list[float]:
    """Return by how many seconds each portion is too long for a sortie of its own; inf: no route there."""
    found = []
    for index in range(len(material)):
        try:
            found.append(_longest_sortie(material, pilot, index) - pilot.charge)
        except UnreachableError:
            found.append(inf)
    return found


def _longest_sortie(material: Material, pilot: Pilot, index: int) -> float:
    approach = material.approach(index)
    routes = [pilot.travel.leave(approach.via[0])]
    routes += [pilot.travel.hop(one, two) for one, two in pairwise(approach.via)]
    out = sum(pilot.travel.at_speed(route, approach.speed).longest for route in routes)
    pilot.exit_route(material.last(index))
    return pilot.fresh + out + material.longest(index, index) + pilot.exit_longest(material.last(index))
