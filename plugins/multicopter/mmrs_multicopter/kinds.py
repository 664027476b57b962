"""How multicopters move: figures for planning, launch and landing, and what each move does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_core.contributions.rules import MoveKind, MoveSpec, RobotKind
from mmrs_core.contributions.samples import sample_type
from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.ground import ground_height
from mmrs_core.transformation.kinds import ROBOT, kinematics_for, path_seconds
from mmrs_multicopter import trajectories
from mmrs_multicopter.names import DRONE, GO_TO, LAND, TAKE_OFF

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move
    from mmrs_core.scene import Kinematics, Position, Robot, Scene
    from mmrs_core.scene.timing import MoveSeconds

LOWEST_FLIGHT = 1.0
"""Metres above home below which a drone only launches and lands."""

SPIN_UP = 5.0
"""Seconds from the command to take off until the drone climbs."""

TOUCH_DOWN = 5.0
"""Seconds from touching the ground until the motors stand still."""


def kinematics(robot: Robot, scene: Scene) -> Kinematics:
    """Return what a drone can do: between 1 m and its largest altitude above home.

    Raises:
        InfeasibleError: the type does not define the drone's largest altitude, or not for that payload.
    """
    highest = robot.type.part.attributes.get("maxAltitude")
    if not isinstance(highest, (int, float)):
        raise InfeasibleError(f"robot type '{robot.type.name}' does not say its maxAltitude")
    return kinematics_for(
        robot,
        scene,
        floor=robot.home[2] + LOWEST_FLIGHT,
        ceiling=robot.home[2] + float(highest),
        launch=SPIN_UP,
        recovery=TOUCH_DOWN,
        launches=True,
        flow="windSpeed",
    )


def launch(height: float) -> tuple[MoveSpec, ...]:
    """Return the take-off to a height in metres above home."""
    return (MoveSpec(TAKE_OFF, {"altitude": height}),)


def recover() -> tuple[MoveSpec, ...]:
    """Return the landing where the drone is."""
    return (MoveSpec(LAND),)


def take_off_path(move: Move, here: Position, home: Position | None) -> tuple[Position, ...]:
    """Return the way straight up to the move's altitude above where the drone stands."""
    altitude = move.attributes.get("altitude")
    climb = float(altitude) if isinstance(altitude, (int, float)) else 0.0
    return (here, (here[0], here[1], here[2] + climb))


def land_path(move: Move, here: Position, home: Position | None) -> tuple[Position, ...]:
    """Return the way straight down to the ground."""
    return (here, (here[0], here[1], ground_height(here, home)))


def take_off_seconds(
    move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str
) -> MoveSeconds:
    """Return the duration of spinning up and climbing."""
    return kinematics.upright_bounds(kinematics.launching(path[-1][2] - path[0][2]))


def land_seconds(move: Move, path: tuple[Position, ...], kinematics: Kinematics, mode: str) -> MoveSeconds:
    """Return the duration of descending, slowly near the ground, and stopping the motors."""
    return kinematics.upright_bounds(kinematics.landing(path[0][2] - path[-1][2]))


MULTICOPTER_KIND = RobotKind(
    name="multicopter",
    metaclass=DRONE,
    kinematics=kinematics,
    launch=launch,
    recover=recover,
    travel=trajectories.travel,
    policies={
        "LINK_LOST": "RETURN",
        "PEER_LOST": "RETURN",
        "BATTERY_LOW": "RETURN",
        "WAIT_TOO_LONG": "RETURN",
        "DEVICE_SILENT": "RETURN",
        "POSITION_LOST": "LAND",
        "OBSTACLE": "HOLD",
        "FENCE_BREACHED": "RETURN",
        "VEHICLE_RESTARTED": "HOLD",
        "LOG_FAILED": "RETURN",
        "GROUND_LOST": "CONTINUE",
        "MOTOR_FAILED": "LAND",
    },
    vehicle="copter",
    medium="air",
    position_hold="positionHold",
    sample=sample_type((DRONE, ROBOT), attributes={"maxAltitude": 120.0}),
)

MOVE_KINDS = (
    MoveKind(TAKE_OFF, take_off_path, take_off_seconds, frozenset({"grounded"}), "airborne", "take_off"),
    MoveKind(LAND, land_path, land_seconds, frozenset({"airborne"}), "grounded", "land"),
    MoveKind(GO_TO, trajectories.path, path_seconds, frozenset({"airborne"}), manoeuvre="go_to"),
)
