"""How device actions become MAVLink commands: by the properties of the device, described in the docs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf

from mmrs_core.behaviour.program import Action
from mmrs_core.contributions.wiring import DeviceWiring, Sampled, Unwired, Wired, Wiring, Wirings
from mmrs_core.errors import PluginError
from mmrs_core.mavlink import payloads
from mmrs_core.mavlink.words import number_in, said, unsaid
from mmrs_core.scene import Device, RobotType

__all__ = ["Sampled", "Unwired", "Wired", "wiring_of"]

IMAGE_START_CAPTURE, DIGICAM_CONTROL, SET_SERVO, SET_RELAY, GRIPPER = 2000, 203, 183, 181, 211
REPEAT_RELAY = 182
LAST_COMMAND = 65_535
LARGEST = 3.4028234e38
"""Commands are 16 bits wide, parameters are numbers of single precision."""

LONGEST_VALUE_NAME = 10
MOST_PARAMETERS = 7


def wiring_of(action: Action, type: RobotType | None, wirings: Wirings | None = None) -> Wiring:
    """Return how a device action of a robot of that type is carried out.

    Args:
        action: of a device.
        type: None where it was not given.
        wirings: those of plug-ins, beside the core's own.

    Raises:
        PluginError: a plug-in's wiring returns something else.
    """
    if type is None:
        return Unwired("the robot's type is not given")
    device = type.devices.get(action.device)
    if device is None:
        return Unwired(f"type {type.name!r} has no device {action.device!r}")
    return _finished(_chosen(action, device, {**WIRINGS, **(wirings or {})}), action, device)


def _chosen(action: Action, device: Device, wirings: Wirings) -> Wiring:
    """Return the only wiring that fits: one for this action alone goes before one for the device."""
    present = [each for name, each in sorted(wirings.items()) if name in device.properties]
    special = [each for name, each in sorted(wirings.items()) if f"{name}.{action.name}" in device.properties]
    for some in (special, present):
        found = [(each, wiring) for each in some if (wiring := _wired(each, action, device)) is not None]
        if len(found) > 1:
            names = " and ".join(each.property for each, _ in found)
            return Unwired(f"device {device.id!r}: {action.name!r} is wired by {names}, which is ambiguous")
        if found:
            return found[0][1]
    if present:
        names = " and ".join(each.property for each in present)
        return Unwired(f"device {device.id!r}: {names} does not say what {action.name!r} is")
    return Unwired(f"device {device.id!r} has no property that says how it is wired, such as mavlink.camera")


def _wired(each: DeviceWiring, action: Action, device: Device) -> Wiring | None:
    found: object = each.wire(action, device)
    if found is None or _is_wiring(found):
        return found  # type: ignore[return-value]
    source = getattr(each.wire, "label", f"wiring '{each.property}'")
    raise PluginError(f"{source}: returns {found!r} for action '{action.name}', which is no wiring")


def _is_wiring(found: object) -> bool:
    """Return whether something is a wiring, with values of the types that it promises."""
    if isinstance(found, Unwired):
        return isinstance(found.reason, str)
    if not (isinstance(found, Wired | Sampled) and (found.seconds is None or _is_number(found.seconds))):
        return False
    if isinstance(found, Sampled):
        return isinstance(found.value, str)
    pairs = [(found.command, found.params)]
    try:
        pairs += [(command, params) for command, params in found.more]
        return all(type(command) is int and all(map(_is_number, params)) for command, params in pairs)
    except (TypeError, ValueError):
        return False


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _finished(wiring: Wiring, action: Action, device: Device) -> Wiring:
    """Return a wiring with its seconds, if its numbers are such as vehicles take."""
    if isinstance(wiring, Unwired):
        return wiring
    if why := _unfit(wiring):
        return Unwired(f"device {device.id!r}: {action.name!r} {why}")
    if wiring.seconds is not None:
        return wiring
    known = device.actions.get(action.name)
    return replace(wiring, seconds=known.duration if known else 0.0)


def _unfit(wiring: Wired | Sampled) -> str:
    """Return why a wiring cannot be sent to any vehicle; empty where it can."""
    if wiring.seconds is not None and not 0.0 <= wiring.seconds < inf:
        return f"takes {wiring.seconds:g} s, which is no time"
    if isinstance(wiring, Sampled) and not _is_value_name(wiring.value):
        return f"reads {wiring.value!r}, and names of values are one to ten ASCII characters"
    for command, params in _commands(wiring):
        if not 0 <= command <= LAST_COMMAND:
            return f"is command {command}, and MAVLink's are 0 to {LAST_COMMAND}"
        if len(params) > MOST_PARAMETERS:
            return "has more than seven parameters"
        if not all(abs(param) <= LARGEST for param in params):
            return "has a parameter that is no number of single precision"
    return ""


def _is_value_name(name: str) -> bool:
    return name.isascii() and name.isprintable() and 0 < len(name) <= LONGEST_VALUE_NAME


def _commands(wiring: Wired | Sampled) -> Iterator[tuple[int, tuple[float, ...]]]:
    if isinstance(wiring, Wired):
        yield wiring.command, wiring.params
        yield from wiring.more


def _explicit(action: Action, device: Device) -> Wiring | None:
    key = f"mavlink.command.{action.name}"
    if key not in device.properties:
        return None
    numbers = re.split(r"[\s,]+", device.properties[key].strip())
    try:
        return Wired(int(numbers[0]), tuple(float(each) for each in numbers[1:]))
    except ValueError:
        return Unwired(f"device {device.id!r}: {key} is no command number with its parameters")


def _sampled(action: Action, device: Device) -> Wiring | None:
    name = device.properties.get("mavlink.value", "")
    if not _is_value_name(name):
        return Unwired(f"device {device.id!r}: mavlink.value is not one to ten ASCII characters")
    return Sampled(name)


def _camera(action: Action, device: Device) -> Wiring | None:
    if (number := number_in(device, "mavlink.camera")) is None:
        return unsaid(device, "mavlink.camera")
    confirmed = device.properties.get("mavlink.camera.confirms", "no") == "yes"
    if device.properties.get("mavlink.camera.command", "image") == "digicam":
        return Wired(DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0), confirmed=confirmed)
    return Wired(IMAGE_START_CAPTURE, (number, 0.0, 1.0), confirmed=confirmed)


def _servo(action: Action, device: Device) -> Wiring | None:
    return _switched(action, device, "mavlink.servo", SET_SERVO, "pwm", {})


def _relay(action: Action, device: Device) -> Wiring | None:
    key, words = "mavlink.relay", {"on": 1.0, "off": 0.0}
    found = _switched(action, device, key, SET_RELAY, "state", words)
    number = number_in(device, key)
    if isinstance(found, Wired) or number is None or said(action, device, key, "state") != action.name:
        return found
    known = device.actions.get(action.name)
    return Wired(REPEAT_RELAY, (number, 1.0, 2.0 * (known.duration if known else 0.0)))


def _gripper(action: Action, device: Device) -> Wiring | None:
    return _switched(action, device, "mavlink.gripper", GRIPPER, "state", {"grab": 1.0, "release": 0.0})


def _switched(
    action: Action, device: Device, key: str, command: int, parameter: str, words: Mapping[str, float]
) -> Wired | Unwired:
    if (number := number_in(device, key)) is None:
        return unsaid(device, key)
    given = said(action, device, key, parameter)
    try:
        return Wired(command, (number, words[given] if given in words else float(given)))
    except ValueError:
        return Unwired(
            f"device {device.id!r}: neither parameter {parameter} nor property {key}.{action.name} says"
            f" what {action.name!r} sets"
        )


_CORE = (
    DeviceWiring("mavlink.command", "the command that mavlink.command.ACTION holds", _explicit),
    DeviceWiring("mavlink.value", "records the next value that the vehicle publishes by name", _sampled),
    DeviceWiring("mavlink.camera", "takes one image", _camera),
    DeviceWiring("mavlink.servo", "sets a servo output", _servo),
    DeviceWiring("mavlink.relay", "switches a relay", _relay),
    DeviceWiring("mavlink.gripper", "moves a gripper", _gripper),
    DeviceWiring("mavlink.video", "begins or ends a video", payloads.video),
    DeviceWiring("mavlink.trigger", "triggers a camera every so many metres", payloads.trigger),
    DeviceWiring("mavlink.winch", "lets out or winds up a line", payloads.winch),
    DeviceWiring("mavlink.gimbal", "points a gimbal", payloads.gimbal),
)
WIRINGS: Wirings = {wiring.property: wiring for wiring in _CORE}
"""The core's own, by their property."""
