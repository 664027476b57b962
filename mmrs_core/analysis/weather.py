"""Whether the weather lets robots hold their positions and operate."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of, type_of
from mmrs_core.analysis.states import GROUNDED, States, possible_states, states_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged, not_checked
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene import Part
from mmrs_core.scene.attributes import number

WIND_NAME = "wind"
TEMPERATURE_NAME = "temperature"


def _judge_wind(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    """Check the wind against positionHold: every flight ends in a landing, in which it must hold."""
    held = number(type_of(input, robot).part, "positionHold")
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
            f"{robot.id}: the positionHold of robot type '{robot.type_name}' is not given"
        )
    else:
        yield from judged(WIND_NAME, robot, "m/s", [_held_against(wind, held, robot, hovers)])


def _held_against(wind: float, held: float, robot: RobotProgram, hovers: int) -> Margin:
    move = robot.moves[hovers]
    words = f"{move.kind} '{move.id}' is in a wind of {wind:g} m/s, the robot holds against {held:g} m/s"
    return Margin(held - wind, hovers, words)


def _hovers(states: States) -> int | None:
    """Return the first move that ends off the ground; None if there is none."""
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
    title="The wind is no stronger than what flying robots can hold a position in.",
    run=for_each_robot(WIND_NAME, _judge_wind),
    hint="wait for calmer weather, or choose a robot with a larger positionHold",
)
TEMPERATURE = Check(
    name=TEMPERATURE_NAME,
    title="The ambient temperature is one that the robots operate in.",
    run=for_each_robot(TEMPERATURE_NAME, _judge_temperature),
    hint="go on another day, or choose a robot whose operatingTemperature has room",
)
