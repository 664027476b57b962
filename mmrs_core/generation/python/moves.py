"""Moves and actions of the Behaviour Language in the words of the runtime's programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import (
    BEHAVIOUR,
    DEVICE_ACTION,
    FEEDBACK,
    NOTIFY,
    Action,
    Heading,
    Move,
    MoveTarget,
)
from mmrs_core.contributions.rules import most_specific
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.escaping import Call
from mmrs_core.scene import Name, Position
from mmrs_core.scene.attributes import finite

if TYPE_CHECKING:
    from mmrs_core.generation.python.driver import Movement, PythonDriver

    Driver = PythonDriver[Any]


def movement_of(move: Move, context: RobotContext, driver: Driver) -> Call:
    """Return the movement of a move; ``Skip`` where the driver has none."""
    movements = driver.movements_of(context)
    known = most_specific(move.metaclasses, movements)
    if known is None:
        return Call("Skip", (f"{move.kind} is not known to this target",))
    return movements[known](move, context, driver)


def action_of(action: Action, context: RobotContext, driver: Driver) -> Call:
    """Return an action; ``NoEffect`` where it cannot be expressed."""
    if action.is_a(NOTIFY):
        return Call("Notify", (action.sets,), () if action.active else (("active", False),))
    if action.is_a(FEEDBACK):
        return Call("Report", (action.name, action.parameters))
    if not action.is_a(DEVICE_ACTION):
        return Call("NoEffect", (action.name, f"{action.metaclasses[0][1]} is not known to this target"))
    found = driver.device(action, context)
    return Call("NoEffect", (action.name, found)) if isinstance(found, str) else found


def losses_of(move: Move, context: RobotContext, driver: Driver) -> Iterator[str]:
    """Yield what of a movement cannot be expressed."""
    label = context.label(move)
    if most_specific(move.metaclasses, driver.movements_of(context)) != move.metaclasses[0]:
        yield f"{label}: {move.kind} is not known to this target"
        return
    if move.metaclasses[0][1] == "GoTo" and context.speed(move) is None:
        yield f"{label}: its speed is not known, because its robot type is not given"
    if move.heading is not None:
        yield from (f"{label}: {why}" for why in driver.unseen(move.heading, context))
    yield from (f"{label}: {why}" for why in driver.unsaid(move, context))


def action_losses(move: Move, context: RobotContext, driver: Driver) -> Iterator[str]:
    """Yield what of a move's actions cannot be expressed."""
    for action in (*move.before, *move.after):
        if action.is_a(DEVICE_ACTION):
            found = driver.device(action, context)
            if isinstance(found, str):
                yield f"{context.label(move)}: action '{action.name}': {found}"
        elif not (action.is_a(NOTIFY) or action.is_a(FEEDBACK)):
            kind = action.metaclasses[0][1]
            yield f"{context.label(move)}: action {kind} is not known to this target"


def place_of(position: Position, context: RobotContext) -> Call:
    """Return a position as a place of the runtime's programs."""
    if context.frame.is_local:
        home = context.robot.home or (0.0, 0.0, 0.0)
        north, east = metres(position[1] - home[1]), metres(position[0] - home[0])
        return Call("Local", (north, east, context.height(position)))
    latitude, longitude = context.degrees.at((position[0], position[1]))
    return Call("Geographic", (latitude, longitude, context.height(position)))


def objects_of(move: Move) -> tuple[str, ...]:
    """Return the descriptions of the objects that a move goes to or points at."""
    targets = (move.target, move.heading.target if move.heading else None)
    return tuple(target.description for target in targets if target and target.description is not None)


def look_of(heading: Heading, context: RobotContext, more: tuple[tuple[str, object], ...] = ()) -> Call:
    """Return how a robot turns until a device points at something; `more` goes to the ``Look`` beside it."""
    named: list[tuple[str, object]] = []
    if heading.angle_degrees:
        named.append(("angle", metres(heading.angle_degrees)))
    if "mount.yaw" in properties_of(heading, context):
        named.append(("mount", mount_of(heading, context)))
    return Call("Look", (_target(heading.target, context),), (*named, *more))


def unturnable(heading: Heading, context: RobotContext) -> Iterator[str]:
    """Yield why a robot cannot turn as a heading says."""
    if finite(properties_of(heading, context).get("mount.yaw", "0")) is None:
        yield f"device '{heading.device}': mount.yaw is not a number"


def mount_of(heading: Heading, context: RobotContext) -> float:
    """Return where the device of a heading points when the robot looks north, degrees clockwise.

    It is 0 where the property holds no number, which is refused.
    """
    return finite(properties_of(heading, context).get("mount.yaw", "0")) or 0.0


def properties_of(heading: Heading, context: RobotContext) -> Mapping[str, str]:
    """Return the properties of the device that a heading is of; none for the front of the robot."""
    device = context.type.devices.get(heading.device) if context.type else None
    return device.properties if device else {}


def number_of(move: Move, feature: str) -> float:
    """Return a number that a move's feature holds; 0 where it holds none."""
    value = move.attributes.get(feature)
    return float(value) if isinstance(value, int | float) else 0.0


def go_to(move: Move, context: RobotContext, driver: Driver, legs: str = "direct") -> Call:
    """Return the movement to a place or an object.

    Args:
        move: that becomes it.
        context: of the robot.
        driver: of the vehicle.
        legs: of the path, as in the runtime's ``GoTo``: ``direct``, ``level first`` or ``climb first``.
    """
    if move.target is None:
        return Call("Skip", ("it has no target",))
    named: list[tuple[str, object]] = [("speed", context.speed(move))]
    if legs != "direct":
        named.append(("legs", legs))
    if move.distance:
        named.append(("distance", metres(move.distance)))
    look = driver.look(move.heading, context) if move.heading is not None else None
    if look is not None:
        named.append(("look", look))
    return Call("GoTo", (_target(move.target, context),), tuple(named))


def _start(move: Move, context: RobotContext, driver: Driver) -> Call:
    return Call("Start")


def _stop(move: Move, context: RobotContext, driver: Driver) -> Call:
    return Call("Stop")


def _hold(move: Move, context: RobotContext, driver: Driver) -> Call:
    return Call("Hold", (number_of(move, "duration"),))


def _recharge(move: Move, context: RobotContext, driver: Driver) -> Call:
    return Call("Recharge", (number_of(move, "duration"),))


def _turn(move: Move, context: RobotContext, driver: Driver) -> Call:
    if move.heading is None:
        return Call("Skip", ("it has no heading",))
    look = driver.look(move.heading, context)
    return Call("Turn", (look,)) if look else Call("Skip", tuple(driver.unseen(move.heading, context))[:1])


def _target(target: MoveTarget, context: RobotContext) -> Call:
    place = None if target.position is None else place_of(target.position, context)
    if target.description is None:
        if place is None:
            raise ValueError("a coordinate has no position")
        return place
    return Call("Object", (target.description, place, target.tolerance))


MOVEMENTS: Mapping[Name, Movement] = {
    (BEHAVIOUR, "Start"): _start,
    (BEHAVIOUR, "Stop"): _stop,
    (BEHAVIOUR, "GoTo"): go_to,
    (BEHAVIOUR, "HoldPosition"): _hold,
    (BEHAVIOUR, "Recharge"): _recharge,
    (BEHAVIOUR, "HeadTo"): _turn,
}
"""Movements of the core's moves."""
