"""Robot types as later stages see them."""

from __future__ import annotations

from math import hypot

from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.features import child, children, number, policies_of, text
from mmrs_core.grounding.frame import fault
from mmrs_core.grounding.parts import NO_GROUND, part_of
from mmrs_core.languages.element import Element, metaclass_of, place_of
from mmrs_core.scene import Battery, Capability, Device, DeviceAction, RobotType

MILLIAMPERE_HOUR = 3.6
"""Coulombs."""
MISSING = "GND002"
"""Code of the faults of elements that lack what later stages cannot do without."""


def robot_type_of(robot: Element) -> RobotType:
    """Return a robot type of the Robot Language.

    Raises:
        InvalidModelError: if its size, its movement capabilities or one of their speeds is missing.
    """
    capabilities = [_capability(each) for each in children(robot, "movementCapabilities")]
    if not capabilities:
        raise _missing(robot, "movementCapabilities")
    first = children(robot, "movementCapabilities")[0]
    return RobotType(
        name=text(robot, "name"),
        metaclasses=metaclass_of(robot).ancestry,
        capability_metaclasses=metaclass_of(first).ancestry,
        half_diagonal=_half_diagonal(robot),
        max_payload=number(robot, "maxPayload"),
        capabilities=tuple(sorted(capabilities, key=lambda each: each.payload)),
        batteries=tuple(_battery(each) for each in children(robot, "batteries")),
        devices={text(each, "id"): _device(each) for each in children(robot, "devices")},
        part=part_of(robot, NO_GROUND),
        policies=policies_of(robot),
    )


def half_diagonal(size: Element) -> float | None:
    """Return half the diagonal of outer dimensions in metres; None where one is missing."""
    sides = [number(size, side) for side in ("width", "length", "height")]
    known = [side for side in sides if side is not None]
    return hypot(*known) / 2 if len(known) == 3 else None


def _half_diagonal(robot: Element) -> float:
    size = child(robot, "size")
    half = half_diagonal(size) if size is not None else None
    if half is None:
        raise _missing(robot, "size")
    return half


def _capability(capability: Element) -> Capability:
    speed = child(capability, "speed")
    slowest, fastest = (number(speed, "min"), number(speed, "max")) if speed is not None else (None, None)
    if slowest is None or fastest is None:
        raise _missing(capability, "speed")
    return Capability(
        payload=number(capability, "payloadWeight") or 0.0,
        lifetime=number(capability, "lifetime"),
        speed=(slowest, fastest),
        acceleration=number(capability, "maxAcceleration"),
        climb_rate=number(capability, "maxClimbRate"),
        descent_rate=number(capability, "maxDescentRate"),
        turn_rate=number(capability, "maxTurnRate"),
        part=part_of(capability, NO_GROUND),
        leg_timings=_leg_timings(capability),
        launch=number(capability, "launchTime"),
        recovery=number(capability, "recoveryTime"),
        landing_rate=number(capability, "landingRate"),
        landing_height=number(capability, "landingHeight"),
    )


LEG_FIGURES = {
    "maxSpeed": "speed",
    "maxAcceleration": "acceleration",
    "maxDeceleration": "deceleration",
    "maxVerticalAcceleration": "vertical_acceleration",
    "maxJerk": "jerk",
    "maxClimbRate": "climb",
    "maxDescentRate": "descent",
    "cornerRadius": "corner_radius",
    "settlingTime": "settling",
    "overshoot": "overshoot",
    "lag": "lag",
    "lagTime": "lag_within",
    "spread": "spread",
}
"""Attributes of `LegTiming`, by feature."""


def _leg_timings(capability: Element) -> dict[str, dict[str, float]]:
    """Return the figures of legs by how they are commanded; those of one way override those of both."""
    found: dict[str, dict[str, float]] = {"STEP": {}, "MISSION": {}}
    listed = sorted(children(capability, "legTimings"), key=lambda each: each.eIsSet("flownAs"))
    for each in listed:
        values = {name: number(each, feature) for feature, name in LEG_FIGURES.items()}
        known = {name: value for name, value in values.items() if value is not None}
        if "acceleration" in known:
            known.setdefault("deceleration", known["acceleration"])
        modes = (text(each, "flownAs"),) if each.eIsSet("flownAs") else tuple(found)
        for mode in modes:
            found[mode] |= known
    return found


def _battery(battery: Element) -> Battery:
    capacity, voltage = number(battery, "capacity"), number(battery, "voltage")
    if capacity is None or voltage is None:
        raise _missing(battery, "capacity" if capacity is None else "voltage")
    return Battery(capacity * MILLIAMPERE_HOUR * voltage, number(battery, "rechargeTime"), voltage)


def _device(device: Element) -> Device:
    actions = (
        DeviceAction(
            text(each, "name"),
            number(each, "duration") or 0.0,
            tuple(text(parameter, "key") for parameter in children(each, "parameters")),
        )
        for each in children(device, "supportedActions")
    )
    properties = {text(each, "name"): text(each, "value") for each in children(device, "properties")}
    return Device(text(device, "id"), {action.name: action for action in actions}, properties)


def _missing(element: Element, feature: str) -> InvalidModelError:
    found = fault(element, f"has no {feature}, without which it cannot be planned for", "", MISSING)
    return InvalidModelError(f"{place_of(element)}: {found.message}", [found])
