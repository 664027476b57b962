"""Whether robots that go to an emergency area when something fails can do so from everywhere on their paths.

A diversion begins where a move ends: in the middle of a move a robot continues to its end. From there it goes
straight to its rally point, or along its path to where the next move ends; where areas are in the way of the
straight line, around them. Every leg is measured against the areas as drawn, so that it does not matter how
a detour was found. What was used of the charge by then, and what the diversion takes, are both the most.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heapify, heappop, heappush
from itertools import pairwise
from math import ceil, dist, inf

import numpy as np
import shapely

from mmrs_core.analysis.distance import Floats, prism_distances
from mmrs_core.analysis.durations import Duration
from mmrs_core.analysis.endurance import allowed_seconds, sorties_of_all
from mmrs_core.analysis.figures import MissingFigureError, half_diagonal_of, home_of, kinematics_of, type_of
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.states import GROUNDED, states_of
from mmrs_core.analysis.times import times_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged, not_checked, once, violated
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.geometry.ground import ground_height
from mmrs_core.scene import Area, AreaUse, Point, Position

NAME = "diversion"

_TOLERANCE = 1e-6
"""Metres by which a rally point or a leg may be nearer than allowed: the noise of rounding."""

_ASIDE = 1.02
"""Times the required distance at which the corners of detours are, so that legs between them keep it."""

_MOST_AROUND = 24
"""Areas at most that a detour leads around."""


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    if robot.id not in input.rally_points:
        unasked = not_checked(NAME, robot, "no policy leads it to an emergency area")
        yield replace(unasked, caveat=_out_of_reach(input, robot))
        return
    if input.areas is None:
        yield not_checked(NAME, robot, "no context was given")
        return
    if allowed_seconds(input, robot) == inf:
        yield not_checked(NAME, robot, "it has no batteries and no lifetime: it is wired")
        return
    margins = _margins(input, robot, input.rally_points[robot.id])
    if margins is None:
        yield violated(NAME, robot, "no emergency area has room for it, but a policy leads it to one")
        return
    sorties = once(input, sorties_of_all)[robot.id]
    yield from judged(NAME, robot, "s", margins, (*motions(input)[robot.id].gaps, *sorties.gaps))


def _out_of_reach(input: CheckInput, robot: RobotProgram) -> str:
    """Return from where a robot that no policy leads to the emergency areas drawn would reach none.

    It is empty where there are none, where it would reach one from everywhere, and where that is not known.
    """
    if robot.id not in input.unasked_rally_points:
        return ""
    points = input.unasked_rally_points[robot.id]
    try:
        margins = [] if allowed_seconds(input, robot) == inf else _margins(input, robot, points)
    except MissingFigureError:
        return ""
    if margins is None:
        return "no emergency area has room for it"
    least = min(margins, key=lambda each: each.value, default=None)
    if least is None or not least.value < 0.0:
        return ""
    return f"it would not reach one from everywhere: {least.message}"


def _margins(input: CheckInput, robot: RobotProgram, points: Iterable[Point]) -> list[Margin] | None:
    """Return what is left of the charge after a diversion from the end of each move; None: none has room."""
    ground, allowed = _Surroundings.of(input, robot), allowed_seconds(input, robot)
    places = {place: area for place in points if (area := ground.landing(place))}
    if not places:
        return None
    uses, found = once(input, sorties_of_all)[robot.id].uses, _Diversions(input, robot, ground, places)
    return [_margin(robot, use.move, use.seconds, found, allowed) for use in uses if use.move in found.ends]


def _margin(robot: RobotProgram, index: int, used: float, found: _Diversions, allowed: float) -> Margin:
    move, (seconds, area) = robot.moves[index], found.ends[index]
    begin = f"after {move.kind} '{move.id}' it has used up to {used:.1f} s of one charge"
    if seconds == inf:
        return Margin(-inf, index, f"{begin}, and no clear path to an emergency area was found from there")
    words = (
        f"{begin} and needs up to {seconds:.1f} s from there to emergency area '{area}',"
        f" {allowed:.1f} s are allowed"
    )
    left = allowed - used - seconds
    if left < 0.0 < allowed:
        words += f": {ceil(-left)} s short"
    return Margin(0.0 if -1e-6 * allowed <= left < 0.0 else left, index, words)


class _Diversions:
    """The quickest diversion from the end of each move that does not end on the ground.

    Attributes:
        ends: by move: seconds, inf where none was found, and the emergency area.
    """

    def __init__(
        self, input: CheckInput, robot: RobotProgram, around: _Surroundings, places: Mapping[Point, str]
    ) -> None:
        kinematics, states = kinematics_of(input, robot), states_of(input, robot)
        self._robot, self._around, self._places = robot, around, places
        self._kinematics, self._rates = kinematics, kinematics.rates().latest()
        self._home = home_of(robot)
        paths: dict[int, list[MovePath]] = {}
        for path in motions(input)[robot.id].paths:
            if GROUNDED not in states.after[path.move]:
                paths.setdefault(path.move, []).append(path)
        self._top = max((p[2] for each in paths.values() for path in each for p in path.points), default=0.0)
        self.ends = self._straight(paths)
        last = [move for move in paths if not paths.keys() & set(self._next(move))]
        for move in last:
            if self.ends[move][0] == inf:
                self.ends[move] = max(self._detour(path) for path in paths[move])
        self._go_on(times_of(input).durations[robot.id].of)

    def _next(self, move: int) -> tuple[int, ...]:
        transition = self._robot.transitions.get(move)
        return transition.next_moves if transition is not None else ()

    def _straight(self, paths: Mapping[int, Sequence[MovePath]]) -> dict[int, tuple[float, str]]:
        every = [path for each in paths.values() for path in each]
        begins = np.array([path.points[-1] for path in every], dtype=np.float64).reshape(-1, 3)
        best = [(inf, "")] * len(every)
        for place, area in self._places.items():
            ends = np.column_stack([np.broadcast_to(place, (len(begins), 2)), begins[:, 2]])
            clear = self._around.clear(begins, ends) & self._around.clear(ends, self._landings(ends))
            for i in np.flatnonzero(clear).tolist():
                best[i] = min(best[i], (self._seconds(every[i], [tuple(ends[i].tolist())]), area))
        found: dict[int, tuple[float, str]] = {}
        for path, each in zip(every, best, strict=True):
            found[path.move] = max(found.get(path.move, each), each)
        return found

    def _landings(self, ends: Floats) -> Floats:
        landings = ends.copy()
        landings[:, 2] = [self._ground((x, y, z)) for x, y, z in ends.tolist()]
        return landings

    def _ground(self, above: Position) -> float:
        return ground_height(above, self._home) if self._kinematics.launches else self._home[2]

    def _seconds(self, path: MovePath, corners: Sequence[Position]) -> float:
        """Return the seconds at most from a path's end over corners to the ground below the last one."""
        legs = sum(self._rates.from_stop_to_stop(*leg) for leg in pairwise((path.points[-1], *corners)))
        over = corners[-1]
        drop = over[2] - self._ground(over)
        if self._kinematics.launches:
            down = self._kinematics.upright_bounds(self._kinematics.landing(drop)).longest
        else:
            down = self._rates.from_stop_to_stop(over, (over[0], over[1], over[2] - drop)) if drop else 0.0
            down += self._kinematics.setting_out().longest + self._kinematics.timing.reporting
        return legs + path.radius / self._kinematics.cruise + down

    def _detour(self, path: MovePath) -> tuple[float, str]:
        """Return the quickest detour found from a path's end, at its own height or at the largest of all."""
        here, found = path.points[-1], [(inf, "")]
        for height in dict.fromkeys((here[2], self._top)):
            above = (here[0], here[1], height)
            for place, area in self._places.items():
                corners = self._around.detour(above, (*place, height))
                way = corners if above == here else [above, *corners]
                if corners and self._around.all_clear([here, *way, (*place, self._ground(corners[-1]))]):
                    found.append((self._seconds(path, way), area))
        return min(found)

    def _go_on(self, durations: Mapping[int, Duration]) -> None:
        """Let each move's end be left by the robot's own path where that leads to a quicker diversion."""
        before: dict[int, list[int]] = {}
        for move in self.ends:
            for after in self._next(move):
                before.setdefault(after, []).append(move)
        pending = [(seconds, move, area) for move, (seconds, area) in self.ends.items() if seconds < inf]
        heapify(pending)
        while pending:
            seconds, move, area = heappop(pending)
            if seconds > self.ends[move][0]:
                continue
            for earlier in before.get(move, ()):
                longer = durations[move].whole.high + seconds
                if longer < self.ends[earlier][0]:
                    self.ends[earlier] = (longer, area)
                    heappush(pending, (longer, earlier, area))


@dataclass(frozen=True, slots=True)
class _Surroundings:
    """What one robot keeps clear of, and where it may land.

    Attributes:
        kept_from: forbidden areas and obstacles; required: metres to keep from each.
        emergency: emergency areas; inwards: metres to keep from the sides of each.
    """

    kept_from: tuple[Area, ...]
    required: tuple[float, ...]
    emergency: tuple[Area, ...]
    inwards: tuple[float, ...]

    @classmethod
    def of(cls, input: CheckInput, robot: RobotProgram) -> _Surroundings:
        own = input.program.position_error + half_diagonal_of(type_of(input, robot))
        room = own + kinematics_of(input, robot).turning_radius
        areas = [area for area in input.areas or () if area.concerns(robot.type_name)]
        kept_from = tuple(area for area in areas if area.use is not AreaUse.EMERGENCY)
        emergency = tuple(area for area in areas if area.use is AreaUse.EMERGENCY)
        return cls(
            kept_from,
            tuple(area.safety_distance + room for area in kept_from),
            emergency,
            tuple(area.safety_distance + own for area in emergency),
        )

    def _boxes(self) -> Iterator[tuple[Floats, Floats]]:
        """Yield, for each area, the corners of a box outside of which every leg keeps its distance."""
        for area, required in zip(self.kept_from, self.required, strict=True):
            shell = np.asarray(area.shell, dtype=np.float64)
            least, most = np.append(shell.min(axis=0), area.low), np.append(shell.max(axis=0), area.high)
            yield least - required, most + required

    def landing(self, place: Point) -> str:
        """Return the emergency area in which a place is far enough from all sides; empty if in none."""
        for area, inwards in zip(self.emergency, self.inwards, strict=True):
            shape = shapely.Polygon(area.shell)
            at = shapely.Point(place)
            if shape.contains(at) and shape.exterior.distance(at) >= inwards - _TOLERANCE:
                return area.name
        return ""

    def clear(self, begins: Floats, ends: Floats) -> np.typing.NDArray[np.bool_]:
        """Return for each of n legs whether it keeps its distance from everything."""
        clear = np.ones(len(begins), np.bool_)
        low, high = np.minimum(begins, ends), np.maximum(begins, ends)
        for number, (least, most) in enumerate(self._boxes()):
            some = np.flatnonzero(clear & (low < most).all(axis=1) & (high > least).all(axis=1))
            clear[some] = self._kept(begins[some], ends[some], number)
        return clear

    def all_clear(self, points: Sequence[Position]) -> bool:
        """Return whether all legs between points do."""
        line = np.asarray(points, dtype=np.float64)
        return bool(self.clear(line[:-1], line[1:]).all())

    def _kept(self, begins: Floats, ends: Floats, number: int) -> np.typing.NDArray[np.bool_]:
        area, required = self.kept_from[number], self.required[number]
        away = prism_distances(begins, ends, area.shell, area.low, area.high)
        kept: np.typing.NDArray[np.bool_] = away >= required - _TOLERANCE
        return kept

    def detour(self, start: Position, goal: Position) -> list[Position]:
        """Return the corners of a level path, the goal included; none if none was found.

        It is the shortest one around the areas that paths were found to come too near to, one after the
        other, until it comes too near to none.
        """
        blocking: dict[int, list[Position]] = {}
        while len(blocking) <= _MOST_AROUND:
            corners = [start, goal, *(corner for each in blocking.values() for corner in each)]
            path = _shortest(corners, self._visible(np.array(corners), blocking))
            legs = np.array([*pairwise(path)]).reshape(-1, 2, 3)
            near = [
                number
                for number in range(len(self.kept_from))
                if number not in blocking and not self._kept(legs[:, 0], legs[:, 1], number).all()
            ]
            if not near or not path:
                return path[1:]
            blocking |= {number: self._corners(number, start[2]) for number in near}
        return []

    def _corners(self, number: int, height: float) -> list[Position]:
        beside = shapely.Polygon(self.kept_from[number].shell).buffer(
            _ASIDE * self.required[number] + 0.01, quad_segs=4
        )
        return [(x, y, height) for x, y in beside.exterior.coords[:-1]]

    def _visible(self, corners: Floats, blocking: Mapping[int, object]) -> np.typing.NDArray[np.bool_]:
        count = len(corners)
        i, j = np.triu_indices(count, 1)
        clear = np.ones(len(i), np.bool_)
        for number in blocking:
            some = np.flatnonzero(clear)
            clear[some] = self._kept(corners[i[some]], corners[j[some]], number)
        seen = np.zeros((count, count), np.bool_)
        seen[i[clear], j[clear]] = seen[j[clear], i[clear]] = True
        return seen


def _shortest(corners: Sequence[Position], seen: np.typing.NDArray[np.bool_]) -> list[Position]:
    """Return the shortest path from the first corner to the second, both included; none if there is none."""
    away, come = {0: 0.0}, dict[int, int]()
    pending, done = [(0.0, 0)], set[int]()
    while pending:
        length, here = heappop(pending)
        if here == 1:
            path = [1]
            while path[-1]:
                path.append(come[path[-1]])
            return [corners[i] for i in reversed(path)]
        if here in done:
            continue
        done.add(here)
        for there in np.flatnonzero(seen[here]).tolist():
            longer = length + dist(corners[here], corners[there])
            if longer < away.get(there, inf):
                away[there], come[there] = longer, here
                heappush(pending, (longer, there))
    return []


DIVERSION = Check(
    name=NAME,
    title="From everywhere on their paths robots reach an emergency area on the rest of their charge.",
    run=for_each_robot(NAME, _judge),
    hint="draw an emergency area nearer to the paths, or let the robot respond otherwise",
)
