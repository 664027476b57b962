"""The core's own contributions keep the laws that plug-ins must keep."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core import builtin
from mmrs_core.behaviour.program import Heading, MoveTarget
from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.conformance import (
    DeviceWiringConformance,
    MoveKindConformance,
    RobotKindConformance,
    VehicleConformance,
)
from mmrs_core.testing.programs import (
    move,
)
from mmrs_core.testing.scenes import sample_robot

PLACE = MoveTarget((70.0, -40.0, 25.0))


MOVES = {
    "Start": move("start", "Start"),
    "Stop": move("stop", "Stop"),
    "HoldPosition": move("hold", "HoldPosition", duration=12.0),
    "Recharge": move("recharge", "Recharge", duration=600.0),
    "HeadTo": replace(move("head", "HeadTo"), heading=Heading(PLACE)),
    "GoTo": replace(move("go", "GoTo"), target=PLACE, distance=3.0, speed=4.0),
}


class TestRobotKinds(RobotKindConformance):
    plugin = builtin
    robots = {"plain_robot": sample_robot(kinematics=None)}


class TestMoveKinds(MoveKindConformance):
    plugin = builtin
    moves = MOVES


def device(action: str, **properties: str) -> tuple[Device, str]:
    """Return a device with these properties, a ``__`` for each dot, and the action that it can do."""
    named = {name.replace("__", "."): value for name, value in properties.items()}
    return Device("device", {action: DeviceAction(action, 2.0)}, named), action


class TestDeviceWirings(DeviceWiringConformance):
    plugin = builtin
    devices = {
        "mavlink.command": device("act", mavlink__command__act="183 9 1900"),
        "mavlink.value": device("sample", mavlink__value="CO2"),
        "mavlink.camera": device("takePhoto", mavlink__camera="0"),
        "mavlink.servo": device("open", mavlink__servo="9", mavlink__servo__open="1900"),
        "mavlink.relay": device("on", mavlink__relay="0"),
        "mavlink.gripper": device("grab", mavlink__gripper="1"),
        "mavlink.video": device("startVideo", mavlink__video="0"),
        "mavlink.trigger": device("start", mavlink__trigger="5"),
        "mavlink.winch": device("relax", mavlink__winch="1"),
        "mavlink.gimbal": device("lookDown", mavlink__gimbal="1", mavlink__gimbal__lookDown="-90 0"),
    }


class TestVehicles(VehicleConformance):
    plugin = builtin
