"""Constraints on ballast, and on what the devices of a vehicle state of themselves."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.names import IN_WATER_SIZE, SONAR_KEYS
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import children, number, text
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.naming import nearest
from mmrs_core.planning.devices import figure

ROBOT_TYPE, DEVICE = ("urn:mmrs:robot:1.0", "Robot"), ("urn:mmrs:robot:1.0", "Device")

KIND = "sensor.kind"
KINDS = ("depth", "imu", "compass", "dvl", "sonar", "altimeter")
LOG_FIGURES = ("dvl.range.min", "dvl.range.max")
FIGURES = (*SONAR_KEYS, *LOG_FIGURES)
OURS = ("sonar.", "dvl.")
"""What names of properties begin with that are read here."""


def _stays_down(size: Element, models: ModelSet) -> Iterator[Finding]:
    wet, drop = number(size, "weightInWater"), number(size, "dropWeight") or 0.0
    if wet is not None and wet - drop > 0.0:
        without = f", {wet - drop:g} kg without its drop weight of {drop:g} kg" if drop > 0.0 else ""
        yield Finding(size, f"weightInWater is {wet:g} kg{without}: it does not surface on its own")


def _no_ballast(size: Element, models: ModelSet) -> Iterator[Finding]:
    drop, weight = number(size, "dropWeight"), number(size, "weight")
    if drop is not None and drop <= 0.0:
        yield Finding(size, f"dropWeight is {drop:g} kg, it must be above 0")
    elif drop is not None and weight is not None and drop > weight:
        yield Finding(size, f"dropWeight is {drop:g} kg, above the weight of {weight:g} kg")


def _unreadable(device: Element, models: ModelSet) -> Iterator[Finding]:
    for each in children(device, "properties"):
        key, said = text(each, "name"), text(each, "value")
        if key in FIGURES and figure({key: said}, key) is None:
            yield Finding(each, f"property '{key}' of device '{text(device, 'id')}' is '{said}'")
        elif key == KIND and said not in KINDS:
            known = ", ".join(KINDS)
            yield Finding(each, f"{KIND} of device '{text(device, 'id')}' is '{said}', none of {known}")
        elif key.startswith(OURS) and key not in (KIND, *FIGURES):
            hint = nearest(key, (KIND, *FIGURES))
            yield Finding(
                each,
                f"unknown property '{key}' of device '{text(device, 'id')}'" + (f"; {hint}" * bool(hint)),
            )


def _differing_logs(robot: Element, models: ModelSet) -> Iterator[Finding]:
    """Find Doppler logs of different ranges: the vehicle's estimator knows one."""
    first: dict[str, tuple[str, str]] = {}
    for device in children(robot, "devices"):
        said = {text(each, "name"): text(each, "value") for each in children(device, "properties")}
        if said.get(KIND) != "dvl":
            continue
        for key in LOG_FIGURES:
            if (most := figure(said, key)) is None:
                continue
            other, known = first.setdefault(key, (text(device, "id"), said[key]))
            if most != figure({key: known}, key):
                yield Finding(
                    device, f"{key} of '{text(device, 'id')}' is {said[key]}, that of '{other}' is {known}"
                )


EQUIPMENT_CONSTRAINTS = (
    Constraint(
        "AUV019",
        "A vehicle comes up when its thrusters stop, at the latest without its drop weight",
        IN_WATER_SIZE,
        _stays_down,
        "trim the vehicle to be buoyant, or give it a dropWeight",
        Severity.WARNING,
    ),
    Constraint(
        "AUV020",
        "A drop weight weighs something, and no more than the vehicle",
        IN_WATER_SIZE,
        _no_ballast,
        "dropWeight is in kilograms of apparent mass under water; leave it out where there is none",
    ),
    Constraint(
        "AUV021",
        "Sensors are of kinds that are known, and say figures above 0 under names that are known",
        DEVICE,
        _unreadable,
        "metres and degrees as plain numbers, such as 30.0",
        Severity.WARNING,
    ),
    Constraint(
        "AUV034",
        "Doppler logs of a vehicle measure between the same heights",
        ROBOT_TYPE,
        _differing_logs,
        "leave out the log that the vehicle does not navigate by",
    ),
)
"""What must hold for ballast and devices."""
