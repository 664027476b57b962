"""How long planned robots run on one charge at most, as `Pilot` counts it, from the steps of their plans."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, pairwise
from math import inf

from mmrs_core.planning.corners import InMissions
from mmrs_core.planning.pacing import longest_of
from mmrs_core.planning.sorties import Pilot, waited
from mmrs_core.planning.timeline import Timeline, Timelines
from mmrs_core.planning.uploads import Uploads
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
from mmrs_core.scene.plans import all_steps
from mmrs_core.scene.timing import noticing

_SAME = 1e-6

_MOST_KNOWN = 100_000
"""Steps of which it is remembered how long they take."""

_MOST_WAYS = 16
"""Ways through choices that are looked at one by one."""


class Charges:
    """Asks of plans of the same robots what their charges suffice for."""

    def __init__(self, pilots: Mapping[str, Pilot]) -> None:
        """Make it.

        Args:
            pilots: by name of robot.
        """
        self._pilots = pilots
        robots = {name: pilot.robot for name, pilot in pilots.items()}
        self._timing = Timelines(robots, hasty=True, longest=self._longest)
        self._uploads, self._flown = Uploads(pilots), dict[int, InMissions]()
        self._known = dict[object, tuple[Step, float]]()

    def most_used(self, plan: Plan) -> dict[str, float]:
        """Return the seconds that each robot runs on one charge at most, also if charging ends at once."""
        found = self._of_ways(plan, self._pilots)
        return {name: max((used for used, _ in uses), default=0.0) for name, uses in found.items()}

    def short(self, plan: Plan, names: Collection[str] | None = None) -> set[str]:
        """Return the robots whose charge does not suffice for a sortie and a diversion from where it ends.

        Args:
            plan: of all robots.
            names: of those that are looked at; None: all.
        """
        return set(self._missing(plan, self._pilots if names is None else names))

    def missing(self, plan: Plan) -> float:
        """Return the part of a charge by which one does not suffice so, at most; 0: all do."""
        limited = [name for name, pilot in self._pilots.items() if pilot.charge < inf]
        found = self._missing(plan, limited) if limited else {}
        return max((more / self._allowed(name) for name, more in found.items()), default=0.0)

    def _missing(self, plan: Plan, names: Collection[str]) -> dict[str, float]:
        """Return the seconds by which charges do not suffice, by robot."""
        missing = {
            name: max((used + more - self._allowed(name) for used, more in uses), default=0.0)
            for name, uses in self._of_ways(plan, names).items()
        }
        return {name: more for name, more in missing.items() if more > _SAME}

    def _of_ways(self, plan: Plan, names: Collection[str]) -> dict[str, list[tuple[float, float]]]:
        """Return what `_of` does, also of charges in arms of choices."""
        ways = {each.robot: list(_ways(each)) for each in plan.robots if each.robot in names}
        found = dict(self._of(plan, [name for name, each in ways.items() if len(each) == 1]))
        for name, several in ways.items():
            for way in several if len(several) > 1 else ():
                others = (each for each in plan.robots if each.robot != name)
                found.setdefault(name, []).extend(
                    self._of(replace(plan, robots=(way, *others)), {name})[name]
                )
        return found

    def left(self, plan: Plan) -> dict[str, list[float]]:
        """Return, by robot, the seconds left of a charge at least after each flight, or at the end."""
        return {
            name: [self._allowed(name) - used - more for used, more in uses]
            for name, uses in self._of(plan, self._pilots).items()
        }

    def _allowed(self, robot: str) -> float:
        return self._pilots[robot].charge + self._pilots[robot].spare

    def _longest(self, robot: str, step: Step) -> float:
        if not isinstance(step, Transit | Serve):
            return 0.0
        what = (step.route, step.speed) if isinstance(step, Transit) else id(step.stroke)
        flown, pilot = self._flown.get(id(step), InMissions()), self._pilots[robot]
        key = robot, what, flown
        if key not in self._known:
            if len(self._known) >= _MOST_KNOWN:
                self._known.clear()
            if isinstance(step, Transit):
                longest = pilot.travel.going(step.route, step.speed, flown).longest
            else:
                longest = longest_of(step.stroke, pilot, flown)
            self._known[key] = step, longest
        return self._known[key][1]

    def _of(self, plan: Plan, names: Collection[str]) -> dict[str, list[tuple[float, float]]]:
        """Return, by robot and sortie, the seconds used and what a diversion from its end takes longer."""
        self._flown = {key: legs for each in plan.robots for key, legs in self._uploads.of(each).items()}
        timelines = self._timing.of(plan, names)
        given = {
            step.signal: timelines[each.robot].moments[i + 1][1]
            for each in plan.robots
            for i, step in enumerate(each.steps if each.robot in timelines else ())
            if isinstance(step, Signal)
        }
        return {
            each.robot: list(_uses(each, self._pilots[each.robot], timelines[each.robot], given))
            for each in plan.robots
            if each.robot in names
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


def _ways(plan: RobotPlan) -> Iterator[RobotPlan]:
    """Yield what a robot does by arms of the choices in which it is charged; as it is, where ways are many.

    What testing conditions takes is left out.
    """
    ways = list(islice(_sequences(plan.steps), _MOST_WAYS + 1))
    yield from (replace(plan, steps=each) for each in ways) if 1 < len(ways) <= _MOST_WAYS else (plan,)


def _sequences(steps: Sequence[Step]) -> Iterator[tuple[Step, ...]]:
    for at, step in enumerate(steps):
        if isinstance(step, Branch) and _charges_in(step):
            for _, arm in step.arms:
                yield from ((*steps[:at], *each) for each in _sequences((*arm, *steps[at + 1 :])))
            return
    yield tuple(steps)


def _charges_in(branch: Branch) -> bool:
    return any(isinstance(each, Recharge) for each in all_steps((branch,)))


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
