"""How rovers move: on the level of their home, in curves no narrower than their turning radius."""

from __future__ import annotations

from dataclasses import replace
from math import pi

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Kinematics, Robot, RobotType, Scene
from mmrs_core.scene.attributes import number, text
from mmrs_core.scene.timing import arcs
from mmrs_core.transformation.kinds import PLAIN_ROBOT, kinematics_for
from mmrs_rover.names import ROVER
from mmrs_rover.terrain import barrier

SHUNTING_PACE = 0.4
"""Metres per second at which a rover shunts, if it is not slower."""

SHARE_TURNED = 0.45
"""Share that a rover makes of the turn rate that is commanded then."""

HALT = 3.2
"""Seconds that speeding up and halting add to each arc.

An ArduRover 4.7-dev of a radius of 1.2 m in its own simulation took 11.0 s to turn by 45°, 13.8 s by 60° and
14.5 s by 75°, by which this was calibrated, 14 s by 56°, 21.9 s by 100°, 27 s by 125°, 30.2 s by 140° and
36 s by 168°; one of 2 m took 45 s by 135°.
"""


def kinematics(robot: Robot, scene: Scene) -> Kinematics:
    """Return what a rover can do: it stays on the level of its home, and needs room to turn.

    A rover that cannot turn on the spot comes round by arcs, forwards and backwards in turns, each as narrow
    as it can: together they are as long as the angle times the radius, and no point of them is further from
    where the rover stands than the radius, from three arcs on (Reeds and Shepp, "Optimal paths for a car that
    goes both forwards and backwards", 1990: curves of the sort C|C|C).

    Raises:
        InfeasibleError: the type does not define its narrowest curve, or has no capability for the
            robot's payload.
    """
    level = robot.home[2]
    known = kinematics_for(robot, scene, floor=level, ceiling=level)
    radius = turning_radius(robot.type)
    if radius == 0.0:
        return known
    pace = max(known.slowest, min(SHUNTING_PACE, known.cruise))
    half_turn = pi * radius / pace / SHARE_TURNED + arcs(180.0) * HALT
    rate = min(known.turn_rate, 180.0 / half_turn)
    return replace(known, turning_radius=radius, turn_rate=rate, halt=HALT)


def turning_radius(robot_type: RobotType) -> float:
    """Return the radius of the narrowest curve of a type, metres; tracks turn on the spot.

    Raises:
        InfeasibleError: the type is on wheels and does not say.
    """
    stated = number(robot_type.part, "turningRadius")
    if stated is None and text(robot_type.part, "drive") != "TRACKS":
        raise InfeasibleError(f"robot type '{robot_type.name}' does not say its turningRadius")
    return stated or 0.0


ROVER_KIND = replace(
    PLAIN_ROBOT, name="rover", metaclass=ROVER, kinematics=kinematics, barrier=barrier, vehicle="rover"
)
"""Like any robot that stays on its level it neither launches nor recovers; it answers faults alike."""
