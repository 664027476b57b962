"""How underwater vehicles move: between the surface and the depth that their parts are rated for."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_auv.names import AUV_MOVEMENT, IN_WATER_SIZE, MOUNTING, THRUSTER, VEHICLE
from mmrs_core.contributions.rules import MoveSpec, RobotKind
from mmrs_core.contributions.samples import sample_type
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Kinematics, Part, Robot, RobotType, Scene
from mmrs_core.transformation.kinds import ROBOT, capability_for, kinematics_for, straight_travel

ATMOSPHERE = 101_325.0
"""Pressure at the surface, pascals."""

GRAVITY = 9.80665
"""Metres per second squared."""

SEA_WATER = 1025.0
"""Kilograms per cubic metre; stands in where the context does not state the density: in fresh water
the same pressure comes a little deeper, so nothing is risked."""


def kinematics(robot: Robot, scene: Scene) -> Kinematics:
    """Return what an underwater vehicle can do: between the surface and its largest depth.

    Raises:
        InfeasibleError: the type defines no rated depth, or not for that payload.
    """
    density = scene.environment.get("waterDensity", SEA_WATER)
    surface = scene.frame.surface
    deepest = largest_depth(robot.type, robot.payload, density)
    return kinematics_for(robot, scene, floor=surface - deepest, ceiling=surface, flow="currentSpeed")


def largest_depth(robot_type: RobotType, payload: float, density: float) -> float:
    """Return the depth in metres that every thruster and the hull withstand, in water of that density.

    Raises:
        InfeasibleError: neither thrusters nor hull have a figure, or none holds for that payload.
    """
    limits = [*_thruster_depths(robot_type, capability_for(robot_type, payload).part)]
    pressure = robot_type.part.attributes.get("maxOperatingPressure")
    if isinstance(pressure, (int, float)):
        limits.append((float(pressure) - ATMOSPHERE) / (density * GRAVITY))
    if not limits:
        raise InfeasibleError(f"robot type '{robot_type.name}' defines no maximum depth")
    return max(0.0, min(limits))


def thrusters_of(robot_type: RobotType, movement: Part) -> tuple[Part, ...]:
    """Return the thrusters by which a movement capability moves robots of a type, in its order."""
    held, used = robot_type.part.attributes.get("thrusters"), movement.attributes.get("thrusters")
    known = {each.attributes.get("id"): each for each in _listed(held) if isinstance(each, Part)}
    return tuple(known[each] for each in _listed(used) if isinstance(each, str) and each in known)


def _listed(value: object) -> tuple[object, ...]:
    return value if isinstance(value, tuple) else ()


def _thruster_depths(robot_type: RobotType, movement: Part) -> Iterator[float]:
    for thruster in thrusters_of(robot_type, movement):
        depth = thruster.attributes.get("maxDepth")
        if isinstance(depth, (int, float)):
            yield float(depth)


def _no_launch(height: float) -> tuple[MoveSpec, ...]:
    return ()


def _no_recovery() -> tuple[MoveSpec, ...]:
    return ()


MOVEMENT = ("urn:mmrs:robot:1.0", "MovementCapability")
PUSHES = {
    "T1": (0.3, 0.2, 1.0, 0.0),
    "T2": (0.3, -0.2, 1.0, 0.0),
    "T3": (0.3, 0.0, 0.0, 1.0),
    "T4": (-0.3, 0.0, 0.0, 1.0),
}
"""Thrusters of the sample type: metres forward and to starboard, and how they push ahead and down."""

SIZE = Part(
    (IN_WATER_SIZE,), {"length": 0.8, "width": 0.5, "height": 0.4, "weight": 30.0, "weightInWater": -0.3}
)


def _thruster(id: str, forward: float, starboard: float, ahead: float, down: float) -> Part:
    place = {"forward": forward, "starboard": starboard, "pushForward": ahead, "pushDown": down}
    mounting = Part((MOUNTING,), place)
    figures = {"operatingThrust": 20.0, "maxThrust": 40.0, "operatingPower": 90.0, "maxPower": 250.0}
    return Part((THRUSTER,), {"id": id, "maxDepth": 100.0, "mounting": mounting, **figures})


AUV_KIND = RobotKind(
    name="auv",
    metaclass=AUV_MOVEMENT,
    kinematics=kinematics,
    launch=_no_launch,
    recover=_no_recovery,
    travel=straight_travel,
    policies={
        # Radio does not reach under water: a lost link is the ordinary state of things there.
        "LINK_LOST": "CONTINUE",
        "PEER_LOST": "SURFACE",
        "BATTERY_LOW": "SURFACE",
        "WAIT_TOO_LONG": "SURFACE",
        "DEVICE_SILENT": "SURFACE",
        "POSITION_LOST": "SURFACE",
        "OBSTACLE": "SURFACE",
        "FENCE_BREACHED": "SURFACE",
        "VEHICLE_RESTARTED": "SURFACE",
        "LOG_FAILED": "SURFACE",
        "GROUND_LOST": "CONTINUE",
        "MOTOR_FAILED": "SURFACE",
    },
    vehicle="sub",
    medium="water",
    sample=sample_type(
        (VEHICLE, ROBOT),
        movement=Part((AUV_MOVEMENT, MOVEMENT), {"thrusters": tuple(PUSHES)}),
        attributes={"size": SIZE, "thrusters": tuple(_thruster(id, *each) for id, each in PUSHES.items())},
    ),
)
