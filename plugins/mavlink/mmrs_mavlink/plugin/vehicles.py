"""Which MAVLink vehicle a robot is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.rules import RobotKind, most_specific, robot_kind_of
from mmrs_core.scene import Name, RobotType

TAKE_OFF = ("urn:mmrs:multicopter:1.0", "TakeOff")


@dataclass(frozen=True, slots=True)
class VehicleClass:
    """A sort of vehicle.

    Attributes:
        name: ``copter``, ``sub`` or ``rover``.
        mav_type: number of MAV_TYPE.
        flies: whether it takes off and lands.
        dives: whether its heights count from the water surface.
        alone: responses of policies that it can give by itself, when it no longer hears the ground.
        more: those that it can only give when its controller asks for them.
    """

    name: str
    mav_type: int
    flies: bool = False
    dives: bool = False
    alone: frozenset[str] = frozenset()
    more: frozenset[str] = frozenset()

    @property
    def responses(self) -> frozenset[str]:
        """Return the responses of policies that it can give when its controller asks for them."""
        return self.alone | self.more


COPTER = VehicleClass(
    "copter",
    2,
    flies=True,
    alone=frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "LAND", "HOLD"}),
)
SUB = VehicleClass(
    "sub",
    12,
    dives=True,
    alone=frozenset({"CONTINUE", "STOP_THRUST", "HOLD", "SURFACE", "LAND", "RETURN"}),
    more=frozenset({"EMERGENCY_AREA"}),
)
ROVER = VehicleClass(
    "rover",
    10,
    alone=frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "HOLD", "LAND", "STOP_THRUST"}),
)

AUTOPILOT = "mavlink.autopilot"
"""The property of a device that says which autopilot it is."""

ARDUPILOT, PX4 = "ardupilot", "px4"
AUTOPILOTS: Mapping[str, int] = {ARDUPILOT: 3, PX4: 12}
"""Numbers of MAV_AUTOPILOT."""

CLASSES: Mapping[Name, VehicleClass] = {
    ("urn:mmrs:multicopter:1.0", "Drone"): COPTER,
    ("urn:mmrs:auv:1.1", "AUVMovement"): SUB,
    ("urn:mmrs:robot:1.0", "Robot"): ROVER,
}


GROUND = "ground"
"""What the core calls the vehicles of robots that no plug-in knows better: rovers carry them."""

VEHICLES: Mapping[str, VehicleClass] = {each.name: each for each in CLASSES.values()}


def vehicle_class(
    robot: RobotProgram, type: RobotType | None, kinds: Mapping[Name, RobotKind]
) -> VehicleClass | None:
    """Return what a robot is by its type, or, where that is missing, by what it does; None: no vehicle."""
    found = class_of_type(type, kinds) if type is not None else ROVER
    if found is not ROVER:
        return found
    return COPTER if any(move.is_a(TAKE_OFF) for move in robot.moves) else ROVER


def class_of_type(type: RobotType, kinds: Mapping[Name, RobotKind]) -> VehicleClass | None:
    """Return what robots of a type are, whatever they do; None where their kind names no vehicle."""
    kind = robot_kind_of(type, kinds)
    return _carrying(kind.vehicle) if kind is not None else _by_metaclass(type)


def _carrying(word: str) -> VehicleClass | None:
    return ROVER if word == GROUND else VEHICLES.get(word)


def uncarried(robot: str, type: RobotType | None, kinds: Mapping[Name, RobotKind]) -> str:
    """Return why no vehicle carries a robot, with the name of its kind; empty where one does."""
    kind = robot_kind_of(type, kinds) if type is not None else None
    if kind is None or _carrying(kind.vehicle) is not None:
        return ""
    known = ", ".join(sorted((*VEHICLES, GROUND)))
    named = f"names vehicle '{kind.vehicle}'" if kind.vehicle else "names no vehicle"
    return f"robot '{robot}': is of kind '{kind.name}', which {named}; known are {known} (RobotKind.vehicle)"


def _by_metaclass(type: RobotType) -> VehicleClass:
    """Return what robots of a type are where the kinds of robot are not at hand."""
    for metaclasses in (type.metaclasses, type.capability_metaclasses):
        found = most_specific(metaclasses, CLASSES)
        if found is not None and CLASSES[found] is not ROVER:
            return CLASSES[found]
    return ROVER


def autopilots_in(type: RobotType | None) -> tuple[str, ...]:
    """Return what the devices of a robot type say of its autopilot (``mavlink.autopilot``), sorted."""
    devices = type.devices.values() if type is not None else ()
    return tuple(
        sorted({device.properties[AUTOPILOT] for device in devices if AUTOPILOT in device.properties})
    )


def autopilot_of(type: RobotType | None) -> str:
    """Return which autopilot robots of a type have; ArduPilot where the type does not say, or not clearly."""
    found = autopilots_in(type)
    return found[0] if len(found) == 1 and found[0] in AUTOPILOTS else ARDUPILOT


def autopilot_fault(type: RobotType | None) -> str:
    """Return what is wrong with what a type says of its autopilot; empty: nothing."""
    found = autopilots_in(type)
    shown = ", ".join(map(repr, found))
    if len(found) > 1:
        return f"{AUTOPILOT} is {shown}: which one it is nobody knows"
    if found and found[0] not in AUTOPILOTS:
        return f"{AUTOPILOT} is {shown}; known are {' and '.join(AUTOPILOTS)}"
    return ""
