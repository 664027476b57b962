"""The operating envelope of robots: altitude, depth, wind and temperature."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of, type_of
from mmrs_core.analysis.motion import Motion, MovePath, motions
from mmrs_core.analysis.states import GROUNDED, States, possible_states, states_of
from mmrs_core.analysis.verdicts import TOLERANCE, Margin, for_each_robot, judged, not_checked, unknown
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Part
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
    for leg in motion.paths:
        move = robot.moves[leg.move]
        low, high = _lowest(leg), _highest(leg)
        if isfinite(ceiling):
            reached, limit = lengths(high, ceiling)
            words = f"{move.kind} '{move.id}' goes up to {reached}, {limit} is the ceiling"
            margins.append(Margin(ceiling - high, leg.move, words))
        if isfinite(floor) and not states.touches_ground(leg.move):
            reached, limit = lengths(low, floor)
            words = f"{move.kind} '{move.id}' goes down to {reached}, {limit} is the floor"
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
    if allowed < pressure <= allowed + density * GRAVITY * TOLERANCE:
        pressure = allowed
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
    depths = ((surface - _lowest(leg), leg.move) for leg in motion.paths)
    return max(depths, key=lambda depth: depth[0], default=None)


def _lowest(leg: MovePath) -> float:
    return min(point[2] for point in leg.points) - leg.radius


def _highest(leg: MovePath) -> float:
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


WIND_NAME = "wind"
TEMPERATURE_NAME = "temperature"


def _judge_wind(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    """Check the wind against what the robot holds: every flight ends in a landing, in which it must hold."""
    robot_type = type_of(input, robot)
    kind = robot_kind_of(robot_type, input.robot_kinds)
    attribute = kind.position_hold if kind is not None else ""
    held = number(robot_type.part, attribute)
    if held is None and not kinematics_of(input, robot).launches:
        yield not_checked(WIND_NAME, robot, "it does not fly")
        return
    wind = input.environment.get("windSpeed")
    try:
        hovers = _hovers(states_of(input, robot))
    except MissingFigureError:
        hovers = _certainly_hovers(possible_states(input, robot))
        if hovers is not None and wind is not None and held is not None and held < wind:
            yield from judged(WIND_NAME, robot, "m/s", [_held_against(wind, held, robot, hovers)])
        raise
    if hovers is None:
        yield not_checked(WIND_NAME, robot, "it never leaves the ground")
    elif wind is None:
        limit = "" if held is None else f", the robot holds against {held:g} m/s"
        yield not_checked(WIND_NAME, robot, f"the environment states no windSpeed{limit}")
    elif held is None:
        raise MissingFigureError(
            f"{robot.id}: the {attribute or 'wind limit'} of robot type '{robot.type_name}' is not given"
        )
    else:
        yield from judged(WIND_NAME, robot, "m/s", [_held_against(wind, held, robot, hovers)])


def _held_against(wind: float, held: float, robot: RobotProgram, hovers: int) -> Margin:
    move = robot.moves[hovers]
    words = f"{move.kind} '{move.id}' is in a wind of {wind:g} m/s, the robot holds against {held:g} m/s"
    return Margin(held - wind, hovers, words)


def _hovers(states: States) -> int | None:
    off = [move for move, after in states.after.items() if after != {GROUNDED}]
    return off[0] if off else None


def _certainly_hovers(states: States) -> int | None:
    """Return the first move that ends off the ground whatever state the robot began in, or None."""
    return next((move for move, after in states.after.items() if GROUNDED not in after), None)


def _judge_temperature(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    bounds = type_of(input, robot).part.attributes.get("operatingTemperature")
    least = number(bounds, "min") if isinstance(bounds, Part) else None
    most = number(bounds, "max") if isinstance(bounds, Part) else None
    known = least is not None and most is not None
    operates = f"the robot operates from {least:g} to {most:g} °C" if known else ""
    temperature = input.environment.get("temperature")
    if temperature is None:
        limit = f", {operates}" if known else ""
        yield not_checked(TEMPERATURE_NAME, robot, f"the environment states no temperature{limit}")
    elif least is None or most is None:
        raise MissingFigureError(
            f"{robot.id}: the operatingTemperature of robot type '{robot.type_name}' is not given"
        )
    else:
        words = f"it is {temperature:g} °C, {operates}"
        margin = Margin(min(temperature - least, most - temperature), None, words)
        yield from judged(TEMPERATURE_NAME, robot, "°C", [margin])


WIND = Check(
    name=WIND_NAME,
    title="The wind is not stronger than what flying robots can hold a position in.",
    run=for_each_robot(WIND_NAME, _judge_wind),
    hint="wait for calmer weather, or choose a robot that holds its position in more wind",
)
TEMPERATURE = Check(
    name=TEMPERATURE_NAME,
    title="The ambient temperature is one that the robots operate in.",
    run=for_each_robot(TEMPERATURE_NAME, _judge_temperature),
    hint="choose another day, or a robot with a wider operatingTemperature",
)
