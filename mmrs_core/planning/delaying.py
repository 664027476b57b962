"""A plan in which a robot waits longer somewhere: all that follows, here and where others wait for it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from mmrs_core.errors import InternalError
from mmrs_core.planning.assembly import spans_of
from mmrs_core.planning.strokes import length_of
from mmrs_core.scene import (
    Await,
    Branch,
    Launch,
    Plan,
    Recharge,
    Recover,
    RobotPlan,
    Scene,
    Signal,
    Step,
    Transit,
)


def delayed(scene: Scene, plan: Plan, robot: str, waits: Mapping[int, float]) -> Plan:
    """Return the plan in which a robot waits longer before some of its steps: seconds, by index."""
    steps = {each.robot: each.steps for each in plan.robots}
    steps[robot] = tuple(_with_waits(steps[robot], waits))
    return retimed(scene, plan, steps)


def retimed(scene: Scene, plan: Plan, steps: Mapping[str, tuple[Step, ...]]) -> Plan:
    """Return the plan with other steps, by robot, each as soon as what it waits for."""
    timed = _timed(steps)
    robots = tuple(_changed(each, timed[each.robot]) for each in plan.robots)
    spans = spans_of(scene, timed)
    return replace(
        plan,
        robots=robots,
        makespan=max((each.steps[-1].end for each in robots if each.steps), default=0.0),
        begins={name: begin for name, (begin, _) in spans.items()},
        ends={name: end for name, (_, end) in spans.items()},
    )


def _with_waits(steps: Iterable[Step], waits: Mapping[int, float]) -> Iterator[Step]:
    """Yield the steps; what is waited for before one is added to a wait that comes just before."""
    last: Step | None = None
    for index, step in enumerate(steps):
        if index in waits:
            seconds = waits[index]
            if isinstance(last, Await) and last.until is not None and not last.signals:
                seconds += last.until - last.begin
                last = None
            if last is not None:
                yield last
            last = Await(step.begin, step.begin, step.task, (), step.begin + seconds)
        if last is not None:
            yield last
        last = step
    if last is not None:
        yield last


def _timed(steps: Mapping[str, tuple[Step, ...]]) -> dict[str, tuple[Step, ...]]:
    """Return the steps with their times, each as soon as what it waits for."""
    given: dict[str, float] = {}
    left = {name: list(reversed(each)) for name, each in steps.items()}
    done: dict[str, list[Step]] = {name: [] for name in steps}
    while any(left.values()):
        before = sum(map(len, left.values()))
        for name, rest in left.items():
            while rest and all(signal in given for signal in _awaited(rest[-1])):
                now = done[name][-1].end if done[name] else 0.0
                done[name].append(_at(rest.pop(), now, given))
        if sum(map(len, left.values())) == before:
            raise InternalError("robots of a plan wait for each other")
    return {name: tuple(each) for name, each in done.items()}


def _awaited(step: Step) -> tuple[str, ...]:
    return step.signals if isinstance(step, Await) else ()


def _at(step: Step, now: float, given: dict[str, float]) -> Step:
    """Return a step that begins now; a wait by the clock keeps its length, at least, and ends no earlier."""
    if isinstance(step, Await):
        until = None if step.until is None else max(step.until, now + max(0.0, step.until - step.begin))
        end = max([now if until is None else until, *(given[each] for each in step.signals)])
        return replace(step, begin=now, end=end, until=until)
    if isinstance(step, Signal):
        given[step.signal] = now
    later = now - step.begin
    if later == 0.0:
        return step
    if isinstance(step, Branch):
        arms = tuple(
            (condition, tuple(_at(inner, inner.begin + later, given) for inner in arm))
            for condition, arm in step.arms
        )
        return replace(step, begin=now, end=step.end + later, arms=arms)
    return replace(step, begin=now, end=step.end + later)


def _changed(before: RobotPlan, steps: tuple[Step, ...]) -> RobotPlan:
    """Return a robot's plan with other waits, which count where it is away from home, and other routes."""
    more, longer = (_away(steps) - _away(before.steps), _metres(steps) - _metres(before.steps))
    if more == longer == 0.0:
        return replace(before, steps=steps)
    busy = before.busy + more
    energy = before.energy * busy / before.busy if before.energy and before.busy else before.energy
    return replace(before, steps=steps, length=before.length + longer, busy=busy, energy=energy)


def _away(steps: Iterable[Step]) -> float:
    """Return the seconds between leaving home and being back."""
    seconds, away = 0.0, False
    for step in steps:
        away = away or not isinstance(step, Await | Signal | Recharge)
        seconds += away * (step.end - step.begin)
        away = away and not isinstance(step, Recover | Recharge)
    return seconds


def _metres(steps: Sequence[Step]) -> float:
    """Return how long ways are, up and down too."""
    upright = (abs(step.up - step.at[2]) for step in steps if isinstance(step, Launch | Recover))
    return sum(upright) + sum(length_of(step.route) for step in steps if isinstance(step, Transit))
