"""Moves of the Behaviour Language as movements of the runtime's programs.

Which metaclasses the target knows is the table at the end: a move whose own metaclass is not in it
is refused, even where it extends one that is, because its movement may differ.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import isfinite

from mmrs_core.behaviour.program import BEHAVIOUR, Heading, Move, Target
from mmrs_core.contributions.rules import most_specific
from mmrs_core.generation.escaping import Call
from mmrs_core.mavlink.earth import metres
from mmrs_core.mavlink.vehicles import ROVER
from mmrs_core.scene import Name, Position
from mmrs_mavlink.plugin.context import RobotContext

MULTICOPTER = "urn:mmrs:multicopter:1.0"

NO_TURNING = "no ground vehicle turns to a heading on command; give the device a mavlink.gimbal"

LEGS = {"DIRECT": "direct", "HORIZONTAL_FIRST": "level first", "VERTICAL_FIRST": "climb first"}


def movement_of(move: Move, context: RobotContext) -> Call:
    """Return the movement of a move; ``Skip`` where the target has none."""
    known = most_specific(move.metaclasses, MOVEMENTS)
    if known is None:
        return Call("Skip", (f"{move.kind} is not known to this target",))
    return MOVEMENTS[known](move, context)


def losses_of(move: Move, context: RobotContext) -> tuple[str, ...]:
    """Return what of the movement cannot be expressed."""
    if most_specific(move.metaclasses, MOVEMENTS) != move.metaclasses[0]:
        return (f"{context.label(move)}: {move.kind} is not known to this target",)
    losses = []
    if move.metaclasses[0][1] == "GoTo" and context.speed(move) is None:
        losses.append(f"{context.label(move)}: its speed is not known, because its robot type is not given")
    if move.heading is not None:
        losses += [f"{context.label(move)}: {why}" for why in _unseen(move.heading, context)]
    if move.metaclasses[0] == (MULTICOPTER, "TakeOff") and _number(move, "altitude") <= 0:
        losses.append(f"{context.label(move)}: takes off to {_number(move, 'altitude'):g} m above the ground")
    return tuple(losses)


def _unseen(heading: Heading, context: RobotContext) -> Iterator[str]:
    """Yield why a device cannot be pointed as a heading says."""
    if not turns_to(heading, context):
        yield NO_TURNING
    if not _is_number(_properties(heading, context).get("mount.yaw", "0")):
        yield f"device '{heading.device}': mount.yaw is no number"
    if on_gimbal(heading, context):
        if heading.angle_degrees:
            yield "a gimbal points straight at its target, not at an angle to it"
        if context.frame.is_local:
            yield "a gimbal is pointed at places on the Earth, and the behaviour is local"


def on_gimbal(heading: Heading, context: RobotContext) -> bool:
    """Return whether the device that a heading is of turns by itself."""
    return "mavlink.gimbal" in _properties(heading, context)


def mount_of(heading: Heading, context: RobotContext) -> float:
    """Return where the device of a heading points when the robot looks north, degrees clockwise.

    It is 0 where the property holds no number, which is refused.
    """
    given = _properties(heading, context).get("mount.yaw", "0")
    return float(given) if _is_number(given) else 0.0


def _is_number(text: str) -> bool:
    try:
        return isfinite(float(text))
    except ValueError:
        return False


def turns_to(heading: Heading, context: RobotContext) -> bool:
    """Return whether the vehicle, or the device on it, can be told to turn to a heading.

    ArduPilot's Rover takes no heading: it ignores the yaw of position targets in GUIDED, and
    skips CONDITION_YAW in AUTO.
    """
    return context.vehicle is not ROVER or on_gimbal(heading, context)


def place_of(position: Position, context: RobotContext) -> Call:
    """Return a position as a place of the runtime's programs."""
    if context.frame.is_local:
        home = context.robot.home or (0.0, 0.0, 0.0)
        north, east = metres(position[1] - home[1]), metres(position[0] - home[0])
        return Call("Local", (north, east, context.height(position)))
    latitude, longitude = context.degrees[position[0], position[1]]
    return Call("Geographic", (latitude, longitude, context.height(position)))


def objects_of(move: Move) -> tuple[str, ...]:
    """Return the descriptions of the objects that a move goes to or points at."""
    targets = (move.target, move.heading.target if move.heading else None)
    return tuple(target.description for target in targets if target and target.description is not None)


def _start(move: Move, context: RobotContext) -> Call:
    return Call("Start")


def _stop(move: Move, context: RobotContext) -> Call:
    return Call("Stop")


def _take_off(move: Move, context: RobotContext) -> Call:
    return Call("TakeOff", (metres(_number(move, "altitude")),))


def _land(move: Move, context: RobotContext) -> Call:
    return Call("Land")


def _go_to(move: Move, context: RobotContext) -> Call:
    if move.target is None:
        return Call("Skip", ("it has no target",))
    named: list[tuple[str, object]] = [("speed", context.speed(move))]
    legs = LEGS[str(move.attributes.get("trajectory", "DIRECT"))]
    if legs != "direct":
        named.append(("legs", legs))
    if move.distance:
        named.append(("distance", metres(move.distance)))
    look = _look(move.heading, context)
    if look is not None:
        named.append(("look", look))
    return Call("GoTo", (_target(move.target, context),), tuple(named))


def _hold(move: Move, context: RobotContext) -> Call:
    return Call("Hold", (_number(move, "duration"),))


def _recharge(move: Move, context: RobotContext) -> Call:
    return Call("Recharge", (_number(move, "duration"),))


def _turn(move: Move, context: RobotContext) -> Call:
    look = _look(move.heading, context)
    why = NO_TURNING if move.heading is not None else "it has no heading"
    return Call("Turn", (look,)) if look else Call("Skip", (why,))


def _look(heading: Heading | None, context: RobotContext) -> Call | None:
    if heading is None or not turns_to(heading, context):
        return None
    properties = _properties(heading, context)
    named: list[tuple[str, object]] = []
    if heading.angle_degrees:
        named.append(("angle", metres(heading.angle_degrees)))
    if "mount.yaw" in properties:
        named.append(("mount", mount_of(heading, context)))
    if on_gimbal(heading, context):
        named.append(("gimbal", True))
        if device := gimbal_of(heading, context):
            named.append(("device", device))
    return Call("Look", (_target(heading.target, context),), tuple(named))


def gimbal_of(heading: Heading, context: RobotContext) -> int:
    """Return the number of the gimbal that a heading is of; 0 where the property gives none."""
    number = _properties(heading, context).get("mavlink.gimbal", "")
    return int(number) if number.isdecimal() else 0


def _properties(heading: Heading, context: RobotContext) -> Mapping[str, str]:
    """Return how the device is wired that a heading is of; nothing for the front of the robot."""
    device = context.type.devices.get(heading.device) if context.type else None
    return device.properties if device else {}


def _target(target: Target, context: RobotContext) -> Call:
    place = None if target.position is None else place_of(target.position, context)
    if target.description is None:
        if place is None:
            raise ValueError("a coordinate has no position")
        return place
    return Call("Object", (target.description, place, target.tolerance))


def _number(move: Move, feature: str) -> float:
    value = move.attributes.get(feature)
    return float(value) if isinstance(value, int | float) else 0.0


MOVEMENTS: Mapping[Name, Callable[[Move, RobotContext], Call]] = {
    (BEHAVIOUR, "Start"): _start,
    (BEHAVIOUR, "Stop"): _stop,
    (BEHAVIOUR, "GoTo"): _go_to,
    (BEHAVIOUR, "HoldPosition"): _hold,
    (BEHAVIOUR, "Recharge"): _recharge,
    (BEHAVIOUR, "HeadTo"): _turn,
    (MULTICOPTER, "TakeOff"): _take_off,
    (MULTICOPTER, "Land"): _land,
    (MULTICOPTER, "GoTo"): _go_to,
}
