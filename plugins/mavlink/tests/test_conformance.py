"""The laws that every plug-in must keep."""

from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input

from mmrs_core.scene import Device, DeviceAction
from mmrs_core.testing.conformance import TargetConformance, VehicleConformance
from mmrs_core.testing.programs import program
from mmrs_mavlink import plugin
from mmrs_mavlink.plugin.testing import DeviceWiringConformance

FLIGHT = [take_off("up", 20.0), go_to("out", (0.0, 30.0, 20.0)), LAND]
ONE_DRONE = target_input(program(robot_program("alpha", FLIGHT)))


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"qgc-plan": ONE_DRONE, "wpl": ONE_DRONE}


class TestVehicles(VehicleConformance):
    plugin = plugin


def device(action: str, **properties: str) -> tuple[Device, str]:
    """Return a device with these properties, a ``__`` for each dot, and the action that it can do."""
    named = {name.replace("__", "."): value for name, value in properties.items()}
    return Device("device", {action: DeviceAction(action, 2.0)}, named), action


class TestDeviceWirings(DeviceWiringConformance):
    plugin = plugin
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
