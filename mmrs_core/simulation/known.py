"""Kinematics and move kinds of a robot, by what plug-ins provide; unknown kinds are refused."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.behaviour.as_scene import scene_of
from mmrs_core.behaviour.program import DEVICE_ACTION, FEEDBACK, Action
from mmrs_core.contributions.rules import MoveKind, most_specific, robot_kind_of
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.scene import Kinematics


def kinematics_of(given: VehicleInput) -> Kinematics:
    """Return what the robot can do with full batteries and nothing kept in reserve.

    Raises:
        UnsupportedError: if no plug-in provides a robot kind for its type.
        InfeasibleError: if its type lacks the figures.
    """
    kind = robot_kind_of(given.type, given.robot_kinds)
    if kind is None:
        who = f"robot '{given.robot.id}': type '{given.type.name}'"
        raise UnsupportedError(f"{who}: no plug-in provides its robot kind", [who])
    alone = replace(given.program, robots=(given.robot,))
    types = {given.robot.type_name: given.type}
    scene = scene_of(alone, types, environment=given.environment, elements=given.elements, reserve=0.0)
    return kind.kinematics(scene.robots[0], scene)


def move_kinds_of(given: VehicleInput) -> dict[str, MoveKind]:
    """Return the kind of every move, by its identifier.

    Raises:
        UnsupportedError: if moves or actions are of unknown kinds; lists all of them.
    """
    kinds: dict[str, MoveKind] = {}
    unknown: list[str] = []
    for move in given.robot.moves:
        where = f"robot '{given.robot.id}', move '{move.id}'"
        name = most_specific(move.metaclasses, given.move_kinds)
        if name is None:
            unknown.append(f"{where}: {move.kind}")
        else:
            kinds[move.id] = given.move_kinds[name]
        strange = (action for action in (*move.before, *move.after) if not _is_known(action))
        unknown.extend(f"{where}: action {action.metaclasses[0][1]}" for action in strange)
    if unknown:
        raise UnsupportedError(f"robot '{given.robot.id}': moves or actions of unknown kinds", unknown)
    return kinds


def _is_known(action: Action) -> bool:
    return action.notifies or action.is_a(DEVICE_ACTION) or action.is_a(FEEDBACK)
