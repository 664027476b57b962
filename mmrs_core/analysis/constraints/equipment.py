"""What a behaviour asks of the robots that carry it out."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.constraints.capabilities import devices_of
from mmrs_core.analysis.constraints.findings import BEHAVIOUR, finding, guessed, listed
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, container_of, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet


def _type_of(robot: Element, models: ModelSet) -> Element | None:
    return models.robots.get(text(robot, "typeName"))


def _type_around(element: Element, models: ModelSet) -> Element | None:
    """Return the type of the robot that an element belongs to; None where it is not known."""
    owner: Element | None = element
    while owner is not None and not is_kind(owner, BEHAVIOUR, "Robot"):
        owner = container_of(owner)
    return _type_of(owner, models) if owner is not None else None


def _unknown_type(robot: Element, models: ModelSet) -> Iterator[Finding]:
    name = text(robot, "typeName")
    if name and models.robots and name not in models.robots:
        known = f"known are {listed(sorted(models.robots))}"
        yield finding(robot, f"unknown robot type {name!r}", guessed(known, name, models.robots))


def _without_device(element: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, device = _type_around(element, models), text(element, "deviceId")
    if robot_type is None or not device:
        return
    known = devices_of(robot_type)
    if device not in known:
        yield finding(
            element,
            f"{text(robot_type, 'name')!r} has no device {device!r}",
            guessed(f"its devices are {listed(sorted(known))}", device, known),
        )


def _unsupported(action: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, device, name = (
        _type_around(action, models),
        text(action, "deviceId"),
        text(action, "actionName"),
    )
    supported = devices_of(robot_type).get(device)
    if supported is not None and name and name not in supported:
        yield finding(
            action,
            f"device {device!r} does not support the action {name!r}",
            guessed(f"it supports {listed(sorted(supported))}", name, supported),
        )


def _unknown_parameter(action: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type = _type_around(action, models)
    known = _parameters(robot_type, text(action, "deviceId"), text(action, "actionName"))
    for pair in children(action, "parameters"):
        key = text(pair, "key")
        if known is not None and key and key not in known:
            yield finding(
                pair,
                f"the action {text(action, 'actionName')!r} has no parameter {key!r}",
                guessed(f"it has {listed(sorted(known))}", key, known),
            )


def _parameters(robot_type: Element | None, device: str, action: str) -> frozenset[str] | None:
    """Return the keys that an action of a device accepts; None where there is no such action."""
    for each in children(robot_type, "devices"):
        for supported in children(each, "supportedActions") if text(each, "id") == device else ():
            if text(supported, "name") == action:
                return frozenset(text(parameter, "key") for parameter in children(supported, "parameters"))
    return None


def _overloaded(robot: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, payload = _type_of(robot, models), number(robot, "payload")
    if robot_type is None or payload is None or payload <= 0:
        return
    largest = number(robot_type, "maxPayload") or 0.0
    if payload > largest:
        yield finding(robot, f"carries {payload:g} kg, but its type carries at most {largest:g} kg")


def _no_recharge(recharge: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type = _type_around(recharge, models)
    batteries = children(robot_type, "batteries")
    times = [number(battery, "rechargeTime") for battery in batteries]
    known = [time for time in times if time is not None]
    if robot_type is None or not batteries:
        return
    if len(known) < len(times):
        yield finding(recharge, f"a battery of {text(robot_type, 'name')!r} cannot be recharged")
    elif (duration := number(recharge, "duration")) is not None and duration < max(known):
        yield finding(recharge, f"takes {duration:g} s, but recharging takes {max(known):g} s")


def _tolerance(target: Element, models: ModelSet) -> Iterator[Finding]:
    if number(target, "tolerance") is not None and child(target, "expectedAt") is None:
        yield finding(target, "has a tolerance, but no expected position")


def _too_fast(move: Element, models: ModelSet) -> Iterator[Finding]:
    robot_type, speed = _type_around(move, models), number(move, "speed")
    limits = [child(each, "speed") for each in children(robot_type, "movementCapabilities")]
    tops = [top for each in limits if each is not None and (top := number(each, "max")) is not None]
    if speed is not None and tops and speed > max(tops):
        yield finding(move, f"its speed is {speed:g} m/s, but the robot reaches {max(tops):g} m/s")


def _unused_targets(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    ends = ("target", "home", "reference", "expectedAt", "origin")
    used = {child(each, end) for each in (behaviour, *descendants(behaviour)) for end in ends}
    for target in children(behaviour, "targets"):
        if target not in used:
            yield finding(target, "is not used")


CONSTRAINTS = (
    Constraint(
        "BL035",
        "The type of every robot is known.",
        (BEHAVIOUR, "Robot"),
        _unknown_type,
        "name the robot type's file, or correct typeName",
    ),
    Constraint(
        "BL036",
        "A device action is one of a device that the robot has.",
        (BEHAVIOUR, "DeviceAction"),
        _without_device,
        "name a device of the robot's type",
    ),
    Constraint(
        "BL037",
        "A device action is one that the device supports.",
        (BEHAVIOUR, "DeviceAction"),
        _unsupported,
        "name a supported action of the device",
    ),
    Constraint(
        "BL038",
        "The parameters of a device action are ones that the action accepts.",
        (BEHAVIOUR, "DeviceAction"),
        _unknown_parameter,
        "name a parameter of the action",
    ),
    Constraint(
        "BL039",
        "What a heading turns to its target is a device that the robot has.",
        (BEHAVIOUR, "Heading"),
        _without_device,
        "name a device of the robot's type, or leave deviceId out for the front",
    ),
    Constraint(
        "BL040",
        "The expected position of an object has a tolerance, not the object.",
        (BEHAVIOUR, "ObjectTarget"),
        _tolerance,
        "give expectedAt, or remove the tolerance",
        Severity.WARNING,
    ),
    Constraint(
        "BL042",
        "No robot carries more than its type can.",
        (BEHAVIOUR, "Robot"),
        _overloaded,
        "reduce the payload, or state maxPayload in the robot type",
    ),
    Constraint(
        "BL043",
        "A robot that recharges can, in the time it has.",
        (BEHAVIOUR, "Recharge"),
        _no_recharge,
        "hold for at least the longest rechargeTime",
    ),
    Constraint(
        "BL044",
        "No speed is above what the robot reaches.",
        (BEHAVIOUR, "GoTo"),
        _too_fast,
        "leave the speed out to go by the travel mode",
    ),
    Constraint(
        "BL045",
        "Every target is used.",
        (BEHAVIOUR, "Behaviour"),
        _unused_targets,
        "remove the target",
        Severity.WARNING,
    ),
)
