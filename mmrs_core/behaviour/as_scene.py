"""The robots of a behaviour as a scene, for what needs one although there is no mission."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.errors import UnsupportedError
from mmrs_core.scene import Area, Part, Robot, RobotType, Scene

ORIGIN = (0.0, 0.0, 0.0)


def robot_of(robot: RobotProgram, type: RobotType, position_error: float = 0.0) -> Robot:
    """Return a robot of a behaviour as planners and robot kinds see it.

    A home that the behaviour leaves open is the origin.
    """
    return Robot(
        name=robot.id,
        type=type,
        home=robot.home if robot.home is not None else ORIGIN,
        return_home=False,
        payload=robot.payload,
        travel_mode=robot.travel_mode,
        clearance=type.half_diagonal + position_error,
        place=robot.place,
    )


def carries_out(program: Program, mission: Scene) -> bool:
    """Return whether a behaviour may be planned from a mission: it has its frame, and serves its tasks."""
    served = {move.task for robot in program.robots for move in robot.moves if move.task}
    return program.frame.agrees_with(mission.frame) and served <= {task.name for task in mission.tasks}


def scene_of(
    program: Program,
    types: Mapping[str, RobotType],
    *,
    areas: tuple[Area, ...] = (),
    environment: Mapping[str, float] | None = None,
    elements: tuple[Part, ...] = (),
    reserve: float | None = None,
) -> Scene:
    """Return a scene of the behaviour's robots, without tasks.

    Args:
        program: the behaviour.
        types: robot types by name.
        areas: of the context.
        environment: of the context, by attribute name.
        elements: of the context, of plug-ins.
        reserve: part of lifetime and energy that robots must leave; None: the behaviour's own.

    Raises:
        UnsupportedError: if types are missing; lists each robot without one.
    """
    missing = [f"robot '{r.id}': type '{r.type_name}'" for r in program.robots if r.type_name not in types]
    if missing:
        raise UnsupportedError(f"robot types of {len(missing)} robots are missing", missing)
    error = program.position_error
    return Scene(
        name=program.name,
        frame=program.frame,
        tasks=(),
        dependencies=(),
        robots=tuple(robot_of(robot, types[robot.type_name], error) for robot in program.robots),
        areas=areas,
        elements=elements,
        environment=environment or {},
        minimum_separation=program.minimum_separation,
        reserve=program.reserve if reserve is None else reserve,
        position_error=error,
        accepted_unknowns=program.accepted_unknowns,
    )
