"""The times of a plan as its behaviour is simulated to take."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from math import inf
from operator import itemgetter
from typing import TYPE_CHECKING

from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram
from mmrs_core.scene import Plan, RobotPlan

if TYPE_CHECKING:
    from mmrs_core.simulation.run import SimulatedRun
    from mmrs_core.transformation.engine import Trace
    from mmrs_runtime.records.steps import StepRecord

SAME = 0.01
"""Share by which times may differ that a bound of the planner is compared with."""

RECHARGE = (BEHAVIOUR, "Recharge")
AT_HOME = tuple((BEHAVIOUR, name) for name in ("Start", "Stop", "HoldPosition"))

NOT_SERVING = frozenset({"launch", "transit", "recover", "recharge", "wait", "choice", "notify"})


def as_simulated(plan: Plan, run: SimulatedRun, trace: Trace, robots: Collection[RobotProgram]) -> Plan:
    """Return a plan with the times of a run of its behaviour; its steps keep the planner's.

    The planner allows for turns and searches that take as long as they can, and knows neither where robots
    look before a leg, nor how fast they still are.
    """
    spans = _spans(run.records)
    tasks: dict[str, list[tuple[float, float]]] = {}
    for link in trace.links:
        if link.task in plan.begins and link.rule not in NOT_SERVING and (link.robot, link.move) in spans:
            tasks.setdefault(link.task, []).append(spans[link.robot, link.move])
    away = {robot.id: _away(robot, spans) for robot in robots}
    makespan = run.ending.time
    alike = abs(makespan - plan.makespan) <= SAME * plan.makespan
    return replace(
        plan,
        robots=tuple(_timed(each, away.get(each.robot, 0.0)) for each in plan.robots),
        makespan=makespan,
        begins={**plan.begins, **{task: min(begin for begin, _ in each) for task, each in tasks.items()}},
        ends={**plan.ends, **{task: max(end for _, end in each) for task, each in tasks.items()}},
        lower_bound=min(plan.lower_bound, makespan) if alike else 0.0,
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
    """Return when each move began, and when the last step of it was made, its actions included."""
    found: dict[tuple[str, str], tuple[float, float]] = {}
    for each in records:
        begin, _ = found.get((each.robot, each.move), (each.time, each.time))
        found[each.robot, each.move] = begin, each.time
    return found


def _away(robot: RobotProgram, spans: Mapping[tuple[str, str], tuple[float, float]]) -> float:
    """Return for how many seconds a robot is away from home: from the first move of a sortie to its last."""
    made = [(*spans[robot.id, move.id], move) for move in robot.moves if (robot.id, move.id) in spans]
    seconds, sortie = 0.0, (inf, -inf)
    for begin, end, move in sorted(made, key=itemgetter(0, 1)):
        if move.is_a(RECHARGE):
            seconds, sortie = seconds + max(0.0, sortie[1] - sortie[0]), (inf, -inf)
        elif not any(move.is_a(each) for each in AT_HOME):
            sortie = min(sortie[0], begin), end
    return seconds + max(0.0, sortie[1] - sortie[0])


def _timed(plan: RobotPlan, away: float) -> RobotPlan:
    """Return the plan of a robot that is away from home for so long; its energy is power times that."""
    if not plan.busy:
        return plan
    energy = None if plan.energy is None else plan.energy * away / plan.busy
    return replace(plan, busy=away, energy=energy)
