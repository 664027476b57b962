"""Keeps the robots of a plan apart by whatever costs least: waits, flight levels, signals or another team."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import ceil, inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.assembly import planned
from mmrs_core.planning.conflicts import TooNearError
from mmrs_core.planning.effort import Effort, SearchLimit
from mmrs_core.planning.exchanging import levelled
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.separation import (
    Traffic,
    distance_to_keep,
    recharges,
    separated,
    stacked_altitudes,
    starting_later,
)
from mmrs_core.planning.signalling import DEAR, TURNS, signalled
from mmrs_core.planning.team import Team
from mmrs_core.scene import Plan, Scene

_PARTS = (0.75, 0.5, 0.25)
"""Parts of a team that are tried where all of it together can only be kept apart at a cost."""

_SPARE = (0.15, 0.08)
"""Parts of each charge that are then kept for flying higher, where robots recharge."""

_WORTH_SIGNALS = 1.1
"""Times the mission time without separation from which on signals are sought beside levels."""

_TOO_DEAR = 1.2
"""Times the mission time without separation from which on signals are sought once more in the end."""

_MOST_SIGNALLED = 2
"""Plans, the shortest first, whose robots are then kept apart by signals, beside the shortest ones in which
fewer robots leave home; others only if there is no plan."""


def kept_apart(
    team: Team,
    jobs: Sequence[Job],
    decisions: Decisions,
    found: Plan,
    limit: SearchLimit,
    dear: list[tuple[Team, Plan]],
) -> Plan:
    """Return a plan as its robots keep apart: by waits, flight levels and signals, or by later starts.

    What is not better than the best so far is not sought any further.
    """
    made, refusal, turns = None, None, TURNS if limit.best is None else 0
    try:
        made = separated(team, found, limit)
        if made.makespan <= DEAR * found.makespan:
            return made
    except TooNearError as error:
        refusal = error
    levels = levelled(team, jobs, decisions, found, _beside(limit, made))
    other = levels is not None and levels.plan.robots != found.robots
    apart = _waiting(team, levels, _beside(limit, made), turns) if levels is not None and other else None
    if apart is not None:
        made = apart if made is None else better(apart, made)
    if not other if made is None else made.makespan > _WORTH_SIGNALS * found.makespan:
        made = signalled(team, found, _beside(limit, made), turns=turns) or made
    if made is None or made.makespan > _TOO_DEAR * found.makespan:
        dear.append((team, found))
    made = starting_later(team, decisions, partial(_planned_better, team, jobs, _beside(limit, made))) or made
    if made is None:
        raise refusal or InfeasibleError("no plan")
    return made


def _beside(limit: SearchLimit, made: Plan | None) -> SearchLimit:
    """Return what other plans must beat where one more is known."""
    return limit if made is None else replace(limit, best=better(made, limit.best))


def _waiting(team: Team, levels: Traffic, limit: SearchLimit, turns: int) -> Plan | None:
    """Return a plan in which robots wait where levels do not keep them apart; None if none is better."""
    if not levels.conflicts:
        return levels.plan
    made: Plan | None = None
    with suppress(TooNearError):
        made = separated(team, levels.plan, limit)
        if made.makespan <= DEAR * levels.plan.makespan:
            return made
    return signalled(team, levels.plan, _beside(limit, made), turns=turns) or made


def _planned_better(team: Team, jobs: Sequence[Job], limit: SearchLimit, decisions: Decisions) -> Plan | None:
    made = None if limit.over else planned(team, jobs, decisions)
    return None if made is None or better(made, limit.best) is limit.best else made


def alternatives(team: Team, found: Plan | None, error: TooNearError | None) -> Iterator[Team]:
    """Yield teams that may help where robots come too near.

    Robots may keep some of each charge for levels, transit one above the other, stay at home in part, keep
    away from where others stand at home, or end at home where they need not.
    """
    altitudes, least = stacked_altitudes(team.scene), distance_to_keep(team.scene)
    charging = any(
        each.kinematics.recharge is not None and each.charge < inf for each in team.pilots.values()
    )
    if charging if found is None else recharges(found):
        yield from (team.changed(team.homebound, spare=each) for each in _SPARE)
    if altitudes:
        yield team.changed(team.homebound, altitudes=altitudes)
    for smaller in _smaller(team, found) if found is not None else ():
        yield smaller
        if altitudes:
            yield smaller.changed(team.homebound, altitudes=altitudes)
    if error is None:
        return
    if error.at_home:
        yield team.changed(team.homebound, from_homes=least)
    before = team.scene.robots
    for names in dict.fromkeys((error.robots, frozenset(team.pilots))):
        robots = tuple(replace(robot, return_home=True) if robot.name in names else robot for robot in before)
        if robots != before:
            yield team.changed(None, robots=robots, from_homes=least)


def taking_turns(team: Team, error: TooNearError | None) -> Iterator[Team]:
    """Yield teams whose robots may keep apart if they fly one after the other; none where they do anyhow."""
    everyone = frozenset(team.pilots)
    if error is not None:
        yield team.changed(everyone)
        yield team.changed(everyone, from_homes=distance_to_keep(team.scene))


def _smaller(team: Team, found: Plan) -> Iterator[Team]:
    """Yield teams of which only those robots leave home that have most to do in a plan."""
    busiest = sorted((each for each in found.robots if each.steps), key=lambda each: -each.busy)
    for part in _PARTS:
        names = {each.robot for each in busiest[: ceil(part * len(busiest))]}
        smaller = team.at_home(frozenset(team.pilots) - names)
        if not any(smaller.shortfalls()):
            yield smaller


def unasked_returns(team: Team, other: Team, made: Plan) -> Iterator[str]:
    """Yield which robots return home in the plan of another team though the mission does not ask for it."""
    before = {robot.name: robot.return_home for robot in team.scene.robots}
    returning = {robot.name for robot in other.scene.robots if robot.return_home and not before[robot.name]}
    names = [each.robot for each in made.robots if each.robot in returning and each.steps]
    if names:
        ends = "returns home unasked" if len(names) == 1 else "return home unasked"
        yield f"{', '.join(names)} {ends}, so that robots on the ground keep apart"


def best_signalled(
    scene: Scene, dear: Iterable[tuple[Team, Plan]], found: Plan | None, effort: Effort
) -> Plan | None:
    """Return the best plan, or a better one in which robots wait for signals of each other to keep apart."""
    plans = {
        round(each.makespan, 1): (team, each) for team, each in dear if team.scene.robots == scene.robots
    }
    ordered = [plans[makespan] for makespan in sorted(plans)]
    first, rest = ordered[:_MOST_SIGNALLED], ordered[_MOST_SIGNALLED:]
    for pair in rest:
        if _number_out(pair[1]) < min(_number_out(each) for _, each in first):
            first.append(pair)
    last = [pair for pair in reversed(rest) if pair not in first]
    for tried, (team, each) in enumerate([*first, *last]):
        if found is not None and tried >= len(first):
            break
        told = signalled(team, each, SearchLimit(found, effort))
        found = found if told is None else better(told, found)
    return found


def _number_out(made: Plan) -> int:
    """Return how many robots leave home."""
    return sum(bool(each.steps) for each in made.robots)


def better(plan: Plan, best: Plan | None) -> Plan:
    """Return the plan that ends sooner, or in which robots are less busy; otherwise the best so far."""
    return plan if best is None or _cost(plan) < _cost(best) else best


def _cost(made: Plan) -> tuple[float, float]:
    """Return (makespan, seconds of all robots), rounded so that only a real gain counts."""
    return (round(made.makespan, 3), round(sum(each.busy for each in made.robots), 3))
