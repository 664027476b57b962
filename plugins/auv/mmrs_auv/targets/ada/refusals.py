"""What the decision centre in Ada cannot do."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.backend.duties_of import parameter_of
from mmrs_auv.sheets import action_number
from mmrs_auv.targets.ada.bus import can_be_said
from mmrs_auv.targets.moves import MOVES, above_surface
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.mavlink.context import RobotContext, context_of
from mmrs_core.scene import Policy

DEVICE_ACTION, FEEDBACK, NOTIFY = ((BEHAVIOUR, name) for name in ("DeviceAction", "Feedback", "Notify"))

LASTING = frozenset(
    {"BATTERY_LOW", "POSITION_LOST", "LINK_LOST", "DEVICE_SILENT", "PEER_LOST", "WAIT_TOO_LONG"}
)
"""Events that may have to last before the vehicle comes up."""

OF_A_WAIT = frozenset({"PEER_LOST", "WAIT_TOO_LONG"})
"""Events about which a single wait may say something else."""


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that the decision centre cannot do, with robot and move."""
    for robot in input.program.robots:
        context = context_of(robot, input, geographic=False)
        if not context.vehicle.dives:
            yield f"robot '{robot.id}': is no underwater vehicle, and has no bus of one"
            continue
        of_type = context.type.policies if context.type is not None else ()
        declared = {each.event: each for each in (*of_type[::-1], *robot.policies[::-1])}
        yield from (
            f"robot '{robot.id}': {_described(each)}" for each in declared.values() if not _is_kept(each)
        )
        for index, move in enumerate(robot.moves):
            for why in _of_move(move, context):
                yield f"{context.label(move)}: {why}"
            transition = robot.transitions.get(index)
            for policy in transition.policies if transition is not None else ():
                if policy.event not in OF_A_WAIT or not _is_kept(policy):
                    yield f"{context.label(move)}: {_described(policy)}"


def _of_move(move: Move, context: RobotContext) -> Iterator[str]:
    sort = MOVES.get(move.metaclasses[0])
    if sort is None:
        yield f"{move.kind} is not known to this target"
    if sort == "go":
        yield from _of_way(move, context)
    if sort == "turn" and (move.heading is None or move.heading.target.position is None):
        yield "nobody says where what it turns to is"
    if move.heading is not None and _turns_aside(move.heading.device, context):
        yield f"device '{move.heading.device}' does not look ahead, where only the front can point somewhere"
    if sort != "go" and sort != "turn" and move.heading is not None:
        yield f"heading of a {move.kind}"
    for action in (*move.before, *move.after):
        yield from _of_action(action, context)


def _turns_aside(device: str, context: RobotContext) -> bool:
    known = context.type.devices.get(device) if context.type is not None else None
    return known is not None and ("mount.yaw" in known.properties or "mavlink.gimbal" in known.properties)


def _of_way(move: Move, context: RobotContext) -> Iterator[str]:
    target = move.target
    if target is None or target.position is None:
        yield "nobody says where its target is"
        return
    east, north, _ = target.position
    for name, metres in (("North", north), ("East", east)):
        if not can_be_said("GoalPlace", name, metres):
            yield f"leads {metres:g} m to the {name.lower()}, farther than its bus can say"
    if above_surface(target.position, context) > 1e-6:
        yield f"leads {above_surface(target.position, context):g} m above the surface"
    if move.heading is not None and move.heading.target.position is None:
        yield "nobody says where what it faces is"
    if context.speed(move) is None:
        yield "its speed is not known, because its robot type is not given"


def _of_action(action: Action, context: RobotContext) -> Iterator[str]:
    if action.is_a(NOTIFY):
        return
    if action.is_a(DEVICE_ACTION):
        known = context.type is not None and action_number(context.type, action.device, action.name)
        if known is None or known is False:
            yield f"device '{action.device}' has no action '{action.name}'"
        number = parameter_of(action)
        if not can_be_said("DeviceCommand", "Parameter", number):
            yield f"parameter {number:g} of device '{action.device}' is more than its bus can say"
    elif not action.is_a(FEEDBACK):
        yield f"action {action.metaclasses[0][1]} is not known to this target"


def _is_kept(policy: Policy) -> bool:
    """Return whether a policy says what happens anyway; that a vehicle goes on without radio is no news."""
    if policy.response == "CONTINUE":
        return policy.event in ("LINK_LOST", "GROUND_LOST")
    return policy.event in LASTING and policy.response in ("SURFACE", "LAND")


def _described(policy: Policy) -> str:
    after = "" if policy.after is None else f" after {policy.after:g} s"
    return f"policy {policy.event}{after}: {policy.response}, where this decision centre always comes up"
