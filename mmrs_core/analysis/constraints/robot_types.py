"""Robot types whose figures fit together."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from mmrs_core.analysis.constraints.findings import ROBOT, called, finding
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, container_of
from mmrs_core.languages.modelset import ModelSet

LARGEST_ROBOT = 50.0
"""Metres; beyond it the unit is suspect."""
SMALLEST_CAPACITY = 20.0
"""Milliampere-hours; below it the unit is suspect."""
SHORTEST_LIFETIME = 60.0
"""Seconds; below it the unit is suspect."""
LOWEST_PRESSURE = 50_000.0
"""Pascals absolute, as at a height of 5.5 km; below it the unit is suspect."""


def _upside_down(interval: Element, models: ModelSet) -> Iterator[Finding]:
    low, high = number(interval, "min"), number(interval, "max")
    if low is not None and high is not None and low > high:
        yield finding(interval, f"its min of {low:g} is above its max of {high:g}")


def _speed(capability: Element, models: ModelSet) -> Iterator[Finding]:
    speed = child(capability, "speed")
    low, high = (number(speed, "min"), number(speed, "max")) if speed is not None else (None, None)
    if low is not None and low < 0:
        yield finding(capability, f"its smallest speed is {low:g} m/s, but must be at least 0")
    if high is not None and high <= 0:
        yield finding(capability, f"its largest speed is {high:g} m/s, but must be more than 0")


def _same_payload(robot: Element, models: ModelSet) -> Iterator[Finding]:
    seen: set[float] = set()
    for capability in children(robot, "movementCapabilities"):
        weight = number(capability, "payloadWeight")
        if weight is not None and weight in seen:
            yield finding(capability, f"there are already figures for a payload of {weight:g} kg")
        seen.update(() if weight is None else (weight,))


def _beyond_payload(robot: Element, models: ModelSet) -> Iterator[Finding]:
    largest = number(robot, "maxPayload") or 0.0
    for capability in children(robot, "movementCapabilities"):
        weight = number(capability, "payloadWeight")
        if weight is not None and weight > largest:
            yield finding(
                capability, f"gives figures for {weight:g} kg, but {called(robot)} carries {largest:g} kg"
            )


def _no_lifetime(robot: Element, models: ModelSet) -> Iterator[Finding]:
    capabilities = children(robot, "movementCapabilities") if children(robot, "batteries") else ()
    for capability in capabilities:
        if number(capability, "lifetime") is None:
            yield finding(
                capability, "runs on batteries, but has no lifetime: no sortie can be shown to be safe"
            )


def _rising_lifetime(robot: Element, models: ModelSet) -> Iterator[Finding]:
    known = [
        (weight, lifetime, each)
        for each in children(robot, "movementCapabilities")
        if (weight := number(each, "payloadWeight")) is not None
        and (lifetime := number(each, "lifetime")) is not None
    ]
    known.sort(key=lambda each: each[0])
    for (light, short, _), (heavy, long, capability) in pairwise(known):
        if heavy > light and long > short:
            yield finding(
                capability, f"lasts {long:g} s with {heavy:g} kg, longer than with {light:g} kg ({short:g} s)"
            )


def _size(size: Element, models: ModelSet) -> Iterator[Finding]:
    for side in ("width", "length", "height"):
        found = number(size, side)
        if found is not None and found > LARGEST_ROBOT:
            yield finding(size, f"its {side} is {found:g} m")


def _capacity(battery: Element, models: ModelSet) -> Iterator[Finding]:
    capacity = number(battery, "capacity")
    if capacity is not None and 0 < capacity < SMALLEST_CAPACITY:
        yield finding(battery, f"its capacity is {capacity:g} mAh")


def _lifetime(capability: Element, models: ModelSet) -> Iterator[Finding]:
    lifetime = number(capability, "lifetime")
    if lifetime is not None and 0 < lifetime < SHORTEST_LIFETIME:
        yield finding(capability, f"its lifetime is {lifetime:g} s")


def _pressure(robot: Element, models: ModelSet) -> Iterator[Finding]:
    pressure = number(robot, "maxOperatingPressure")
    if pressure is not None and 0 < pressure < LOWEST_PRESSURE:
        yield finding(robot, f"its maxOperatingPressure of {pressure:g} Pa is below that of the air")


def _carry_on(policy: Element, models: ModelSet) -> Iterator[Finding]:
    if text(policy, "event") == "BATTERY_LOW" and text(policy, "response") == "CONTINUE":
        owner = container_of(policy)
        whom = called(owner) if owner is not None else "a robot"
        yield finding(policy, f"lets {whom} continue until the battery is empty")


def _way_back(policy: Element, models: ModelSet) -> Iterator[Finding]:
    response = text(policy, "response")
    if text(policy, "event") == "POSITION_LOST" and response in ("RETURN", "EMERGENCY_AREA"):
        yield finding(policy, f"{response} needs a position, and the robot has none")


CONSTRAINTS = (
    Constraint(
        "RL017",
        "The smallest value of an interval is not above its largest.",
        (ROBOT, "Interval"),
        _upside_down,
        "swap min and max",
    ),
    Constraint(
        "RL018",
        "A robot can move: its largest speed is more than 0, its smallest not negative.",
        (ROBOT, "MovementCapability"),
        _speed,
        "give both in metres per second",
    ),
    Constraint(
        "RL019",
        "A robot type gives figures for a payload once.",
        (ROBOT, "Robot"),
        _same_payload,
        "keep one movement capability for each payload",
    ),
    Constraint(
        "RL020",
        "Figures hold for payloads that the robot can carry.",
        (ROBOT, "Robot"),
        _beyond_payload,
        "raise maxPayload, or remove the figures",
        Severity.WARNING,
    ),
    Constraint(
        "RL021",
        "A robot with batteries has a lifetime.",
        (ROBOT, "Robot"),
        _no_lifetime,
        "give the lifetime in seconds on full batteries",
        Severity.WARNING,
    ),
    Constraint(
        "RL022",
        "A heavier payload does not make a robot last longer.",
        (ROBOT, "Robot"),
        _rising_lifetime,
        "check the two lifetimes",
        Severity.WARNING,
    ),
    Constraint(
        "RL023",
        "Dimensions are in metres.",
        (ROBOT, "Size"),
        _size,
        "divide by 1000 if this was meant in millimetres",
        Severity.WARNING,
    ),
    Constraint(
        "RL024",
        "The capacity of a battery is in milliampere-hours.",
        (ROBOT, "Battery"),
        _capacity,
        "multiply by 1000 if this was meant in ampere-hours",
        Severity.WARNING,
    ),
    Constraint(
        "RL025",
        "A lifetime is in seconds.",
        (ROBOT, "MovementCapability"),
        _lifetime,
        "multiply by 60 if this was meant in minutes",
        Severity.WARNING,
    ),
    Constraint(
        "RL026",
        "A pressure is absolute, in pascals.",
        (ROBOT, "Robot"),
        _pressure,
        "one bar is 100000 Pa; add 101325 Pa to a pressure relative to the air",
        Severity.WARNING,
    ),
    Constraint(
        "RL027",
        "A low battery has a response.",
        (ROBOT, "Policy"),
        _carry_on,
        "let the robot return, land or go to an emergency area",
        Severity.WARNING,
    ),
    Constraint(
        "RL029",
        "A robot that has lost its position does not travel.",
        (ROBOT, "Policy"),
        _way_back,
        "let it land, surface, hold or stop its thrust",
    ),
)
