"""How long planned robots run on one charge at most, as `Pilot` counts it, from the steps of their plans."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from mmrs_core.planning.pacing import BESIDE, legs_beside, paced, passed_at_begin, passed_at_end
from mmrs_core.planning.sorties import Pilot, waited
from mmrs_core.planning.timeline import Timeline, Timelines, moves_along
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
    Stroke,
    Transit,
)
from mmrs_core.scene.timing import noticing

_SAME = 1e-6


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
        self._beside = dict[int, tuple[int, int]]()

    def most_used(self, plan: Plan) -> dict[str, float]:
        """Return the seconds that each robot runs on one charge at most, also if charging ends at once."""
        found = self._of(plan, self._pilots)
        return {name: max((used for used, _ in uses), default=0.0) for name, uses in found.items()}

    def short(self, plan: Plan, names: Collection[str] | None = None) -> set[str]:
        """Return the robots whose charge does not suffice for a sortie and a diversion from where it ends.

        Args:
            plan: of all robots.
            names: of those that are looked at; None: all.
        """
        return {
            name
            for name, uses in self._of(plan, self._pilots if names is None else names).items()
            if any(used + more > self._pilots[name].charge + _SAME for used, more in uses)
        }

    def _longest(self, robot: str, step: Step) -> float:
        if not isinstance(step, Serve):
            return 0.0
        beside = self._beside.get(id(step.stroke), BESIDE)
        return paced((step.stroke,), self._pilots[robot], 1, beside)[0][1]

    def _of(self, plan: Plan, names: Collection[str]) -> dict[str, list[tuple[float, float]]]:
        """Return, by robot and sortie, the seconds used and what a diversion from its end takes longer."""
        self._beside = {key: legs for each in plan.robots for key, legs in _legs_beside(each.steps)}
        timelines = self._timing.of(plan)
        given = {
            step.signal: timelines[each.robot].moments[i + 1][1]
            for each in plan.robots
            for i, step in enumerate(each.steps)
            if isinstance(step, Signal)
        }
        return {
            each.robot: list(_uses(each, self._pilots[each.robot], timelines[each.robot], given))
            for each in plan.robots
            if each.robot in names
        }


def _legs_beside(steps: Sequence[Step]) -> Iterator[tuple[int, tuple[int, int]]]:
    """Yield, by identity of each stroke, the legs before and after it that may continue it."""
    for i, step in enumerate(steps):
        if isinstance(step, Serve):
            before, after = _legs(reversed(steps[:i]), passed_at_end), _legs(steps[i + 1 :], passed_at_begin)
            yield id(step.stroke), (before, after)


def _legs(steps: Iterable[Step], passed: Callable[[Stroke], bool]) -> int:
    """Return the legs that steps begin with in one go."""
    moves = 0
    for step in steps:
        if not isinstance(step, Transit):
            return legs_beside(moves, isinstance(step, Serve) and passed(step.stroke))
        moves += len(list(moves_along(list(pairwise(step.route)))))
    return legs_beside(moves, passes=False)


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
