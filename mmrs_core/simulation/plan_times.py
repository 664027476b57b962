"""The times of a plan as its behaviour is simulated to take."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.scene import Await, Branch, Plan, Recharge, RobotPlan, Serve, Signal, Step, all_steps

if TYPE_CHECKING:
    from mmrs_core.simulation.run import SimulatedRun
    from mmrs_core.transformation.engine import Trace
    from mmrs_runtime.records.steps import StepRecord

Key = TypeVar("Key")
Value = TypeVar("Value")

SAME = 0.01
"""Share by which a makespan may differ from the planner's and yet count as the same."""


def as_simulated(plan: Plan, run: SimulatedRun, trace: Trace, robots: Collection[RobotProgram]) -> Plan:
    """Return a plan with the times of a run of its behaviour.

    The planner allows for turns and searches that take as long as they can, and knows neither where robots
    look before a leg, nor how fast they still are. What is on an arm of a choice that was not taken keeps the
    planner's durations.
    """
    moves, spans = trace.moves(), _spans(run.records)
    own_moves, own_spans = _by_robot(moves), _by_robot(spans)
    timed = tuple(
        _timed(each, _Retiming(own_moves.get(each.robot, {}), own_spans.get(each.robot, {})))
        for each in plan.robots
    )
    served: dict[str, list[Step]] = {}
    for step in (step for each in timed for step in all_steps(each.steps) if isinstance(step, Serve)):
        served.setdefault(step.task, []).append(step)
    makespan = run.ending.time
    alike = abs(makespan - plan.makespan) <= SAME * plan.makespan
    return replace(
        plan,
        robots=timed,
        makespan=makespan,
        begins={**plan.begins, **{task: min(step.begin for step in own) for task, own in served.items()}},
        ends={**plan.ends, **{task: max(step.end for step in own) for task, own in served.items()}},
        lower_bound=min(plan.lower_bound, makespan) if alike else plan.lower_bound,
        planned=0.0 if alike else plan.makespan,
        notes=(*dict.fromkeys(_choices(run.records, robots)), *plan.notes),
    )


def _choices(records: Iterable[StepRecord], robots: Collection[RobotProgram]) -> Iterator[str]:
    """Yield what the times suppose of each condition."""
    asked = {
        (robot.id, robot.moves[index].id): transition.condition
        for robot in robots
        for index, transition in robot.transitions.items()
        if transition.condition is not None
    }
    for each in records:
        if each.label == "choose" and (each.robot, each.move) in asked:
            holds = "holds" if each.detail == "true" else "does not hold"
            yield f"times suppose that condition '{asked[each.robot, each.move]}' {holds}"


def _spans(records: Iterable[StepRecord]) -> Mapping[tuple[str, str], tuple[float, float]]:
    """Return when each move began and ended, its actions included, what is waited for after it not.

    A record tells when its step ended; the first of a move began with the record before it.
    """
    found: dict[tuple[str, str], tuple[float, float]] = {}
    latest: dict[str, float] = {}
    for each in records:
        before = latest.get(each.robot, 0.0)
        latest[each.robot] = each.time
        if each.label not in ("take", "choose"):
            begin, _ = found.get((each.robot, each.move), (before, each.time))
            found[each.robot, each.move] = begin, each.time
    return found


def _by_robot(given: Mapping[tuple[str, Key], Value]) -> dict[str, dict[Key, Value]]:
    """Return what is known of each robot."""
    found: dict[str, dict[Key, Value]] = {}
    for (robot, key), value in given.items():
        found.setdefault(robot, {})[key] = value
    return found


class _Retiming:
    """Gives the steps of a robot the times of the moves that carry them out.

    Args:
        moves: by the step's number, as `all_steps` counts.
        spans: when each move that was made began and ended.
    """

    def __init__(self, moves: Mapping[int, Sequence[str]], spans: Mapping[str, tuple[float, float]]) -> None:
        self._moves, self._spans = moves, spans
        self._count = 0

    def all(self, steps: Sequence[Step]) -> tuple[Step, ...]:
        """Return the steps of the robot; the last one ends when the robot has stopped."""
        timed = self.steps(steps)
        if not timed:
            return ()
        stopped = max(end for _, end in self._spans.values())
        return (*timed[:-1], replace(timed[-1], end=max(timed[-1].end, stopped)))

    def steps(self, steps: Iterable[Step], now: float = 0.0, *, taken: bool = True) -> tuple[Step, ...]:
        """Return steps that follow each other from a time on, in an arm that was taken or was not."""
        done: list[Step] = []
        for step in steps:
            timed = self._timed(step, now, taken=taken)
            if done and isinstance(done[-1], Await | Branch) and timed.begin > now:
                done[-1] = replace(done[-1], end=timed.begin)
            done.append(timed)
            now = timed.end
        return tuple(done)

    def _timed(self, step: Step, now: float, *, taken: bool) -> Step:
        made = self._made(self._count)
        self._count += 1
        otherwise = now if taken else now + step.end - step.begin
        if isinstance(step, Branch):
            return self._branch(step, now, otherwise)
        begin, end = (made[0][0], made[-1][1]) if made else (now, otherwise)
        if isinstance(step, Await) and step.until is not None:
            return replace(step, begin=begin, end=end, until=begin + step.until - step.begin)
        return replace(step, begin=begin, end=end)

    def _branch(self, step: Branch, now: float, end: float) -> Branch:
        """Return a choice that ends with the arm that was taken, or else at a time."""
        arms: list[tuple[str | None, tuple[Step, ...]]] = []
        for condition, arm in step.arms:
            first = self._count
            is_taken = any(map(self._made, range(first, first + sum(1 for _ in all_steps(arm)))))
            arms.append((condition, self.steps(arm, now, taken=is_taken)))
            if is_taken:
                end = arms[-1][1][-1].end
        return replace(step, begin=now, end=end, arms=tuple(arms))

    def _made(self, number: int) -> list[tuple[float, float]]:
        """Return when those of a step's moves that were made began and ended."""
        return [self._spans[move] for move in self._moves.get(number, ()) if move in self._spans]


def _timed(plan: RobotPlan, retiming: _Retiming) -> RobotPlan:
    """Return the plan of a robot with its times; its energy is power times its time away from home."""
    steps = retiming.all(plan.steps)
    busy = sum(_sorties(steps))
    energy = plan.energy * busy / plan.busy if plan.energy and plan.busy else plan.energy
    return replace(plan, steps=steps, busy=busy, energy=energy)


def _sorties(steps: Iterable[Step]) -> Iterator[float]:
    """Yield the seconds of each sortie: from when the robot leaves home until it is back."""
    away: list[Step] = []
    for step in steps:
        if isinstance(step, Recharge) and away:
            yield away[-1].end - away[0].begin
            away = []
        elif not isinstance(step, Await | Signal | Recharge):
            away.append(step)
    if away:
        yield away[-1].end - away[0].begin
