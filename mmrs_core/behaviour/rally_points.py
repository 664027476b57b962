"""Where the robots of a behaviour land or surface in an emergency."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.scene import Area, RobotType
from mmrs_core.scene.rally_points import RallyPoints as RallyPoints
from mmrs_core.scene.rally_points import rally_points


def rally_points_of(
    robot: RobotProgram, program: Program, types: Mapping[str, RobotType], areas: Iterable[Area]
) -> RallyPoints:
    """Return the rally points of a robot, which differ from those of all other robots of the program.

    Args:
        robot: of the program.
        program: of the whole fleet.
        types: robot types by name, as far as they are known.
        areas: of the context as drawn, emergency areas and areas to keep clear of.
    """
    return rally_points(
        [each.id for each in program.robots].index(robot.id),
        [_clearance(each, program, types) for each in program.robots],
        [area for area in areas if area.concerns(robot.type_name)],
        separation=program.minimum_separation,
        heights=_heights(program),
    )


def _clearance(robot: RobotProgram, program: Program, types: Mapping[str, RobotType]) -> float:
    type = types.get(robot.type_name)
    return program.position_error + (type.half_diagonal if type is not None else 0.0)


def _heights(program: Program) -> Iterator[float]:
    homes = [robot.home for robot in program.robots]
    targets = [move.target.position for robot in program.robots for move in robot.moves if move.target]
    return (place[2] for place in (*homes, *targets) if place is not None)
