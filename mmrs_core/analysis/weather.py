"""Whether the weather lets robots hold their positions and operate."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of, number_of, type_of
from mmrs_core.analysis.states import GROUNDED, States, states_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged, not_checked
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene import Part

WIND_NAME = "wind"
TEMPERATURE_NAME = "temperature"


def _judge_wind(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    """Check the wind against positionHold: every flight ends in a landing, in which it must hold."""
    wind = input.environment.get("windSpeed")
    if wind is None:
        yield not_checked(WIND_NAME, robot, "the environment states no windSpeed")
        return
    robot_type = type_of(input, robot)
    held = number_of(robot_type.part, "positionHold")
    if held is None and not kinematics_of(input, robot).launches:
        yield not_checked(WIND_NAME, robot, "it does not fly")
        return
    hovers = _hovers(states_of(input, robot))
    if hovers is None:
        yield not_checked(WIND_NAME, robot, "it never leaves the ground")
    elif held is None:
        raise MissingFigureError(
            f"{robot.id}: the positionHold of robot type '{robot.type_name}' is not given"
        )
    else:
        move = robot.moves[hovers]
        words = f"{move.kind} '{move.id}' is in a wind of {wind:g} m/s, the robot holds against {held:g} m/s"
        yield from judged(WIND_NAME, robot, "m/s", [Margin(held - wind, hovers, words)])


def _hovers(states: States) -> int | None:
    """Return the first move that ends off the ground; None if there is none."""
    off = [move for move, after in states.after.items() if after != {GROUNDED}]
    return off[0] if off else None


def _judge_temperature(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    temperature = input.environment.get("temperature")
    if temperature is None:
        yield not_checked(TEMPERATURE_NAME, robot, "the environment states no temperature")
        return
    bounds = type_of(input, robot).part.attributes.get("operatingTemperature")
    least = number_of(bounds, "min") if isinstance(bounds, Part) else None
    most = number_of(bounds, "max") if isinstance(bounds, Part) else None
    if least is None or most is None:
        raise MissingFigureError(
            f"{robot.id}: the operatingTemperature of robot type '{robot.type_name}' is not given"
        )
    words = f"it is {temperature:g} °C, the robot operates from {least:g} to {most:g} °C"
    margin = Margin(min(temperature - least, most - temperature), None, words)
    yield from judged(TEMPERATURE_NAME, robot, "°C", [margin])


WIND = Check(
    name=WIND_NAME,
    title="The wind is no stronger than what flying robots can hold a position in.",
    run=for_each_robot(WIND_NAME, _judge_wind),
)
TEMPERATURE = Check(
    name=TEMPERATURE_NAME,
    title="The ambient temperature is one that the robots operate in.",
    run=for_each_robot(TEMPERATURE_NAME, _judge_temperature),
)
