"""Constraints on which thrusters of a vehicle its movement capabilities use."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.names import AUV_MOVEMENT, VEHICLE
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import children
from mmrs_core.languages.element import Element, container_of, label_of
from mmrs_core.languages.modelset import ModelSet


def _not_its_own(movement: Element, models: ModelSet) -> Iterator[Finding]:
    used = children(movement, "thrusters")
    for index, thruster in enumerate(used):
        if container_of(thruster) is not container_of(movement):
            yield Finding(movement, f"thrusters: '{label_of(thruster)}' is one of another vehicle")
        elif thruster in used[:index]:
            yield Finding(movement, f"thrusters: '{label_of(thruster)}' is listed twice")


def _unused(vehicle: Element, models: ModelSet) -> Iterator[Finding]:
    used = [
        each for move in children(vehicle, "movementCapabilities") for each in children(move, "thrusters")
    ]
    for thruster in children(vehicle, "thrusters"):
        if thruster not in used:
            yield Finding(thruster, f"thruster '{label_of(thruster)}' is used by no movement capability")


THRUSTER_CONSTRAINTS = (
    Constraint(
        "AUV032",
        "A movement capability uses thrusters of its own vehicle, each once",
        AUV_MOVEMENT,
        _not_its_own,
        'list each of them once, such as thrusters="//@thrusters.0 //@thrusters.1"',
    ),
    Constraint(
        "AUV033",
        "Some movement capability uses each thruster",
        VEHICLE,
        _unused,
        "add it to the thrusters of the movement capability, or take it away",
        Severity.WARNING,
    ),
)
"""What must hold for the thrusters that movement capabilities refer to."""
