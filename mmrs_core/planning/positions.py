"""Where a robot may be: between its floor and ceiling, and clear of everything as drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import atan2, cos, pi, sin

from mmrs_core.diagnostics import lengths
from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.segments import legs_of, prism_distance
from mmrs_core.scene import Area, Position, Robot, Scene

MARGIN = 1.01
"""Stand-off positions keep a little more than the clearance, because planners round it up."""

BEARINGS = 24

SLACK = 5e-7
"""Metres that may be lost by rounding; with what written coordinates lose, checks still tolerate it."""


def refuse_heights(robot: Robot, points: Iterable[Position]) -> None:
    """Check that positions lie between a robot's floor and ceiling.

    Raises:
        InfeasibleError: one does not; says by how much.
    """
    if robot.kinematics is None:
        return
    floor, ceiling = robot.kinematics.floor, robot.kinematics.ceiling
    for _, _, up in points:
        if floor == ceiling and abs(up - floor) > SLACK:
            own, other = lengths(floor, up)
            raise InfeasibleError(f"stays on its level at {own}, cannot get to {other}")
        if up > ceiling + SLACK:
            reached, over, limit = lengths(up, up - ceiling, ceiling)
            raise InfeasibleError(f"{reached} is {over} above the ceiling {limit}")
        if up < floor - SLACK:
            reached, under, limit = lengths(up, floor - up, floor)
            raise InfeasibleError(f"{reached} is {under} below the floor {limit}")


def refuse_unsteady(robot: Robot) -> None:
    """Check that a robot can hold a position.

    Raises:
        InfeasibleError: it cannot; gives its smallest speed.
    """
    if robot.kinematics is not None and robot.kinematics.slowest > 0.0:
        raise InfeasibleError(f"holds no position: its smallest speed is {robot.kinematics.slowest:g} m/s")


def refuse_blocked(robot: Robot, scene: Scene, points: Sequence[Position], what: str) -> None:
    """Check that a polyline keeps the robot's clearance from every area as drawn, if only just.

    Raises:
        InfeasibleError: it does not; names the area and what is short.
    """
    for area in _around(robot, scene, points):
        short = area.safety_distance + robot.clearance - _distance(points, area)
        if short > SLACK:
            raise InfeasibleError(f"{what} comes {lengths(short)[0]} too near to '{area.name}'")


def stand_off(
    robot: Robot, scene: Scene, point: Position, near: float, far: float
) -> tuple[Position, Position]:
    """Return the ends of a clear level leg towards a point: from `far` to `near` metres before it.

    The side that faces the team's homes comes first, then others by how little they differ from it.

    Raises:
        InfeasibleError: no side is clear.
    """
    for bearing in _bearings(scene, point):
        east, north = sin(bearing), cos(bearing)
        begin = (point[0] + far * east, point[1] + far * north, point[2])
        end = (point[0] + near * east, point[1] + near * north, point[2])
        if _is_clear(robot, scene, (begin, end)):
            return begin, end
    raise InfeasibleError(f"no clear place is {lengths(far)[0]} from the point on any side")


def _distance(points: Sequence[Position], area: Area) -> float:
    return float(prism_distance(legs_of(points), area.shell, area.low, area.high).min())


def _is_clear(robot: Robot, scene: Scene, points: Sequence[Position]) -> bool:
    return all(
        _distance(points, area) >= MARGIN * (area.safety_distance + robot.clearance)
        for area in _around(robot, scene, points)
    )


def _around(robot: Robot, scene: Scene, points: Sequence[Position]) -> Iterator[Area]:
    """Yield the areas that a robot keeps away from, less those whose rectangles are far enough away."""
    east, north = ([point[axis] for point in points] for axis in (0, 1))
    west_end, east_end, south_end, north_end = min(east), max(east), min(north), max(north)
    for area in scene.kept_from(robot):
        keeps = area.safety_distance + robot.clearance
        x, y = ([corner[axis] for corner in area.shell] for axis in (0, 1))
        aside = max(min(x) - east_end, west_end - max(x), min(y) - north_end, south_end - max(y))
        if aside <= keeps:
            yield area


def bearing_of_homes(scene: Scene, point: Position) -> float:
    """Return in which direction the middle of the robots' homes lies from a point, radians from north."""
    count = len(scene.robots) or 1
    east = sum(robot.home[0] for robot in scene.robots) / count - point[0]
    north = sum(robot.home[1] for robot in scene.robots) / count - point[1]
    return atan2(east, north)


def _bearings(scene: Scene, point: Position) -> Iterator[float]:
    first = bearing_of_homes(scene, point)
    for step in range(BEARINGS):
        turn = (step + 1) // 2 * (1 if step % 2 else -1)
        yield first + turn * 2 * pi / BEARINGS
