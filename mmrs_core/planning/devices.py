"""Which device of a robot does the action that a task asks for, and what its properties say."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Device, RobotType


def device_for(robot_type: RobotType, action: str, device_id: str = "") -> Device:
    """Return the device that does an action.

    Args:
        device_id: the device that the task names; empty: the only one that supports the action.

    Raises:
        InfeasibleError: there is no such device, it does not support the action, or several do and
            the task names none.
    """
    if device_id:
        return _named(robot_type, action, device_id)
    able = [device for device in robot_type.devices.values() if action in device.actions]
    if not able:
        raise InfeasibleError(f"has no device for action '{action}'")
    if len(able) > 1:
        names = " and ".join(f"'{device.id}'" for device in able)
        raise InfeasibleError(
            f"devices {names} both support action '{action}', the task's deviceId names none"
        )
    return able[0]


def _named(robot_type: RobotType, action: str, device_id: str) -> Device:
    device = robot_type.devices.get(device_id)
    if device is None:
        raise InfeasibleError(f"has no device '{device_id}'")
    if action not in device.actions:
        raise InfeasibleError(f"device '{device_id}' does not support action '{action}'")
    return device


def carried(robot_type: RobotType, device_id: str) -> str:
    """Return the identifier of a device that a task names; empty stays empty.

    Raises:
        InfeasibleError: the robot does not carry it.
    """
    if device_id and device_id not in robot_type.devices:
        raise InfeasibleError(f"has no device '{device_id}'")
    return device_id


def figure(properties: Mapping[str, str], key: str) -> float | None:
    """Return the number above zero that a property holds; None where there is none."""
    try:
        found = float(properties[key])
    except (KeyError, ValueError):
        return None
    return found if 0.0 < found < float("inf") else None
