"""Corridors through which a robot goes from home to its tasks, or back: where it flies or drives in them.

It goes along a corridor's line, from the one end to the other, at one height. Areas go first: where the line
comes too near to one at every height of the corridor, the robot cannot use it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import dist
from typing import Literal

import shapely

from mmrs_core.diagnostics import lengths
from mmrs_core.geometry.clearance import EPSILON
from mmrs_core.planning.paths import Space
from mmrs_core.scene import Area, Corridor, Kinematics, Point, Position, Robot, Transit
from mmrs_core.scene.plans import Recover, Serve, Step

Direction = Literal["in", "out"]

_ABOVE = 1e-3
"""Metres that a height is above or below what an area blocks."""

_SLACK = 1e-9
"""Metres by which a corridor may seem too narrow: the noise of rounding."""


@dataclass(frozen=True, slots=True)
class CorridorPath:
    """A robot's path through one corridor: the corridor's name, and positions at one height."""

    corridor: str
    points: tuple[Position, ...]

    @property
    def height(self) -> float:
        """Return the height at which it leads, metres."""
        return self.points[0][2]


class Corridors:
    """The corridors of one robot in one direction; it remembers its passages by height."""

    def __init__(
        self,
        corridors: Iterable[Corridor],
        direction: Direction,
        robot: Robot,
        kinematics: Kinematics,
        space: Space,
        areas: Iterable[Area],
    ) -> None:
        """Make them for a robot.

        Args:
            corridors: that are for the robot, in either direction.
            direction: in, from home to tasks; or out, back home.
            robot: with the clearance that it keeps from areas, and from a corridor's sides.
            kinematics: of the robot.
            space: of the robot.
            areas: that it keeps away from, as drawn.
        """
        found = ((each, each.way_in if direction == "in" else each.way_out) for each in corridors)
        self._lines = [(corridor, line) for corridor, line in found if line]
        self._clearance, self._kinematics, self._space = robot.clearance, kinematics, space
        self._areas, self._direction = tuple(areas), direction
        self._known: dict[float, tuple[list[CorridorPath], list[str]]] = {}

    def __bool__(self) -> bool:
        """Return whether the robot must go through one of them."""
        return bool(self._lines)

    def passages(self, wanted: float) -> list[CorridorPath]:
        """Return the path through each corridor that the robot can use, as near to a height as can be."""
        return self._at(wanted)[0]

    def why_not(self, wanted: float) -> str:
        """Return why the robot cannot use corridors, each by its name, and by how much; empty: it can."""
        faults = self._at(wanted)[1]
        return f"no corridor leads it {self._direction}: {'; '.join(faults)}" if faults else ""

    def _at(self, wanted: float) -> tuple[list[CorridorPath], list[str]]:
        if wanted not in self._known:
            found = [self._passage(corridor, line, wanted) for corridor, line in self._lines]
            passages = [each for each in found if isinstance(each, CorridorPath)]
            self._known[wanted] = passages, [each for each in found if isinstance(each, str)]
        return self._known[wanted]

    def _passage(self, corridor: Corridor, line: Sequence[Point], wanted: float) -> CorridorPath | str:
        fault = _misfit(corridor, self._clearance, self._kinematics)
        if fault:
            return fault
        low, high = _band(corridor, self._clearance, self._kinematics)
        for level in self._levels(line, low, high, wanted):
            points = tuple((east, north, level) for east, north in line)
            if self._space.is_clear(points) and self._space.in_range(points):
                return CorridorPath(corridor.name, points)
        return self._blocked(corridor, line, min(max(wanted, low), high))

    def _levels(self, line: Sequence[Point], low: float, high: float, wanted: float) -> list[float]:
        """Return the heights that are worth a try, the nearest to the wanted one first."""
        track = shapely.LineString(line)
        near = [
            (area, area.safety_distance + self._clearance + _ABOVE)
            for area in self._areas
            if track.distance(shapely.Polygon(area.shell)) < area.safety_distance + self._clearance + EPSILON
        ]
        beside = [level for area, away in near for level in (area.low - away, area.high + away)]
        levels = {min(max(wanted, low), high), *(level for level in beside if low <= level <= high)}
        return sorted(levels, key=lambda level: (abs(level - wanted), level))

    def _blocked(self, corridor: Corridor, line: Sequence[Point], level: float) -> str:
        """Return which areas are in the way, and by how much the line comes too near to them."""
        points = [(east, north, level) for east, north in line]
        names = self._space.blockers(points)
        if not names and self._space.reach is not None:
            return f"corridor '{corridor.name}' is out of range: {self._space.reach.beyond(points)}"
        track = shapely.LineString(line)
        short = [
            area.safety_distance + self._clearance - track.distance(shapely.Polygon(area.shell))
            for area in self._areas
            if f"'{area.name}'" in names
        ]
        (told,) = lengths(max(short, default=0.0))
        return f"corridor '{corridor.name}' is blocked by {names}: {told} too near to its line"


def _band(corridor: Corridor, clearance: float, kinematics: Kinematics) -> tuple[float, float]:
    """Return the lowest and the highest height at which a robot may go through a corridor."""
    return (
        max(corridor.low + clearance, kinematics.floor),
        min(corridor.high - clearance, kinematics.ceiling),
    )


def _misfit(corridor: Corridor, clearance: float, kinematics: Kinematics) -> str:
    """Return why a robot does not fit into a corridor, and by how much; empty: it fits."""
    name, needed = f"corridor '{corridor.name}'", 2.0 * clearance
    if corridor.width < needed - _SLACK:
        has, least, short = lengths(corridor.width, needed, needed - corridor.width)
        return f"{name} is {has} wide, {least} are needed: {short} too narrow"
    if corridor.high - corridor.low < needed - _SLACK:
        has, least, short = lengths(
            corridor.high - corridor.low, needed, needed - (corridor.high - corridor.low)
        )
        return f"{name} is {has} high, {least} are needed: {short} too low"
    low, high = _band(corridor, clearance, kinematics)
    if low > high + _SLACK:
        begin, end = f"{round(low, 2):g} m", f"{round(high, 2):g} m"
        if corridor.low + clearance > kinematics.ceiling:
            return f"{name} begins {begin} up for it, it may go up to {end}: {low - high:.1f} m short"
        return f"{name} ends {end} up for it, it may go down to {begin}: {low - high:.1f} m short"
    return ""


def crossings(name: str, steps: Iterable[Step], corridors: Sequence[Corridor]) -> Iterator[str]:
    """Yield where a robot goes past corridors from task to task: one lies in front of them.

    That is where the outer end of a corridor in is the nearest of all their ends.
    """
    ends = [(each.way_in[end][:2], end) for each in corridors if each.way_in for end in (0, -1)]
    before: tuple[str, int] | None = None
    for step in steps if ends else ():
        if isinstance(step, Recover):
            before = None
        elif isinstance(step, Serve):
            first, last = (
                min((dist(place[:2], end), side) for end, side in ends)[1]
                for place in (step.stroke.points[0], step.stroke.points[-1])
            )
            if before is not None and before[0] != step.task and before[1] != first:
                yield (
                    f"'{name}' goes from task '{before[0]}' to task '{step.task}' past its corridors:"
                    " one of them lies in front of these"
                )
            before = (step.task, last)


def gone_through(steps: Iterable[Step], corridors: Sequence[Corridor]) -> dict[str, list[str]]:
    """Return the names of the corridors that steps lead through, by direction, each once."""
    found: dict[str, list[str]] = {"in": [], "out": []}
    for step in steps:
        if not isinstance(step, Transit):
            continue
        places = tuple(point[:2] for point in step.route)
        for corridor in corridors:
            for direction, line in (("in", corridor.way_in), ("out", corridor.way_out)):
                runs = range(len(places) - len(line) + 1) if line else ()
                through = any(places[i : i + len(line)] == line for i in runs)
                if through and corridor.name not in found[direction]:
                    found[direction].append(corridor.name)
    return found
