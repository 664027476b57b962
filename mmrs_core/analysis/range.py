"""How far robots go from their control stations, which stand at their homes."""

from __future__ import annotations

from collections.abc import Iterator
from math import dist

from mmrs_core.analysis.figures import MissingFigureError, home_of, type_of
from mmrs_core.analysis.motion import motions, points_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene.attributes import number

NAME = "range"


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    reach = number(type_of(input, robot).part, "communicationRange")
    if reach is None:
        raise MissingFigureError(
            f"{robot.id}: the communicationRange of robot type '{robot.type_name}' is not given"
        )
    home = home_of(robot)
    motion = motions(input)[robot.id]
    furthest: dict[int, float] = {}
    for leg, point in points_of(motion):
        # The distance to a point is convex along a leg, so that it is largest at a corner.
        away = dist(home, point) + leg.radius + input.program.position_error
        furthest[leg.move] = max(away, furthest.get(leg.move, 0.0))
    yield from judged(
        NAME, robot, "m", (_margin(robot, move, away, reach) for move, away in furthest.items()), motion.gaps
    )


def _margin(robot: RobotProgram, index: int, away: float, reach: float) -> Margin:
    move = robot.moves[index]
    words = f"{move.kind} '{move.id}' leads {away:.2f} m away from home, the radio reaches {reach:.2f} m"
    return Margin(reach - away, index, words)


RANGE = Check(
    name=NAME,
    title="Robots stay within the range of their radio, measured from home.",
    run=for_each_robot(NAME, _judge),
    hint="move the home nearer, or choose a robot with a larger communicationRange",
)
