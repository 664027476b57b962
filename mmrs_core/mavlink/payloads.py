"""Wirings of devices with more than one sort of action: video, triggers by distance, winches, gimbals."""

from __future__ import annotations

from mmrs_core.behaviour.program import Action
from mmrs_core.contributions.wiring import Unwired, Wired, Wiring
from mmrs_core.mavlink.words import number_in, said, unsaid
from mmrs_core.scene import Device

VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE = 2500, 2501
TRIGGER_DISTANCE, WINCH, GIMBAL_PITCH_YAW = 206, 42600, 1000
RELAXED, BY_LENGTH, BY_RATE = 0.0, 1.0, 2.0
YAW_LOCK = 16.0
STARTING = frozenset({"start", "startvideo", "startrecording", "on"})
STOPPING = frozenset({"stop", "stopvideo", "stoprecording", "off"})


def video(action: Action, device: Device) -> Wiring:
    """Return how a video is begun or ended."""
    key = "mavlink.video"
    if (stream := number_in(device, key)) is None:
        return unsaid(device, key)
    word = said(action, device, key, "state").lower()
    if word in STARTING:
        return Wired(VIDEO_START_CAPTURE, (stream, 0.0))
    if word in STOPPING:
        return Wired(VIDEO_STOP_CAPTURE, (stream,))
    return _unknown(action, device, key, "start or stop")


def trigger(action: Action, device: Device) -> Wiring:
    """Return how a camera is triggered every so many metres, or no longer."""
    key = "mavlink.trigger"
    word = said(action, device, key, "distance")
    if word.lower() in STOPPING:
        return Wired(TRIGGER_DISTANCE, (0.0, 0.0, 0.0))
    if word.lower() in STARTING:
        word = device.properties[key]
    metres = _number(word)
    if metres is None or metres <= 0.0:
        return _unknown(action, device, key, "metres above 0, start or stop")
    return Wired(TRIGGER_DISTANCE, (metres, 0.0, 1.0))


def winch(action: Action, device: Device) -> Wiring:
    """Return how a winch lets out or winds up some line, turns at a rate, or relaxes."""
    key = "mavlink.winch"
    if (number := number_in(device, key)) is None:
        return unsaid(device, key)
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


def gimbal(action: Action, device: Device) -> Wiring | None:
    """Return how a gimbal is pointed: to a pitch (up is positive) and a yaw in degrees.

    The yaw counts from the robot's front, or with the word ``north`` from there.
    """
    key = "mavlink.gimbal"
    given = dict(action.parameters)
    text = device.properties.get(f"{key}.{action.name}", "")
    if not text and not {"pitch", "yaw"} & set(given):
        return None
    if (number := number_in(device, key)) is None:
        return unsaid(device, key)
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
