"""What a plan leaves out of its tasks, since robots must keep away from there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import shapely
from shapely.geometry.base import BaseGeometry

from mmrs_core.geometry.polygons import parts, polygon
from mmrs_core.planning.coverage import blocks_at
from mmrs_core.planning.footprints import GRID
from mmrs_core.planning.pockets import pockets_of
from mmrs_core.scene import Coverage, Omission, Position, Robot, Scene, Serve, Step, Work, all_steps

_LEAST = 0.05
"""Square metres, or metres, under which what is left out is rounding."""


def omissions_of(scene: Scene, steps: Mapping[str, tuple[Step, ...]]) -> tuple[Omission, ...]:
    """Return what robots that go these steps leave out of the tasks that they do.

    Where robots of different sorts share a task, that is what the one leaves out that leaves out least:
    its sort does all that others have not done.
    """
    served = dict[str, list[str]]()
    for robot_name, taken in steps.items():
        for name in dict.fromkeys(each.task for each in all_steps(taken) if isinstance(each, Serve)):
            served.setdefault(name, []).append(robot_name)
    found = list[Omission]()
    for task in scene.tasks:
        works = [(scene.robot(each), scene.works[task.name, each]) for each in served.get(task.name, ())]
        if works:
            robot, work = min(works, key=lambda each: amount_left_out(each[1]))
            found += _of(scene, task.name, robot, work)
    return tuple(found)


def amount_left_out(work: Work) -> float:
    """Return how much of its task a work leaves out, square metres or metres."""
    if work.coverage is not None:
        return float(uncovered(work.coverage).area)
    return sum(gap.length for gap in work.gaps)


def _of(scene: Scene, task: str, robot: Robot, work: Work) -> Iterator[Omission]:
    for gap in work.gaps:
        if gap.length > _LEAST:
            place = f"from {gap.begin:.1f} m along {gap.line}, {_about(gap.at)}"
            why = "closed in by" if gap.closed_in else "too near to"
            yield Omission(task, gap.length, "m", f"{place}, {why} {gap.area}", gap.at)
    if work.coverage is not None:
        up = work.strokes[0].points[0][2]
        left, pockets = uncovered(work.coverage), pockets_of(robot, scene)
        beside = shapely.difference(
            left, shapely.union_all([pocket for pocket, _ in pockets]), grid_size=GRID
        )
        for piece in parts(beside, smallest=_LEAST):
            at = _spot(piece, up)
            yield Omission(task, piece.area, "m²", f"{_about(at)}, too near to {_near(scene, robot, at)}", at)
        for pocket, walls in pockets:
            for piece in parts(shapely.intersection(left, pocket, grid_size=GRID), smallest=_LEAST):
                at, names = _spot(piece, up), ", ".join(f"'{name}'" for name in walls)
                yield Omission(task, piece.area, "m²", f"{_about(at)}, closed in by {names}", at)


def _spot(piece: shapely.Polygon, up: float) -> Position:
    spot = piece.representative_point()
    return (spot.x, spot.y, up)


def _about(at: Position) -> str:
    return f"about ({at[0]:.1f}, {at[1]:.1f})"


def uncovered(coverage: Coverage) -> BaseGeometry:
    """Return what of the polygon that was asked for is outside the target."""
    holes = [polygon(hole) for hole in coverage.holes]
    target = [shapely.Polygon(shell, inner) for shell, inner in coverage.target]
    taken = shapely.union_all([*holes, *target])
    left: BaseGeometry = shapely.difference(polygon(coverage.shell), taken, grid_size=GRID)
    return left


def _near(scene: Scene, robot: Robot, at: Position) -> str:
    names = [
        f"'{area.name}'"
        for area in scene.kept_from(robot)
        if blocks_at(area, robot.clearance, at[2])
        and polygon(area.shell).distance(shapely.Point(at)) <= area.safety_distance + robot.clearance + GRID
    ]
    return ", ".join(names) or "what is kept away from"
