"""Keeps robots apart by levels and signals: one goes above another, or waits until that is out of the way.

A wait by the clock must allow for how slow and how quick robots may be, and the more the later it is. A
signal ends a wait as soon as the other robot is out of the way. Where two robots come too near, one of them
waits before a move of its path until the other one begins a later move, as trains do on a single track; or
by the clock, where that costs less. So robots follow each other through corridors, and relays go home. Where
robots fly, one of them may go higher on that leg, as flights at other levels do that cross each other.
Such waits are those of job shops in which nothing is stored between machines (Mascis and Pacciarelli, 2002).
"""

from __future__ import annotations

from collections.abc import Collection, Generator, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from heapq import heappop, heappush
from itertools import accumulate, islice, pairwise
from math import dist, inf
from typing import TypeAlias

from mmrs_core.planning.delaying import delayed, retimed
from mmrs_core.planning.effort import UNLIMITED, SearchLimit
from mmrs_core.planning.separation import (
    Traffic,
    allowed,
    distance_to_keep,
    levels_above,
    may_wait,
    recharges,
)
from mmrs_core.planning.team import Team
from mmrs_core.planning.timeline import moves_along
from mmrs_core.planning.travel import kinematics_of
from mmrs_core.scene import Await, Launch, Plan, Position, Robot, RobotPlan, Scene, Signal, Step, Transit

Corner: TypeAlias = tuple[Position, Position, Position]

_Offers: TypeAlias = Generator[tuple[Plan, float], bool | None, None]
"""Yields plans, each with the step that is cut in it, and is sent whether they keep times and charges."""

_Known: TypeAlias = dict[tuple[tuple[RobotPlan, ...], float, bool], Traffic | None]
"""What becomes of plans with less than some seconds, with long legs cut or not."""

DEAR = 1.01
"""Times the mission time without separation from which on it is worth to try other means than waiting."""

_STEPS = 20_000
"""Steps of plans that are looked at, at most: one plan for each wait or level, at least one a conflict."""

_PLACES = 6
"""Steps back from where two robots meet that are tried to wait before."""

_SHORT, _LONG = 3.0, 10.0
"""Distances to keep before the end of a long leg at which a robot may wait."""

TURNS = 12
"""Times at most that a robot waits at home for another, though the two then meet no later than before."""

_ENDS = 8
"""Steps on from there of the other robot whose ends are tried to wait for."""


def signalled(
    team: Team, plan: Plan, limit: SearchLimit = UNLIMITED, *, higher: bool = True, turns: int = TURNS
) -> Plan | None:
    """Return the plan in which robots go at levels or wait so that all keep apart; None if none is found.

    Of the two robots that come too near first, that one does with which the mission ends sooner: it waits
    before legs of its path, or on long legs too, before the ends of these.

    Args:
        team: of the scene, with a minimum separation.
        plan: of the team.
        limit: what the plan must beat, and until when to seek.
        higher: whether a robot may fly higher, where no relay that has left could be out of its range.
        turns: times at most that a robot waits at home for another, though they meet no later then.
    """
    best: Plan | None = None
    known: _Known = {}
    for cut in (False, True):
        if limit.most > DEAR * plan.makespan:
            found = _signalled(team, plan, limit, known, cut=cut, higher=higher, turns=turns)
            best, limit = (best, limit) if found is None else (found, replace(limit, best=found))
    return best


def _signalled(
    team: Team, plan: Plan, limit: SearchLimit, known: _Known, *, cut: bool, higher: bool, turns: int
) -> Plan | None:
    least, timing = distance_to_keep(team.scene) or 0.0, team.timelines(hasty=recharges(plan))
    parts = _by_moves(team.scene, plan)
    traffic = Traffic(team.scene, parts, least, timing=timing, charges=team.charges)
    left = _STEPS
    while left > 0:
        if not traffic.conflicts:
            made = _joined(team.scene, traffic.plan, plan)
            return None if Traffic(team.scene, made, least, timing=timing).conflicts else made
        steps = sum(len(each.steps) for each in traffic.plan.robots)
        if limit.over or steps * len(traffic.conflicts) > left:
            break
        asked = traffic.plan.robots, limit.most, cut and _may_cut(traffic)
        if asked not in known:
            known[asked] = _further(team, traffic, limit, cut=cut, higher=higher)
        further = known[asked]
        if further is None and turns:
            turns -= 1
            further = _in_turn(team, traffic, limit)
        if further is None:
            break
        left -= steps
        traffic = further
    return None


def _cost(plan: Plan) -> tuple[float, float, float]:
    """Return (makespan, seconds until each robot is back, seconds away from home); less is better."""
    backs = sum(each.steps[-1].end for each in plan.robots if each.steps)
    return round(plan.makespan, 3), round(backs, 3), round(sum(each.busy for each in plan.robots), 3)


def _further(team: Team, traffic: Traffic, limit: SearchLimit, *, cut: bool, higher: bool) -> Traffic | None:
    """Return what becomes of the traffic if one of the two robots that meet first lets the other go first.

    What costs least is tried first, and taken if it keeps times and charges and the two come further; None
    if nothing does.
    """
    pairs = _first_two(traffic)
    before = {pair: _progress(traffic, *pair) for pair in pairs}
    asked = ((pair, _offers(team, traffic, *pair, cut=cut, higher=higher)) for pair in pairs)
    offers = [(pair, each) for pair, found in asked for each in found]
    waiting: list[tuple[tuple[float, float, float], int, Plan, float]] = []

    def ask(number: int, *, may: bool | None) -> None:
        """Put the next plan that a source offers, if it is soon enough, where it is to be tried."""
        with suppress(StopIteration):
            plan, halved = offers[number][1].send(may)
            while plan.makespan >= limit.most:
                plan, halved = offers[number][1].send(False)
            heappush(waiting, (_cost(plan), number, plan, halved))

    for number in range(len(offers)):
        ask(number, may=None)
    while waiting and not limit.over:
        _, number, plan, halved = heappop(waiting)
        pair, may = offers[number][0], allowed(team, traffic, plan)
        if may and _progress(traffic.with_plan(plan, pair), *pair, halved) > before[pair]:
            return traffic.with_plan(plan)
        ask(number, may=may)
    return None


def _in_turn(team: Team, traffic: Traffic, limit: SearchLimit) -> Traffic | None:
    """Return what becomes of the traffic if one of the two that meet first waits at home for the other.

    They may meet as early as before, where the other one sets out next: there it may be the one to wait.
    """
    plans = [
        _signalled_before(team.scene, traffic.plan, (early, end), (late, place))
        for early, late in _first_two(traffic)
        for place in _launches_before(traffic.steps(late), _place(traffic, early, late))
        for end in _ends_after(traffic, early, late)
        if traffic.knows(early, end).get(late, -1) < place
    ]
    soon = (plan for plan in sorted(plans, key=_cost) if plan.makespan < limit.most and not limit.over)
    return next((traffic.with_plan(plan) for plan in soon if allowed(team, traffic, plan)), None)


def _launches_before(steps: Sequence[Step], place: int) -> list[int]:
    """Return the last step up to a place with which a robot sets out from home, if there is one."""
    return [each for each in range(min(place, len(steps) - 1), -1, -1) if isinstance(steps[each], Launch)][:1]


def _ends_after(traffic: Traffic, early: str, late: str) -> list[int]:
    """Return the steps of a robot before which it can tell the other that it is out of the way."""
    told, over = traffic.steps(early), min(over for _, _, over in traffic.met(early, late))
    ends = (each for each in range(over, len(told) + 1) if not isinstance(told[each - 1], Await | Signal))
    return [*islice(ends, _ENDS)]


def _may_cut(traffic: Traffic) -> bool:
    """Return whether a robot may wait before the end of a long leg so that the two that meet first do not."""
    return any(any(_cuts(traffic, pair[1], _place(traffic, *pair))) for pair in _first_two(traffic))


def _first_two(traffic: Traffic) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return (early, late) robots of the earliest conflict, either way round."""
    conflict = traffic.earliest()
    return (conflict.first, conflict.second), (conflict.second, conflict.first)


def _place(traffic: Traffic, early: str, late: str) -> int:
    """Return the first step on which the later one of two robots meets the other."""
    return min(step for step, _, _ in traffic.met(early, late))


def _offers(
    team: Team, traffic: Traffic, early: str, late: str, *, cut: bool, higher: bool
) -> Iterator[_Offers]:
    """Yield how one robot may go above another, or wait for it: by the clock, at home or not, or a signal."""
    place = _place(traffic, early, late)
    if higher:
        yield _lifting(team, traffic, late, place)
    for at_home in (False, True):
        waits = traffic.waits(late, at_home=at_home, last=place)
        if waits is not None:
            yield _single(delayed(team.scene, traffic.plan, late, waits))
    yield _signalling(team.scene, traffic, early, late, cut=cut)


def _lifting(team: Team, traffic: Traffic, late: str, place: int) -> _Offers:
    """Yield plans in which a robot goes higher on one leg, by the distance to keep and multiples of it."""
    steps, travel = traffic.steps(late), team.pilots[late].travel
    step = steps[place] if place < len(steps) else None
    if not isinstance(step, Transit):
        return
    start, goal, highest = step.route[0], step.route[-1], max(up for _, _, up in step.route)
    levels = levels_above(traffic.least)
    for route in (each for higher in levels for each in travel.above(start, goal, higher)):
        if max(up for _, _, up in route) <= highest:
            continue
        seconds = travel.going(route, step.speed).expected
        lifted = replace(step, end=step.begin + seconds, route=route)
        others = {each.robot: each.steps for each in traffic.plan.robots}
        others[late] = (*steps[:place], lifted, *steps[place + 1 :])
        if not (yield retimed(team.scene, traffic.plan, others), inf):
            return


def _single(plan: Plan) -> _Offers:
    yield plan, inf


def _signalling(scene: Scene, traffic: Traffic, early: str, late: str, *, cut: bool) -> _Offers:
    """Yield plans in which one robot waits for the other, as near as it can and as briefly as may help."""
    last, ends = _place(traffic, early, late), _ends_after(traffic, early, late)
    for plan, place, halved in _waiting_places(scene, traffic, late, last, cut=cut):
        for end in ends:
            if traffic.knows(early, end).get(late, -1) >= place:
                break
            may = yield _signalled_before(scene, plan, (early, end), (late, place)), halved
            if not may:
                break


def _waiting_places(
    scene: Scene, traffic: Traffic, late: str, last: int, *, cut: bool
) -> Iterator[tuple[Plan, int, float]]:
    """Yield where a robot may wait: a plan, the step before which it does, and which step is cut for that.

    A long leg is cut shortly before its end, as at the end of a corridor.
    """
    steps = traffic.steps(late)
    for leg, away in _cuts(traffic, late, last) if cut else ():
        parts = _cut(scene.robot(late), leg, away)
        robots = (
            replace(each, steps=(*steps[:last], *parts, *steps[last + 1 :])) if each.robot == late else each
            for each in traffic.plan.robots
        )
        yield replace(traffic.plan, robots=tuple(robots)), last + 1, _places(steps)[last]
    places = [each for each in range(min(last, len(steps) - 1), -1, -1) if may_wait(steps[each])]
    yield from ((traffic.plan, place, inf) for place in places[:_PLACES])


def _cuts(traffic: Traffic, late: str, place: int) -> Iterator[tuple[Transit, float]]:
    """Yield a long leg and by how many metres before its end it may be cut; nothing for other steps."""
    steps = traffic.steps(late)
    step = steps[place] if place < len(steps) else None
    if isinstance(step, Transit) and len(step.route) == 2:
        for away in (_SHORT * traffic.least, _LONG * traffic.least):
            if dist(*step.route) > 2.0 * away:
                yield step, away


def _cut(robot: Robot, step: Transit, away: float) -> tuple[Transit, Transit]:
    """Return a leg in two, with a stop `away` metres before its end."""
    begin, end = step.route
    share, rates = away / dist(begin, end), kinematics_of(robot).rates(step.speed)
    east, north, up = (share * a + (1.0 - share) * b for a, b in zip(begin, end, strict=True))
    here = (east, north, up)
    middle = step.begin + rates.from_stop_to_stop(begin, here)
    after = middle + rates.from_stop_to_stop(here, end)
    return replace(step, end=middle, route=(begin, here)), replace(
        step, begin=middle, end=after, route=(here, end)
    )


def _progress(traffic: Traffic, early: str, late: str, cut: float = inf) -> tuple[float, float]:
    """Return how far the later one of two robots, and then the other, comes before they meet, in steps.

    The step of the later one that has been cut in two counts as one.
    """
    late_places, early_places = _places(traffic.steps(late)), _places(traffic.steps(early))
    met = ((late_places[step], early_places[other]) for step, other, _ in traffic.met(early, late))
    return min(((place - (place > cut), other) for place, other in met), default=(inf, inf))


def _places(steps: Sequence[Step]) -> list[int]:
    """Return, for each step and the end, how many steps before it are neither waits nor signals."""
    places = [0]
    for step in steps:
        places.append(places[-1] + (not isinstance(step, Await | Signal)))
    return places


def _signalled_before(scene: Scene, plan: Plan, early: tuple[str, int], late: tuple[str, int]) -> Plan:
    """Return the plan in which one robot waits before a step until another one begins one of its steps.

    Args:
        early, late: name of the robot, and index of its step.
    """
    (sender, end), (receiver, place) = early, late
    steps = {each.robot: [*each.steps] for each in plan.robots}
    told, waiting = steps[sender], steps[receiver]
    name = _signal_name(plan, sender, receiver)
    time = told[end - 1].end
    told.insert(end, Signal(time, time, told[end - 1].task, name, (receiver,)))
    last = waiting[place - 1] if place else None
    if isinstance(last, Await) and last.until is None:
        superseded = {each.signal for each in told if isinstance(each, Signal)} & set(last.signals)
        superseded = {each for each in superseded if each.startswith(f"{sender}{_CLEAR}")}
        kept = tuple(each for each in last.signals if each not in superseded)
        waiting[place - 1] = replace(last, signals=(*kept, name))
        steps[sender] = [
            each for each in told if not (isinstance(each, Signal) and each.signal in superseded)
        ]
    else:
        begin = waiting[place].begin
        waiting.insert(place, Await(begin, begin, waiting[place].task, (name,)))
    return retimed(scene, plan, {robot: tuple(each) for robot, each in steps.items()})


_CLEAR = " clear of "


def _signal_name(plan: Plan, sender: str, receiver: str) -> str:
    """Return a name for a signal that is unique in a plan."""
    known = {step.signal for each in plan.robots for step in each.steps if isinstance(step, Signal)}
    name, number = f"{sender}{_CLEAR}{receiver}", 1
    while name in known:
        number += 1
        name = f"{sender}{_CLEAR}{receiver} {number}"
    return name


def _by_moves(scene: Scene, plan: Plan) -> Plan:
    """Return the plan with a step for each move of a transit, so that robots can wait and signal there."""
    parts = {each.robot: tuple(_parts(scene.robot(each.robot), each.steps)) for each in plan.robots}
    return retimed(scene, plan, parts)


def _parts(robot: Robot, steps: Iterable[Step]) -> Iterator[Step]:
    for step in steps:
        moves = list(moves_along(list(pairwise(step.route)))) if isinstance(step, Transit) else []
        if not isinstance(step, Transit) or len(moves) < 2:
            yield step
            continue
        rates = kinematics_of(robot).rates(step.speed)
        seconds = [sum(rates.from_stop_to_stop(*leg) for leg in pairwise(points)) for points in moves]
        share = (step.end - step.begin) / sum(seconds)
        times = [step.begin + share * each for each in accumulate(seconds, initial=0.0)]
        for points, (begin, end) in zip(moves, pairwise(times), strict=True):
            yield replace(step, begin=begin, end=end, route=points)


def _joined(scene: Scene, plan: Plan, before: Plan) -> Plan:
    """Return the plan with moves of one transit in one step again, where nothing is between them."""
    whole = _routes(_by_moves(scene, before))
    alone = {route for route in _routes(plan) - whole if len(route) > 2}
    steps = {}
    for each, old in zip(plan.robots, before.robots, strict=True):
        joints = {_corner(*pair) for pair in pairwise(old.steps)}
        steps[each.robot] = tuple(_in_one(each.steps, joints, alone))
    return retimed(scene, plan, steps)


def _routes(plan: Plan) -> set[tuple[Position, ...]]:
    return {step.route for each in plan.robots for step in each.steps if isinstance(step, Transit)}


def _in_one(
    steps: Iterable[Step], joints: Collection[Corner | None], alone: Collection[tuple[Position, ...]]
) -> Iterator[Step]:
    """Yield the steps, transits in one but where others met, and but those on routes that stay alone."""
    last: Step | None = None
    for step in steps:
        corner = None if last is None else _corner(last, step)
        if corner is not None and corner not in joints:
            assert isinstance(last, Transit)
            assert isinstance(step, Transit)
            if last.route not in alone and step.route not in alone:
                last = replace(last, end=step.end, route=(*last.route, *step.route[1:]))
                continue
        if last is not None:
            yield last
        last = step
    if last is not None:
        yield last


def _corner(one: Step, two: Step) -> Corner | None:
    """Return where one transit leads on to another: places before, at and after; None: nowhere."""
    if not (isinstance(one, Transit) and isinstance(two, Transit) and one.task == two.task):
        return None
    return one.route[-2], two.route[0], two.route[1]
