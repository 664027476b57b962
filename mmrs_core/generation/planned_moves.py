"""What targets know of planned moves: where each leads, and how long it takes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

from mmrs_core.behaviour.as_scene import scene_of
from mmrs_core.behaviour.program import Action, Move, RobotProgram
from mmrs_core.contributions.passages import Passages
from mmrs_core.contributions.rules import most_specific, robot_kind_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Kinematics, Position, RobotType
from mmrs_core.scene.passing import Passage
from mmrs_core.scene.timing import STANDING, MoveSeconds, Push


@dataclass(frozen=True, slots=True)
class PlannedMove:
    """A move of a robot as it is planned.

    Attributes:
        index: of the move in the robot.
        manoeuvre: as in `MoveKind`; empty for other moves, and where no plug-in provides the kind.
        path: positions that the robot passes, the first one where it is before, metres; None where they are
            not known.
        seconds: duration of the move with its device actions, shortest, expected and longest; waits come on
            top. None where it is not known.
    """

    index: int
    manoeuvre: str
    path: tuple[Position, ...] | None
    seconds: MoveSeconds | None


def planned_moves(robot: RobotProgram, input: TargetInput) -> tuple[PlannedMove, ...]:
    """Return the moves of a robot in the order in which it makes them, each once.

    After a Choice follows the move for a condition that holds; moves that are never reached so, or come
    round again, are not repeated.
    """
    return tuple(_planned(robot, input))


def kinematics_of(robot: RobotProgram, input: TargetInput) -> Kinematics | None:
    """Return the speeds, rates and limits of a robot by its kind; None where they are not known."""
    type = input.types.get(robot.type_name)
    kind = robot_kind_of(type, input.robot_kinds) if type is not None else None
    if type is None or kind is None or robot.home is None:
        return None
    alone = replace(input.program, robots=(robot,))
    scene = scene_of(
        alone, input.types, areas=input.areas, environment=input.environment, elements=input.elements
    )
    try:
        return kind.kinematics(scene.robots[0], scene)
    except InfeasibleError:
        return None


def _planned(robot: RobotProgram, input: TargetInput) -> Iterator[PlannedMove]:
    kinematics, type = kinematics_of(robot, input), input.types.get(robot.type_name)
    here = robot.home
    passed: Passage | None = None
    entering = 0.0
    facing: float | None = None
    push: Push | None = STANDING
    local = input.program.frame.is_local
    passages = Passages(robot, type, input.move_kinds, kinematics, local=local) if kinematics else None
    for index in _order(robot):
        move = robot.moves[index]
        name = most_specific(move.metaclasses, input.move_kinds)
        kind = input.move_kinds[name] if name is not None else None
        path = kind.path(move, here, robot.home) if kind is not None and here is not None else None
        seconds = None
        if kind is not None and path is not None and passages is not None:
            ahead = passages.ahead(move, path, passed, push)
            saved = sum((passed.onward if passed else 0.0, ahead.saved if ahead else 0.0))
            passed = ahead
            limits = replace(passages.kinematics(move), facing=facing, push=push, entering=entering)
            entering = (move.speed or limits.cruise) if ahead is not None else 0.0
            duration = kind.seconds(move, path, limits, robot.travel_mode)
            facing = passages.facing(move, path, facing) if ahead is None else None
            push = passages.push(move, path, push)
            seconds = _seconds(move, duration, saved, type)
        yield PlannedMove(index, kind.manoeuvre if kind is not None else "", path, seconds)
        here = path[-1] if path else None


def _order(robot: RobotProgram) -> Iterator[int]:
    passed: set[int] = set()
    at: int | None = robot.start
    while at is not None and at not in passed:
        passed.add(at)
        yield at
        transition = robot.transitions.get(at)
        at = transition.to if transition is not None else None


def _seconds(move: Move, duration: MoveSeconds, saved: float, type: RobotType | None) -> MoveSeconds | None:
    """Return the duration of a move with its actions, less the seconds that passing its ends saves."""
    acting = sum(_acting(action, type) for action in (*move.before, *move.after))
    if duration.longest + acting == inf:
        return None
    expected = max(duration.shortest, duration.expected - saved)
    return MoveSeconds(duration.shortest + acting, expected + acting, duration.longest + acting)


def _acting(action: Action, type: RobotType | None) -> float:
    """Return the seconds that an action takes; none unless a device acts, infinity where it is not known."""
    if not action.device:
        return 0.0
    device = type.devices.get(action.device) if type is not None else None
    known = device.actions.get(action.name) if device is not None else None
    return known.duration if known is not None else inf
