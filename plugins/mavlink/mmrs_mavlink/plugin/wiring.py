"""How device actions become MAVLink commands: by the properties of the device, described in the docs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import inf

from mmrs_core.behaviour.program import Action
from mmrs_core.errors import PluginError
from mmrs_core.scene import Device, RobotType
from mmrs_mavlink.plugin.devices import (
    DIGICAM_CONTROL,
    IMAGE_START_CAPTURE,
    TRIGGER_DISTANCE,
    WIRINGS,
    is_value_name,
)
from mmrs_mavlink.wiring import DeviceWiring, Sampled, Unwired, Wired, Wiring, Wirings

LAST_COMMAND = 65_535
LARGEST = 3.4028234e38
"""Commands are 16 bits wide, parameters are numbers of single precision."""

MOST_PARAMETERS = 7

TRIAL = "mavlink.trial"
"""The property of a device that names its actions, between spaces, that may be tried on the ground."""


def wiring_of(action: Action, type: RobotType | None, wirings: Wirings | None = None) -> Wiring:
    """Return how a device action of a robot of that type is carried out.

    Args:
        action: of a device.
        type: None where it was not given.
        wirings: those of plug-ins, beside those of this plug-in.

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
        return Unwired(f"device {device.id!r}: {names} does not define action {action.name!r}")
    return Unwired(f"device {device.id!r} has no wiring property, such as mavlink.camera")


def _wired(each: DeviceWiring, action: Action, device: Device) -> Wiring | None:
    found: object = each.wire(action, device)
    if found is None or _is_wiring(found):
        return found  # type: ignore[return-value]
    source = getattr(each.wire, "label", f"wiring '{each.property}'")
    raise PluginError(f"{source}: returns {found!r} for action '{action.name}', which is not a wiring")


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
    if isinstance(wiring, Wired) and action.name in device.properties.get(TRIAL, "").split():
        wiring = replace(wiring, trial=True)
    if wiring.seconds is not None:
        return wiring
    known = device.actions.get(action.name)
    return replace(wiring, seconds=known.duration if known else 0.0)


def _unfit(wiring: Wired | Sampled) -> str:
    """Return why a wiring cannot be sent to any vehicle; empty where it can."""
    if wiring.seconds is not None and not 0.0 <= wiring.seconds < inf:
        return f"takes {wiring.seconds:g} s, which is not a time"
    if isinstance(wiring, Sampled) and not is_value_name(wiring.value):
        return f"reads {wiring.value!r}, and names of values are one to ten ASCII characters"
    for command, params in _commands(wiring):
        if not 0 <= command <= LAST_COMMAND:
            return f"is command {command}, and MAVLink's are 0 to {LAST_COMMAND}"
        if len(params) > MOST_PARAMETERS:
            return "has more than seven parameters"
        if not all(abs(param) <= LARGEST for param in params):
            return "has a parameter that is not a number of single precision"
    return ""


def _commands(wiring: Wired | Sampled) -> Iterator[tuple[int, tuple[float, ...]]]:
    if isinstance(wiring, Wired):
        yield wiring.command, wiring.params
        yield from wiring.more


def takes_photo(action: Action, type: RobotType) -> bool | None:
    """Return whether a device action takes photos; None where the type does not state how it is wired."""
    wiring = wiring_of(action, type)
    if isinstance(wiring, Unwired):
        return None
    triggered = (TRIGGER_DISTANCE, IMAGE_START_CAPTURE, DIGICAM_CONTROL)
    return isinstance(wiring, Wired) and wiring.command in triggered
