"""From earlier versions of the language of underwater vehicles to the one of today."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_auv.names import AUV, VEHICLE
from mmrs_core.languages.evolution.migration import Migration, Refer
from mmrs_core.languages.json_form.stream import TYPE, is_own
from mmrs_core.languages.json_form.tree import Node

PLAIN = "urn:mmrs:robot:1.0#Robot"


def hold_thrusters(robot: Node, refer: Refer) -> None:
    """Let a robot hold the thrusters that its movements held, each once, and let these refer to them.

    Thrusters of several movements that say the same are one. A plain robot becomes an AUV; one of a class
    of a plug-in has a place for them if that class extends AUV.
    """
    movements = [
        each for each in _listed(robot.members.get("movementCapabilities")) if each.kind == "AUVMovement"
    ]
    if not movements:
        return
    held: list[Node] = []
    for movement in movements:
        used = [_held(each, held) for each in _listed(movement.members.get("thrusters"))]
        movement.members["thrusters"] = [refer(each) for each in used]
    robot.members["thrusters"] = held
    if robot.members[TYPE] == PLAIN:
        robot.members[TYPE] = "#".join(VEHICLE)


def _held(thruster: Node, held: list[Node]) -> Node:
    """Return an equal thruster of the held ones; otherwise hold this one."""
    for each in held:
        if _same(each, thruster):
            return each
    held.append(thruster)
    return thruster


def _same(one: object, other: object) -> bool:
    if isinstance(one, Node) and isinstance(other, Node):
        said, reported = ({k: v for k, v in each.members.items() if not is_own(k)} for each in (one, other))
        return said.keys() == reported.keys() and all(_same(said[key], reported[key]) for key in said)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return one == other


def _listed(value: object) -> Iterable[Node]:
    return [each for each in (value if isinstance(value, list) else [value]) if isinstance(each, Node)]


MIGRATIONS = (Migration("urn:mmrs:auv:1.0", AUV, rewrite_holder=hold_thrusters),)
