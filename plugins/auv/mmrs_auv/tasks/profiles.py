"""Rules for profiles through the water column, down and up along a line, and for fixes at the surface."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate, pairwise
from math import dist, floor, inf, radians, tan

from mmrs_auv.names import SURFACE_TASK, YO_YO_TASK
from mmrs_auv.tasks.surveys import recorded
from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.open_lines import OpenLine, open_line
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Part, Point, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, position, positions

MOST_WAVES = 5_000
"""Times at most that one line goes down and up."""


def yo_yo_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return one stroke along the line between two depths, no steeper than asked for.

    It begins and ends at the upper depth, with all legs down and up equally long. Where it is too near
    to something, there is one for each part of the line that keeps clear of that at all these depths.
    """
    part, surface = task.part, scene.frame.surface
    line = _level(positions(part, "points"))
    upper, lower, pitch = (_needed(part, name) for name in ("minDepth", "maxDepth", "pitch"))
    if not (0.0 <= upper < lower and 0.0 < pitch < 90.0):
        raise InfeasibleError(f"no profile from {upper:g} to {lower:g} m of depth at {pitch:g} degrees")
    length = sum(dist(a, b) for a, b in pairwise(line))
    wave = 2.0 * (lower - upper) / tan(radians(pitch))
    if length < wave * (1.0 - 1e-9):
        raise InfeasibleError(f"the line of {length:.1f} m is too short to go down and up, {wave:.1f} m")
    if length > MOST_WAVES * wave:
        raise InfeasibleError(f"goes down and up {length / wave:,.0f} times, of {MOST_WAVES:,} at most")
    top, bottom = surface - upper, surface - lower
    initial = position(part, "initialPosition")
    entry = (initial[0], initial[1], top)
    points = _waves(line, wave, top, bottom)
    refuse_heights(robot, (entry, *points))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    level = tuple((east, north, top) for east, north in line)
    whole = OpenLine((level,), (), ((0, (0.0, length)),))
    clear = open_line(robot, scene, points, "the line").gaps == ()
    found = (
        whole if clear else open_line(robot, _at(scene, robot, top, bottom), level, "the line", least=wave)
    )
    strokes = []
    for way, (_, stretch) in zip(found.parts, found.stretches, strict=True):
        points = _waves(_level(way), wave, top, bottom)
        stroke = Stroke(
            points, cuts=tuple(_climbs(points)), reversible=True, part="the line", stretch=stretch
        )
        strokes.append(recorded(part, robot, stroke))
    return Work(tuple(strokes), divisible=True, rule="yo_yo", entry=entry, gaps=found.gaps)


def _waves(line: tuple[Point, ...], wave: float, top: float, bottom: float) -> tuple[Position, ...]:
    """Return the path down and up along a line, with as many waves as fit."""
    length = sum(dist(a, b) for a, b in pairwise(line))
    waves = floor(length / wave + 1e-9)
    return tuple(
        (east, north, top - (top - bottom) * _drop(at, length / waves))
        for at, (east, north) in _stops(line, length, 2 * waves)
    )


def _at(scene: Scene, robot: Robot, top: float, bottom: float) -> Scene:
    """Return a scene in which what a robot keeps from between two heights reaches over all heights."""
    return replace(
        scene,
        areas=tuple(
            replace(area, low=-inf, high=inf)
            for area in scene.areas
            if area.low < top + (keep := area.safety_distance + robot.clearance) and area.high > bottom - keep
        ),
    )


def _needed(part: Part, name: str) -> float:
    found = number(part, name)
    if found is None:
        raise InfeasibleError(f"{name} is missing")
    return found


def _level(points: tuple[Position, ...]) -> tuple[Point, ...]:
    """Return the line as seen from above, without points that only repeat the one before."""
    line = [(east, north) for east, north, _ in points]
    if not line:
        raise InfeasibleError("points are missing")
    return (line[0], *(b for a, b in pairwise(line) if dist(a, b) > 1e-6))


def _drop(at: float, wave: float) -> float:
    """Return how far down a path is after `metres`: 0 is up, 1 is down."""
    share = at / wave % 1.0
    return 1.0 - abs(1.0 - 2.0 * share)


def _stops(line: tuple[Point, ...], length: float, ways: int) -> Iterator[tuple[float, Point]]:
    """Yield arc length and place of each vertex and each turning point, in order."""
    turns = [length * index / ways for index in range(ways + 1)]
    corners = [0.0, *accumulate(dist(a, b) for a, b in pairwise(line))]
    kept = [at for at in corners[1:-1] if min(abs(at - turn) for turn in turns) > 1e-6]
    leg = 0
    for at in sorted((*turns, *kept)):
        while leg < len(line) - 2 and at > corners[leg + 1]:
            leg += 1
        share = (at - corners[leg]) / (corners[leg + 1] - corners[leg])
        (east, north), (east_to, north_to) = line[leg], line[leg + 1]
        yield at, (east + share * (east_to - east), north + share * (north_to - north))


def _climbs(points: tuple[Position, ...]) -> Iterator[float]:
    """Yield where along the way, metres, the line is up again, ends left out."""
    travelled = 0.0
    for before, here, after in zip(points, points[1:], points[2:], strict=False):
        travelled += dist(before, here)
        if before[2] < here[2] > after[2]:
            yield travelled


YO_YO_RULE = Rule("yo_yo", YO_YO_TASK, yo_yo_work)


def surface_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the position at the surface above the point, and how long to stay there.

    Raises:
        InfeasibleError: the robot is never below the surface, or cannot get there.
    """
    east, north, _ = position(task.part, "point")
    place = (east, north, scene.frame.surface)
    if robot.kinematics is not None and robot.kinematics.floor >= scene.frame.surface:
        raise InfeasibleError("does not dive, so that it cannot surface")
    refuse_heights(robot, (place,))
    refuse_blocked(robot, scene, (place,), "the position at the surface")
    return Work(
        (Stroke((place,), hold=number(task.part, "duration") or 0.0),), divisible=False, rule="surface_fix"
    )


SURFACE_RULE = Rule("surface_fix", SURFACE_TASK, surface_work)
