"""Wirings of cameras, servos, relays, grippers, winches and gimbals: by properties that the docs describe."""

from __future__ import annotations

import re
from collections.abc import Mapping

from mmrs_core.behaviour.program import Action
from mmrs_core.scene import DISTANCE, Device
from mmrs_mavlink.wiring import DeviceWiring, Sampled, Unwired, Wired, Wiring, Wirings

IMAGE_START_CAPTURE, DIGICAM_CONTROL = 2000, 203
SET_SERVO, SET_RELAY, REPEAT_RELAY, GRIPPER = 183, 181, 182, 211
VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE = 2500, 2501
TRIGGER_DISTANCE, WINCH, GIMBAL_PITCH_YAW = 206, 42600, 1000
RELAXED, BY_LENGTH, BY_RATE = 0.0, 1.0, 2.0
YAW_LOCK = 16.0
STARTING = frozenset({"start", "startvideo", "startrecording", "on"})
STOPPING = frozenset({"stop", "stopvideo", "stoprecording", "off"})
LONGEST_VALUE_NAME = 10


def is_value_name(name: str) -> bool:
    """Return whether a vehicle can publish a value under a name: one to ten ASCII characters."""
    return name.isascii() and name.isprintable() and 0 < len(name) <= LONGEST_VALUE_NAME


def _number_in(device: Device, key: str) -> float | None:
    """Return the whole number that a property holds; None if it holds none."""
    try:
        return float(int(device.properties[key]))
    except (KeyError, ValueError):
        return None


def _no_number(device: Device, key: str) -> Unwired:
    return Unwired(f"device {device.id!r}: {key} is not a whole number")


def _setting(action: Action, device: Device, key: str, parameter: str) -> str:
    """Return what an action sets: by its parameter, the property ``<key>.<action>``, or its own name."""
    default = device.properties.get(f"{key}.{action.name}", action.name)
    return dict(action.parameters).get(parameter, default)


def _explicit(action: Action, device: Device) -> Wiring | None:
    key = f"mavlink.command.{action.name}"
    if key not in device.properties:
        return None
    numbers = re.split(r"[\s,]+", device.properties[key].strip())
    try:
        return Wired(int(numbers[0]), tuple(float(each) for each in numbers[1:]))
    except ValueError:
        return Unwired(f"device {device.id!r}: {key} is not a command number with its parameters")


def _sampled(action: Action, device: Device) -> Wiring | None:
    name = device.properties.get("mavlink.value", "")
    if not is_value_name(name):
        return Unwired(f"device {device.id!r}: mavlink.value is not one to ten ASCII characters")
    return Sampled(name)


def _camera(action: Action, device: Device) -> Wiring | None:
    if (number := _number_in(device, "mavlink.camera")) is None:
        return _no_number(device, "mavlink.camera")
    confirmed = device.properties.get("mavlink.camera.confirms", "no") == "yes"
    if (word := dict(action.parameters).get(DISTANCE)) is not None:
        metres = _number(word)
        if metres is None or not metres >= 0.0:
            return Unwired(f"device {device.id!r}: {action.name!r} is given a distance of {word!r}")
        return Wired(TRIGGER_DISTANCE, (metres, 0.0, 1.0), confirmed=confirmed)
    if device.properties.get("mavlink.camera.command", "image") == "digicam":
        return Wired(DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0), confirmed=confirmed)
    return Wired(IMAGE_START_CAPTURE, (number, 0.0, 1.0), confirmed=confirmed)


def _servo(action: Action, device: Device) -> Wiring | None:
    return _switched(action, device, "mavlink.servo", SET_SERVO, "pwm", {})


def _relay(action: Action, device: Device) -> Wiring | None:
    key, words = "mavlink.relay", {"on": 1.0, "off": 0.0}
    found = _switched(action, device, key, SET_RELAY, "state", words)
    number = _number_in(device, key)
    if isinstance(found, Wired) or number is None or _setting(action, device, key, "state") != action.name:
        return found
    known = device.actions.get(action.name)
    return Wired(REPEAT_RELAY, (number, 1.0, 2.0 * (known.duration if known else 0.0)))


def _gripper(action: Action, device: Device) -> Wiring | None:
    return _switched(action, device, "mavlink.gripper", GRIPPER, "state", {"grab": 1.0, "release": 0.0})


def _switched(
    action: Action, device: Device, key: str, command: int, parameter: str, words: Mapping[str, float]
) -> Wired | Unwired:
    if (number := _number_in(device, key)) is None:
        return _no_number(device, key)
    given = _setting(action, device, key, parameter)
    try:
        return Wired(command, (number, words[given] if given in words else float(given)))
    except ValueError:
        return Unwired(
            f"device {device.id!r}: neither parameter {parameter} nor property {key}.{action.name} names"
            f" what {action.name!r} sets"
        )


def _video(action: Action, device: Device) -> Wiring:
    key = "mavlink.video"
    if (stream := _number_in(device, key)) is None:
        return _no_number(device, key)
    word = _setting(action, device, key, "state").lower()
    if word in STARTING:
        return Wired(VIDEO_START_CAPTURE, (stream, 0.0))
    if word in STOPPING:
        return Wired(VIDEO_STOP_CAPTURE, (stream,))
    return _unknown(action, device, key, "start or stop")


def _trigger(action: Action, device: Device) -> Wiring:
    key = "mavlink.trigger"
    word = _setting(action, device, key, "distance")
    if word.lower() in STOPPING:
        return Wired(TRIGGER_DISTANCE, (0.0, 0.0, 0.0))
    if word.lower() in STARTING:
        word = device.properties[key]
    metres = _number(word)
    if metres is None or metres <= 0.0:
        return _unknown(action, device, key, "metres above 0, start or stop")
    return Wired(TRIGGER_DISTANCE, (metres, 0.0, 1.0))


def _winch(action: Action, device: Device) -> Wiring:
    key = "mavlink.winch"
    if (number := _number_in(device, key)) is None:
        return _no_number(device, key)
    given = dict(action.parameters)
    words = device.properties.get(f"{key}.{action.name}", action.name).split()
    if "length" in given or "rate" in given:
        words = [f"{name}" for pair in given.items() if pair[0] in ("length", "rate") for name in pair]
    named = dict(zip(words[::2], map(_number, words[1::2]), strict=False))
    if words == ["relax"]:
        return Wired(WINCH, (number, RELAXED))
    length, rate = named.get("length"), named.get("rate")
    if len(words) % 2 or None in named.values() or not named or set(named) - {"length", "rate"}:
        return _unknown(action, device, key, "relax, 'length METRES', 'rate METRES-PER-SECOND', or both")
    if length is not None:
        return Wired(WINCH, (number, BY_LENGTH, length, rate or 0.0))
    return Wired(WINCH, (number, BY_RATE, 0.0, rate or 0.0))


def _gimbal(action: Action, device: Device) -> Wiring | None:
    """Return how a gimbal is pointed: to a pitch (up is positive) and a yaw in degrees.

    The yaw counts from the robot's front, or with the word ``north`` from there.
    """
    key = "mavlink.gimbal"
    given = dict(action.parameters)
    text = device.properties.get(f"{key}.{action.name}", "")
    if not text and not {"pitch", "yaw"} & set(given):
        return None
    if (number := _number_in(device, key)) is None:
        return _no_number(device, key)
    words = text.split()
    lock = YAW_LOCK if words[2:] == ["north"] else 0.0
    angles = [_number(given.get(*each)) for each in zip(("pitch", "yaw"), [*words, "0", "0"], strict=False)]
    if None in angles or words[2:] not in ([], ["north"]):
        return _unknown(action, device, key, "'PITCH YAW' in degrees, or 'PITCH YAW north'")
    pitch, yaw = (angle or 0.0 for angle in angles)
    return Wired(GIMBAL_PITCH_YAW, (pitch, yaw, 0.0, 0.0, lock, 0.0, number))


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None


def _unknown(action: Action, device: Device, key: str, expected: str) -> Unwired:
    return Unwired(f"device {device.id!r}: {key}.{action.name}: expected {expected}")


_BUILT_IN = (
    DeviceWiring("mavlink.command", "the command that mavlink.command.ACTION holds", _explicit),
    DeviceWiring("mavlink.value", "records the next value that the vehicle publishes by name", _sampled),
    DeviceWiring("mavlink.camera", "takes one image, or one whenever a distance has been gone", _camera),
    DeviceWiring("mavlink.servo", "sets a servo output", _servo),
    DeviceWiring("mavlink.relay", "switches a relay", _relay),
    DeviceWiring("mavlink.gripper", "moves a gripper", _gripper),
    DeviceWiring("mavlink.video", "begins or ends a video", _video),
    DeviceWiring("mavlink.trigger", "triggers a camera at a distance", _trigger),
    DeviceWiring("mavlink.winch", "lets out or winds up a line", _winch),
    DeviceWiring("mavlink.gimbal", "points a gimbal", _gimbal),
)
WIRINGS: Wirings = {wiring.property: wiring for wiring in _BUILT_IN}
"""Those of this plug-in, by their property."""
