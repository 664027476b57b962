"""How long planned robots run on one charge at most, as `Pilot` counts it, from the steps of their plans."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

from mmrs_core.planning.pacing import paced
from mmrs_core.planning.sorties import Pilot, waited
from mmrs_core.planning.timeline import Timeline, timelines_of
from mmrs_core.scene import (
    Await,
    Branch,
    Launch,
    Plan,
    Position,
    Recharge,
    Recover,
    RobotPlan,
    Serve,
    Signal,
    Step,
    Transit,
)
from mmrs_core.scene.timing import noticing

_SAME = 1e-6


def most_used(plan: Plan, pilots: Mapping[str, Pilot]) -> dict[str, float]:
    """Return the seconds that each robot runs on one charge at most, also if charging ends at once.

    Args:
        plan: of all robots.
        pilots: by name of robot.
    """
    found = _of_all(plan, pilots)
    return {name: max((used for used, _ in uses), default=0.0) for name, uses in found.items()}


def short_of_charge(plan: Plan, pilots: Mapping[str, Pilot]) -> set[str]:
    """Return the robots whose charge does not suffice for a sortie and for a diversion from where it ends."""
    found = _of_all(plan, pilots)
    return {
        name
        for name, uses in found.items()
        if any(used + more > pilots[name].charge + _SAME for used, more in uses)
    }


def _of_all(plan: Plan, pilots: Mapping[str, Pilot]) -> dict[str, list[tuple[float, float]]]:
    """Return, by robot and sortie, the seconds used and those that a diversion from its end takes longer."""

    def longest(robot: str, step: Step) -> float:
        return paced((step.stroke,), pilots[robot], 1)[0][1] if isinstance(step, Serve) else 0.0

    robots = {name: pilot.robot for name, pilot in pilots.items()}
    timelines = timelines_of(plan, robots, hasty=True, longest=longest)
    given = {
        step.signal: timelines[each.robot].moments[i + 1][1]
        for each in plan.robots
        for i, step in enumerate(each.steps)
        if isinstance(step, Signal)
    }
    return {
        each.robot: list(_uses(each, pilots[each.robot], timelines[each.robot], given))
        for each in plan.robots
    }


def _uses(
    plan: RobotPlan, pilot: Pilot, timeline: Timeline, given: Mapping[str, float]
) -> Iterator[tuple[float, float]]:
    launches, notices = pilot.kinematics.launches, noticing(pilot.kinematics.timing)
    used, before, since, here = pilot.fresh, 0.0, None if launches else 0.0, pilot.robot.home
    for step, ((early, late), (after, latest)) in zip(plan.steps, pairwise(timeline.moments), strict=True):
        if isinstance(step, Recharge):
            if not launches:
                yield used, pilot.diversion_more(here)
            used, before, since = 0.0, 0.0, None if launches else after
        elif isinstance(step, Launch):
            before, since = used, early
        if since is None or isinstance(step, Recharge):
            continue
        if isinstance(step, Await):
            held = 0.0 if step.until is None else max(0.0, step.until - step.begin)
            longest = 0.0 if step.until is None else held + notices
            release = max((given[signal] for signal in step.signals), default=0.0)
            used = waited(used + longest, before, since, early + held, release)
        else:
            used += latest - late
        here = _end_of(step, here)
        if launches and isinstance(step, Recover):
            since = None
            yield used, pilot.diversion_more(here)
    if not launches:
        yield used + pilot.stopping, pilot.diversion_more(here) - pilot.stopping


def _end_of(step: Step, here: Position) -> Position:
    """Return where a robot is after a step, before it comes down."""
    match step:
        case Transit():
            return step.route[-1]
        case Serve():
            return step.stroke.points[-1]
        case Branch():
            return step.exit
        case Recover():
            return step.at
        case _:
            return here
