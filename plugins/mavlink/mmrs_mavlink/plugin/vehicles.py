"""Which vehicle profile carries a robot, and how long its vehicle takes, for plans and simulations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.hooks import Extensions
from mmrs_core.contributions.rules import MoveKind, RobotKind, robot_kind_of
from mmrs_core.contributions.timing import VehicleTiming
from mmrs_core.scene import Name, RobotType
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUROVER, PROFILES, VehicleProfile
from mmrs_mavlink.steps.energy import CHARGING_FACTOR
from mmrs_runtime.timing import AutopilotTiming

AUTOPILOT = "mavlink.autopilot"
"""The property of a device that names the autopilot."""


def profile_of(
    robot: RobotProgram | None,
    type: RobotType | None,
    kinds: Mapping[Name, RobotKind],
    moves: Mapping[Name, MoveKind],
    extensions: Extensions,
) -> VehicleProfile | None:
    """Return the profile that carries a robot: by its type, otherwise by its moves; None: no profile does.

    Args:
        robot: of a behaviour; None: of a mission, where the type is known.
        type: of the robot; None where it is unknown.
        kinds: robot kinds. moves: move kinds.
        extensions: contributions of plug-ins, with their profiles.
    """
    if type is not None:
        return profile_of_type(type, kinds, extensions)
    made = robot.moves if robot is not None else ()
    takes_off = any(manoeuvre_of(move.metaclasses[0], moves) == "take_off" for move in made)
    return ARDUCOPTER if takes_off else ARDUROVER


def profile_of_type(
    type: RobotType, kinds: Mapping[Name, RobotKind], extensions: Extensions
) -> VehicleProfile | None:
    """Return the profile that carries robots of a type, whatever they do; None: no profile does.

    That is the one of the class of vehicle that the robot kind names, with the autopilot that the type names.
    """
    kind, autopilot = robot_kind_of(type, kinds), autopilot_of(type, extensions)
    vehicle = kind.vehicle if kind is not None else ARDUROVER.vehicle
    fitting = (each for each in profiles_in(extensions) if vehicle in each.words)
    return next((each for each in fitting if autopilot in ("", each.autopilot.name)), None)


def profiles_in(extensions: Extensions) -> Iterator[VehicleProfile]:
    """Yield all profiles: those of this plug-in first, then those of others by name."""
    known = extensions.get("vehicle_profiles", {})
    yield from PROFILES.values()
    yield from (known[name] for name in sorted(known.keys() - PROFILES.keys()))


def uncarried(
    robot: str, type: RobotType | None, kinds: Mapping[Name, RobotKind], extensions: Extensions
) -> str:
    """Return why no profile carries a robot, with the name of its kind; empty where one does."""
    kind = robot_kind_of(type, kinds) if type is not None else None
    words = sorted({word for each in profiles_in(extensions) for word in each.words})
    if type is None or kind is None or profile_of_type(type, kinds, extensions) is not None:
        return ""
    if kind.vehicle in words:
        autopilot = autopilot_of(type, extensions)
        return (
            f"robot '{robot}': {AUTOPILOT} is '{autopilot}', with which no profile of {kind.vehicle} is known"
        )
    named = f"names vehicle '{kind.vehicle}'" if kind.vehicle else "names no vehicle"
    known = ", ".join(words)
    hint = "RobotKind.vehicle names one; plug-ins add others by mmrs_vehicle_profiles"
    return f"robot '{robot}': is of kind '{kind.name}', which {named}; known are {known} ({hint})"


def manoeuvre_of(metaclass: Name, moves: Mapping[Name, MoveKind]) -> str:
    """Return what a vehicle does to make a move of a metaclass; empty where its kind does not state it."""
    kind = moves.get(metaclass)
    return kind.manoeuvre if kind is not None else ""


def autopilots_in(type: RobotType | None) -> tuple[str, ...]:
    """Return what the devices of a robot type state of its autopilot (``mavlink.autopilot``), sorted."""
    devices = type.devices.values() if type is not None else ()
    return tuple(
        sorted({device.properties[AUTOPILOT] for device in devices if AUTOPILOT in device.properties})
    )


def autopilot_of(type: RobotType | None, extensions: Extensions) -> str:
    """Return which autopilot robots of a type have; empty where the type does not state one clearly."""
    found = autopilots_in(type)
    return found[0] if len(found) == 1 and found[0] in _autopilots(extensions) else ""


def autopilot_fault(type: RobotType | None, extensions: Extensions) -> str:
    """Return what is wrong with what a type states of its autopilot; empty: nothing."""
    found, known = autopilots_in(type), _autopilots(extensions)
    shown = ", ".join(map(repr, found))
    if len(found) > 1:
        return f"{AUTOPILOT} is {shown}: it is ambiguous"
    if found and found[0] not in known:
        return f"{AUTOPILOT} is {shown}; known are {' and '.join(known)}"
    return ""


def _autopilots(extensions: Extensions) -> tuple[str, ...]:
    return tuple(dict.fromkeys(each.autopilot.name for each in profiles_in(extensions)))


def timings() -> Iterator[VehicleTiming]:
    """Yield the timing of each class of vehicle."""
    for vehicle in dict.fromkeys(word for each in PROFILES.values() for word in each.words):
        yield VehicleTiming(vehicle, partial(_timing_of, vehicle))


def _timing_of(vehicle: str, type: RobotType) -> AutopilotTiming:
    """Return the timing with the autopilot that the type names, else with ArduPilot."""
    named = autopilot_of(type, {})
    fitting = [each for each in PROFILES.values() if vehicle in each.words]
    profile = next((each for each in fitting if each.autopilot.name == named), fitting[0])
    step = replace(profile.pacing.step, still=profile.still)
    return replace(profile.pacing, step=step, charging=CHARGING_FACTOR)
