"""Between which heights robots move, and how deep they dive."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from mmrs_core.analysis.figures import kinematics_of, type_of
from mmrs_core.analysis.motion import Leg, Motion, motions
from mmrs_core.analysis.states import states_of
from mmrs_core.analysis.verdicts import (
    TOLERANCE,
    Margin,
    for_each_robot,
    judged,
    not_checked,
    unknown,
)
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene.attributes import number

ALTITUDE_NAME = "altitude"
DEPTH_NAME = "depth"

ATMOSPHERE = 101_325.0
"""Pascals at the water surface: the standard atmosphere."""

GRAVITY = 9.80665
"""Metres per second squared: the standard acceleration of gravity."""

_OVER_LAND = (
    "it flies below the height of the water surface, over land as its type states no operating pressure"
)


def _judge_altitude(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    """Check floor and ceiling; moves that begin or end on the ground may go below the floor."""
    kinematics = kinematics_of(input, robot)
    floor, ceiling = kinematics.floor, kinematics.ceiling
    if not isfinite(floor) and not isfinite(ceiling):
        yield not_checked(ALTITUDE_NAME, robot, "its kind sets no limits of height")
        return
    states = states_of(input, robot)
    motion = motions(input)[robot.id]
    margins: list[Margin] = []
    for leg in motion.legs:
        move = robot.moves[leg.move]
        low, high = _lowest(leg), _highest(leg)
        if isfinite(ceiling):
            words = f"{move.kind} '{move.id}' goes up to {high:.2f} m, {ceiling:.2f} m is the ceiling"
            margins.append(Margin(ceiling - high, leg.move, words))
        if isfinite(floor) and not states.touches_ground(leg.move):
            words = f"{move.kind} '{move.id}' goes down to {low:.2f} m, {floor:.2f} m is the floor"
            margins.append(Margin(low - floor, leg.move, words))
    yield from judged(ALTITUDE_NAME, robot, "m", margins, motion.gaps)


def _judge_depth(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    """Check the pressure where robots go below the surface."""
    allowed = number(type_of(input, robot).part, "maxOperatingPressure")
    motion = motions(input)[robot.id]
    deepest = _deepest(motion, input.program.frame.surface)
    if deepest is None or deepest[0] <= TOLERANCE:
        yield from _above_water(robot, allowed, motion)
        return
    if allowed is None and kinematics_of(input, robot).launches:
        yield not_checked(DEPTH_NAME, robot, _OVER_LAND)
        return
    missing = _missing_for_depth(input, robot, allowed)
    density = input.environment.get("waterDensity")
    if missing or density is None or allowed is None:
        yield unknown(DEPTH_NAME, robot, f"{robot.id}: goes {deepest[0]:.2f} m under the surface, {missing}")
        return
    depth, index = deepest
    pressure = ATMOSPHERE + density * GRAVITY * depth
    move = robot.moves[index]
    words = (
        f"{move.kind} '{move.id}' goes to a depth of {depth:.2f} m and {pressure:.0f} Pa,"
        f" {allowed:.0f} Pa are allowed"
    )
    yield from judged(DEPTH_NAME, robot, "Pa", [Margin(allowed - pressure, index, words)], motion.gaps)


def _above_water(robot: RobotProgram, allowed: float | None, motion: Motion) -> Iterator[Verdict]:
    if allowed is None:
        yield not_checked(DEPTH_NAME, robot, "no known move leads under the surface")
    else:
        known = " known" if motion.gaps else ""
        margin = Margin(allowed - ATMOSPHERE, None, f"no{known} move leads under the surface")
        yield from judged(DEPTH_NAME, robot, "Pa", [margin], motion.gaps)


def _missing_for_depth(input: CheckInput, robot: RobotProgram, allowed: float | None) -> str:
    missing = []
    if allowed is None:
        missing.append(f"the maxOperatingPressure of robot type '{robot.type_name}'")
    if "waterDensity" not in input.environment:
        missing.append("the environment's waterDensity")
    return f"{' and '.join(missing)} not given" if missing else ""


def _deepest(motion: Motion, surface: float) -> tuple[float, int] | None:
    depths = ((surface - _lowest(leg), leg.move) for leg in motion.legs)
    return max(depths, key=lambda depth: depth[0], default=None)


def _lowest(leg: Leg) -> float:
    return min(point[2] for point in leg.points) - leg.radius


def _highest(leg: Leg) -> float:
    return max(point[2] for point in leg.points) + leg.radius


ALTITUDE = Check(
    name=ALTITUDE_NAME,
    title="Robots stay between the floor and the ceiling of their kind.",
    run=for_each_robot(ALTITUDE_NAME, _judge_altitude),
    hint="give the task or move another height, or choose a robot that flies there",
)
DEPTH = Check(
    name=DEPTH_NAME,
    title="Robots dive no deeper than the pressure allows that they operate in.",
    run=for_each_robot(DEPTH_NAME, _judge_depth),
    hint="lift the task or move, or choose a robot with a larger maxOperatingPressure",
)
