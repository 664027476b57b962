"""Whether robots carry, have and can do what their behaviour asks for."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.figures import capability_of, type_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged, not_checked, safe, violated
from mmrs_core.behaviour.program import DEVICE_ACTION, Action, RobotProgram
from mmrs_core.behaviour.walk import reachable_moves
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene import RobotType

PAYLOAD_NAME = "payload"
SPEED_NAME = "speed"
DEVICES_NAME = "devices"


def _judge_payload(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    allowed = type_of(input, robot).max_payload or 0.0
    words = f"it carries {robot.payload:g} kg, its type allows {allowed:g} kg"
    yield from judged(PAYLOAD_NAME, robot, "kg", [Margin(allowed - robot.payload, None, words)])


def _judge_speed(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    slowest, fastest = capability_of(input, robot).speed
    margins = []
    for index in sorted(reachable_moves(robot)):
        move = robot.moves[index]
        if move.speed is not None:
            words = (
                f"{move.kind} '{move.id}' is commanded at {move.speed:g} m/s,"
                f" the robot moves at {slowest:g} to {fastest:g} m/s"
            )
            margins.append(Margin(min(move.speed - slowest, fastest - move.speed), index, words))
    if margins:
        yield from judged(SPEED_NAME, robot, "m/s", margins)
    else:
        yield not_checked(SPEED_NAME, robot, "no move commands a speed: all follow the travel mode")


def _judge_devices(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    robot_type = type_of(input, robot)
    faults = [
        (fault, index)
        for index in sorted(reachable_moves(robot))
        for fault in _lacks(robot, index, robot_type)
    ]
    for fault, index in faults:
        yield violated(DEVICES_NAME, robot, fault, index)
    if not faults:
        yield safe(DEVICES_NAME, robot, "its type has every device, action and parameter that is used")


def _lacks(robot: RobotProgram, index: int, robot_type: RobotType) -> Iterator[str]:
    move = robot.moves[index]
    for action in (*move.before, *move.after):
        if action.is_a(DEVICE_ACTION):
            yield from (f"{move.kind} '{move.id}': {fault}" for fault in _unsupported(action, robot_type))
    pointing = move.heading.device if move.heading else ""
    if pointing and pointing not in robot_type.devices:
        yield f"{move.kind} '{move.id}' points device '{pointing}', which '{robot_type.name}' does not have"


def _unsupported(action: Action, robot_type: RobotType) -> Iterator[str]:
    device = robot_type.devices.get(action.device)
    if device is None:
        yield f"'{robot_type.name}' has no device '{action.device}'"
        return
    supported = device.actions.get(action.name)
    if supported is None:
        yield f"device '{action.device}' does not support action '{action.name}'"
        return
    for key, _ in action.parameters:
        if key not in supported.parameters:
            yield f"action '{action.name}' of device '{action.device}' has no parameter '{key}'"


PAYLOAD = Check(
    name=PAYLOAD_NAME,
    title="No robot carries more than its type allows.",
    run=for_each_robot(PAYLOAD_NAME, _judge_payload),
    hint="take weight off the robot, or choose a type that carries more",
)
SPEED = Check(
    name=SPEED_NAME,
    title="Commanded speeds are within what the robot can do with its payload.",
    run=for_each_robot(SPEED_NAME, _judge_speed),
    hint="ask for a lower speed, or leave it out to go by the travel mode",
)
DEVICES = Check(
    name=DEVICES_NAME,
    title="The robot's type has every device, action and parameter that its moves use.",
    run=for_each_robot(DEVICES_NAME, _judge_devices),
    hint="correct the device, action or parameter, or add it to the robot type",
)
