"""Where two planned robots come too near to each other, and the refusal that says so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import dist, nan

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Launch, Plan, Position, Recover, RobotPlan, Serve, Transit


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two robots that may come too near to each other: when, to how many metres, and if one is at home.

    Attributes:
        pieces: of all that each robot takes up, the one on which that is first.
        distance: nan where it was not asked for.
    """

    first: str
    second: str
    time: float
    at_home: bool
    pieces: tuple[int, int]
    distance: float = nan


class TooNearError(InfeasibleError):
    """Robots cannot be kept apart.

    Attributes:
        at_home: whether one of those that come too near first stands at its home.
        robots: names of those two.
        short: metres by which they come too near.
    """

    def __init__(self, plan: Plan, conflict: Conflict, least: float, homes: Mapping[str, Position]) -> None:
        super().__init__(_words(plan, conflict, least, homes))
        self.at_home = conflict.at_home
        self.robots = frozenset((conflict.first, conflict.second))
        self.short = least - conflict.distance


def _words(plan: Plan, conflict: Conflict, least: float, homes: Mapping[str, Position]) -> str:
    robots = {each.robot: each for each in plan.robots}
    tasks = (_about(robots[name], conflict.time) for name in (conflict.first, conflict.second))
    doing = f" ({', '.join(words)})" if (words := [*filter(None, tasks)]) else ""
    at_home = ", one of them at its home" if conflict.at_home else ""
    apart = dist(homes[conflict.first], homes[conflict.second])
    where = f"{at_home} (their homes are {apart:.1f} m apart)" if apart < least else f"{doing}{at_home}"
    return (
        f"robots '{conflict.first}' and '{conflict.second}' come within {conflict.distance:.1f} m"
        f" after {conflict.time:.0f} s{where}, {least:g} m are required:"
        f" {least - conflict.distance:.1f} m short, and waiting did not help"
    )


def _about(robot: RobotPlan, time: float) -> str:
    """Return what a robot is about at a time; empty where it is at home or waits."""
    for step in robot.steps:
        if step.begin <= time <= step.end and isinstance(step, Launch | Transit | Serve | Recover):
            where = "at" if isinstance(step, Serve) else "going to"
            return f"'{robot.robot}' {where} '{step.task}'" if step.task else f"'{robot.robot}' going home"
    return ""
