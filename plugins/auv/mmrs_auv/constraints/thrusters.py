"""Constraints on which thrusters of a vehicle its movement capabilities use."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mmrs_auv.names import AUV_MOVEMENT, MOUNTING, VEHICLE
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number, texts
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
        "add it to the thrusters of the movement capability, or remove it",
        Severity.WARNING,
    ),
)
"""What must hold for the thrusters that movement capabilities refer to."""


ROBOT_TYPE = ("urn:mmrs:robot:1.0", "Robot")
DEGREES = ("SURGE", "SWAY", "HEAVE", "ROLL", "PITCH", "YAW")
POSITION = ("forward", "starboard", "down")
PUSH = ("pushForward", "pushStarboard", "pushDown")
EXTENT = dict(zip(POSITION, ("length", "width", "height"), strict=True))

SMALL = 1e-3
"""Share of a thruster's own force or leverage that counts as none."""


FARTHEST = 1e3
"""Metres from the centre of gravity beyond which nothing is mounted."""


def _wrench(mounting: Element) -> NDArray[np.float64] | None:
    """Return force and moment on the vehicle, in the order of `DEGREES`, of one newton of thrust.

    Moments are in newton metres about the centre of gravity. None without a direction, or where a
    position is none.
    """
    place, push = ([number(mounting, name) or 0.0 for name in names] for names in (POSITION, PUSH))
    most = max(abs(each) for each in push)
    if most == 0.0 or max(abs(each) for each in place) > FARTHEST:
        return None
    parts = np.array([each / most for each in push])
    force = parts / np.linalg.norm(parts)
    return np.concatenate([force, np.cross(np.array(place), force)])


def _wrenches(movement: Element) -> list[NDArray[np.float64]] | None:
    """Return what each thruster does; None where that of one is not known."""
    found = []
    for thruster in children(movement, "thrusters"):
        mounting = child(thruster, "mounting")
        wrench = _wrench(mounting) if mounting is not None else None
        if wrench is None:
            return None
        found.append(wrench)
    return found or None


def _pushes_nowhere(mounting: Element, models: ModelSet) -> Iterator[Finding]:
    if all((number(mounting, name) or 0.0) == 0.0 for name in PUSH):
        yield Finding(mounting, f"{', '.join(PUSH)}: all are 0, the thruster pushes nowhere")


def _idle_degree(movement: Element, models: ModelSet) -> Iterator[Finding]:
    for thruster in children(movement, "thrusters"):
        mounting = child(thruster, "mounting")
        wrench = _wrench(mounting) if mounting is not None else None
        if wrench is None:
            continue
        for degree in dict.fromkeys(texts(thruster, "freedomDegree")):
            if degree in DEGREES and abs(wrench[DEGREES.index(degree)]) <= _least(degree, wrench):
                yield Finding(
                    thruster,
                    f"freedomDegree of thruster '{label_of(thruster)}' lists {degree}, mounted as it is "
                    "it does nothing for that",
                )


def _least(degree: str, wrench: NDArray[np.float64]) -> float:
    """Return what counts as nothing: a share of the force, or of the moment about all axes."""
    return SMALL if DEGREES.index(degree) < 3 else SMALL * float(np.linalg.norm(wrench[3:]))


def _bound_degree(movement: Element, models: ModelSet) -> Iterator[Finding]:
    wrenches = _wrenches(movement)
    if wrenches is None:
        return
    listed = [set(texts(each, "freedomDegree")) for each in children(movement, "thrusters")]
    for index, degree in enumerate(DEGREES):
        asked = any(degree in degrees for degrees in listed)
        able = any(abs(wrench[index]) > _least(degree, wrench) for wrench in wrenches)
        if asked and able and not alone(wrenches, index):
            yield Finding(
                movement,
                f"freedomDegree: thrusters serve {degree} only together with other degrees of freedom",
            )


def alone(wrenches: Sequence[NDArray[np.float64]], index: int) -> bool:
    """Return whether thrusters together can act in one degree of freedom and in no other.

    Args:
        wrenches: of each thruster, in the order of `DEGREES`.
        index: of the degree.
    """
    matrix = np.array(wrenches).T
    leverage = max(float(np.abs(matrix[3:]).max()), 1e-6)
    matrix = np.vstack([matrix[:3], matrix[3:] / leverage])
    wanted = np.zeros(6)
    wanted[index] = 1.0
    thrusts = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    return bool(np.abs(matrix @ thrusts - wanted).max() <= SMALL)


def _half_mounted(movement: Element, models: ModelSet) -> Iterator[Finding]:
    thrusters = children(movement, "thrusters")
    bare = [each for each in thrusters if child(each, "mounting") is None]
    if bare and len(bare) < len(thrusters):
        names = ", ".join(f"'{label_of(each)}'" for each in bare)
        yield Finding(bare[0], f"mounting of {names} is missing, other thrusters have one")


def _outside_hull(robot_type: Element, models: ModelSet) -> Iterator[Finding]:
    size = child(robot_type, "size")
    if size is None:
        return
    extents = {name: number(size, extent) for name, extent in EXTENT.items()}
    for movement in children(robot_type, "movementCapabilities"):
        for thruster in children(movement, "thrusters"):
            mounting = child(thruster, "mounting")
            if mounting is None:
                continue
            for name, whole in extents.items():
                at = number(mounting, name)
                if at is not None and whole is not None and abs(at) > whole > 0.0:
                    yield Finding(
                        thruster,
                        f"{name} of thruster '{label_of(thruster)}' is {at:g} m, the {EXTENT[name]} of the "
                        f"vehicle is {whole:g} m",
                    )


MOUNTING_CONSTRAINTS = (
    Constraint(
        "AUV014",
        "A thruster that is mounted pushes somewhere",
        MOUNTING,
        _pushes_nowhere,
        'pushForward="1.0" pushes the vehicle forward, pushDown="1.0" down',
    ),
    Constraint(
        "AUV015",
        "A thruster acts in every degree of freedom that it lists, mounted as it is",
        AUV_MOVEMENT,
        _idle_degree,
        "correct the mounting, or take the degree of freedom out",
    ),
    Constraint(
        "AUV016",
        "Thrusters together act in each degree of freedom that they list, and in no other",
        AUV_MOVEMENT,
        _bound_degree,
        "mount a thruster that cancels the rest, or take the degree of freedom out",
        Severity.WARNING,
    ),
    Constraint(
        "AUV017",
        "All thrusters of a movement capability are mounted, or none",
        AUV_MOVEMENT,
        _half_mounted,
        "give each thruster a mounting: where it sits and which way it pushes",
        Severity.WARNING,
    ),
    Constraint(
        "AUV018",
        "Thrusters sit at the vehicle",
        ROBOT_TYPE,
        _outside_hull,
        "positions are metres from the centre of gravity",
        Severity.WARNING,
    ),
)
"""What must hold for where thrusters sit."""
