"""How device actions become MAVLink commands: by the properties of the device, described in the docs."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite

from mmrs_core.behaviour.program import Action
from mmrs_core.scene import Device, RobotType

IMAGE_START_CAPTURE, DIGICAM_CONTROL, SET_SERVO, SET_RELAY, GRIPPER = 2000, 203, 183, 181, 211
REPEAT_RELAY = 182
LONGEST_VALUE_NAME = 10


@dataclass(frozen=True, slots=True)
class Wired:
    """A MAVLink command with its parameters, at most seven, and the seconds that it takes."""

    command: int
    params: tuple[float, ...]
    seconds: float


@dataclass(frozen=True, slots=True)
class Sampled:
    """A value that the vehicle publishes by name, and the seconds that measuring takes."""

    value: str
    seconds: float


@dataclass(frozen=True, slots=True)
class Unwired:
    """Why there is no way to have a device do something."""

    reason: str


def wiring_of(action: Action, type: RobotType | None) -> Wired | Sampled | Unwired:
    """Return how a device action of a robot of that type is carried out."""
    if type is None:
        return Unwired("the robot's type is not given")
    device = type.devices.get(action.device)
    if device is None:
        return Unwired(f"type {type.name!r} has no device {action.device!r}")
    known = device.actions.get(action.name)
    seconds = known.duration if known else 0.0
    if f"mavlink.command.{action.name}" in device.properties:
        return _explicit(device, action, seconds)
    if "mavlink.value" in device.properties:
        return _sampled(device, seconds)
    for key, wire in _WIRES.items():
        if key in device.properties:
            return wire(device, action, seconds)
    return Unwired(f"device {device.id!r} has no property that says how it is wired, such as mavlink.camera")


def _explicit(device: Device, action: Action, seconds: float) -> Wired | Unwired:
    key = f"mavlink.command.{action.name}"
    numbers = re.split(r"[\s,]+", device.properties[key].strip())
    try:
        command, params = int(numbers[0]), tuple(float(each) for each in numbers[1:])
    except ValueError:
        return Unwired(f"device {device.id!r}: {key} is no command number with its parameters")
    if not all(map(isfinite, params)):
        return Unwired(f"device {device.id!r}: {key} holds a parameter that is not finite")
    if len(params) > 7:
        return Unwired(f"device {device.id!r}: {key} has more than seven parameters")
    return Wired(command, params, seconds)


def _sampled(device: Device, seconds: float) -> Sampled | Unwired:
    name = device.properties["mavlink.value"]
    if not (name.isascii() and name.isprintable() and 0 < len(name) <= LONGEST_VALUE_NAME):
        return Unwired(f"device {device.id!r}: mavlink.value is not one to ten ASCII characters")
    return Sampled(name, seconds)


def _camera(device: Device, action: Action, seconds: float) -> Wired | Unwired:
    number = _number(device, "mavlink.camera")
    if isinstance(number, Unwired):
        return number
    if device.properties.get("mavlink.camera.command", "image") == "digicam":
        return Wired(DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0), seconds)
    return Wired(IMAGE_START_CAPTURE, (number, 0.0, 1.0), seconds)


def _servo(device: Device, action: Action, seconds: float) -> Wired | Unwired:
    return _switched(device, action, seconds, "mavlink.servo", SET_SERVO, "pwm", {})


def _relay(device: Device, action: Action, seconds: float) -> Wired | Unwired:
    words = {"on": 1.0, "off": 0.0}
    found = _switched(device, action, seconds, "mavlink.relay", SET_RELAY, "state", words)
    number = _number(device, "mavlink.relay")
    if isinstance(found, Wired) or isinstance(number, Unwired) or _says_what(device, action, "mavlink.relay"):
        return found
    return Wired(REPEAT_RELAY, (number, 1.0, 2.0 * seconds), seconds)


def _says_what(device: Device, action: Action, key: str) -> bool:
    return "state" in dict(action.parameters) or f"{key}.{action.name}" in device.properties


def _gripper(device: Device, action: Action, seconds: float) -> Wired | Unwired:
    words = {"grab": 1.0, "release": 0.0}
    return _switched(device, action, seconds, "mavlink.gripper", GRIPPER, "state", words)


def _switched(
    device: Device,
    action: Action,
    seconds: float,
    key: str,
    command: int,
    parameter: str,
    words: Mapping[str, float],
) -> Wired | Unwired:
    number = _number(device, key)
    if isinstance(number, Unwired):
        return number
    given = dict(action.parameters).get(parameter, device.properties.get(f"{key}.{action.name}", action.name))
    value = words.get(given)
    if value is None:
        try:
            value = float(given)
        except ValueError:
            return Unwired(
                f"device {device.id!r}: neither parameter {parameter} nor property {key}.{action.name} says"
                f" what {action.name!r} sets"
            )
    return Wired(command, (number, value), seconds)


def _number(device: Device, key: str) -> float | Unwired:
    try:
        return float(int(device.properties[key]))
    except ValueError:
        return Unwired(f"device {device.id!r}: {key} is no whole number")


_WIRES: Mapping[str, Callable[[Device, Action, float], Wired | Unwired]] = {
    "mavlink.camera": _camera,
    "mavlink.servo": _servo,
    "mavlink.relay": _relay,
    "mavlink.gripper": _gripper,
}
