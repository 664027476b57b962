"""Whether there is as much sunlight as the images that a behaviour takes of panels need."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.analysis.verdicts import Margin, UnknownMove, for_each_robot, judged
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene.attributes import finite
from mmrs_solar.names import IRRADIANCE

NAME = "irradiance"


def _judge(given: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    margins, gaps = [], []
    sunlight = given.environment.get("irradiance")
    for move, needed in _needs(robot):
        if needed is None:
            gaps.append(UnknownMove(move, f"its {IRRADIANCE} is not a number"))
        elif sunlight is None:
            gaps.append(
                UnknownMove(move, f"images need {needed:g} W/m², the environment states no irradiance")
            )
        else:
            words = f"images need {needed:g} W/m², the irradiance is {sunlight:g} W/m²"
            margins.append(Margin(sunlight - needed, move, words))
    yield from judged(NAME, robot, "W/m²", margins, gaps)


def _needs(robot: RobotProgram) -> Iterator[tuple[int, float | None]]:
    """Yield the index and the need of each move with such an action; None where it is not a number."""
    for index, move in enumerate(robot.moves):
        for action in (*move.before, *move.after):
            for key, value in action.parameters:
                if key == IRRADIANCE:
                    yield index, finite(value)


IRRADIANCE_CHECK = Check(
    NAME,
    "Images of panels are taken only in as much sunlight as their tasks ask for.",
    for_each_robot(NAME, _judge),
    hint="wait for more sun, and state the irradiance that is measured in the plane of the panels",
)
