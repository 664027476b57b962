"""How long planned robots run on one charge at most, as `Pilot` counts it, from the steps of their plans."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

from mmrs_core.planning.pacing import paced
from mmrs_core.planning.sorties import Pilot, waited
from mmrs_core.planning.timeline import Timeline, timelines_of
from mmrs_core.scene import Await, Launch, Plan, Recharge, Recover, RobotPlan, Serve, Signal
from mmrs_core.scene.timing import noticing


def most_used(plan: Plan, pilots: Mapping[str, Pilot]) -> dict[str, float]:
    """Return the seconds that each robot runs on one charge at most, also if charging ends at once.

    Args:
        plan: of all robots.
        pilots: by name of robot.
    """
    timelines = timelines_of(plan, {name: pilot.robot for name, pilot in pilots.items()}, hasty=True)
    given = {
        step.signal: timelines[each.robot].moments[i + 1][1]
        for each in plan.robots
        for i, step in enumerate(each.steps)
        if isinstance(step, Signal)
    }
    return {
        each.robot: _most_used(each, pilots[each.robot], timelines[each.robot], given) for each in plan.robots
    }


def _most_used(plan: RobotPlan, pilot: Pilot, timeline: Timeline, given: Mapping[str, float]) -> float:
    launches, notices = pilot.kinematics.launches, noticing(pilot.kinematics.timing)
    used, most, before, since = pilot.fresh, 0.0, 0.0, None if launches else 0.0
    for step, ((early, late), (after, latest)) in zip(plan.steps, pairwise(timeline.moments), strict=True):
        if isinstance(step, Recharge):
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
        elif isinstance(step, Serve):
            ((_, seconds),) = paced((step.stroke,), pilot, 1)
            used += seconds
        else:
            used += latest - late
        most = max(most, used)
        if launches and isinstance(step, Recover):
            since = None
    return max(most, used + pilot.stopping)
