"""How robots wait for those that are relays, and relays for them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, dist, floor

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.bounds import least_makespan
from mmrs_core.planning.conflicts import TooNearError
from mmrs_core.planning.delaying import retimed
from mmrs_core.planning.effort import SearchLimit
from mmrs_core.planning.jobs import jobs_of
from mmrs_core.planning.materials import allowed_by_charge, kept_of_charge
from mmrs_core.planning.positions import SLACK
from mmrs_core.planning.reach import Reach, reach_of, unsure
from mmrs_core.planning.remedies import lifetime_of
from mmrs_core.planning.separation import separated
from mmrs_core.planning.signalling import signalled
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import length_of
from mmrs_core.planning.team import Team
from mmrs_core.planning.time_remedies import for_times
from mmrs_core.scene import (
    Await,
    Launch,
    Plan,
    Position,
    Recover,
    Robot,
    RobotPlan,
    Scene,
    Serve,
    Signal,
    Step,
    Stroke,
    Transit,
    all_steps,
)
from mmrs_core.scene.relays import Relay, relays_of

_WORTH = 3.0
"""Seconds from which on the rest of a path home is worth a stop where a robot is back in range."""

_INSIDE = 1.0
"""Metres that it must be inside of its range by then."""

_CLOSE = 0.1
"""Metres within which it is found where a robot is back in range."""

_STAYS = "stay"
"""Rule of the move with which a stay ends."""


@dataclass(frozen=True, slots=True)
class Stay:
    """A robot that is to be a relay, the task for which it is one, and the relay that it is."""

    task: str
    robot: Robot
    station: Relay


class Joining:
    """Joins the plans of relays with that of the others."""

    def __init__(self, scene: Scene, placed: Sequence[Stay], plans: Mapping[str, Plan], rest: Plan) -> None:
        self._scene, self._placed, self._rest = scene, placed, rest
        self._own = relays_of(scene.elements)
        every = {each.robot: each for one in (rest, *plans.values()) for each in one.robots}
        self._robots = [every[robot.name] for robot in scene.robots]
        self._notes = tuple(dict.fromkeys(note for one in (rest, *plans.values()) for note in one.notes))

    def plan(self) -> Plan:
        """Return the plan of all.

        Raises:
            InfeasibleError: a charge does not suffice, a time is not kept, robots come too near to each
                other, or one ends where it needs a relay.
        """
        needs = {each.robot: need for each in self._robots if (need := self._need(each)) is not None}
        idle = [stay for stay in self._placed if not any(stay in need.relays for need in needs.values())]
        notes = [f"no robot needs '{stay.robot.name}' as relay '{stay.task}'" for stay in idle]
        whole = Plan(tuple(self._robots), 0.0, {}, {}, (*notes, *self._notes), left_out=self._rest.left_out)
        team = Team(replace(self._scene, stations=tuple(stay.station for stay in self._placed)))
        made = self._kept_apart(team, whole, needs)
        self._refuse_short(team, made, needs)
        spans = {task: (begin, made.ends[task]) for task, begin in made.begins.items()}
        if late := [*for_times(team, (), spans)]:
            raise InfeasibleError(f"no plan keeps all times: {late[0]}", late)
        return replace(made, lower_bound=self._least(team))

    def _kept_apart(self, team: Team, whole: Plan, needs: Mapping[str, _Need]) -> Plan:
        """Return the plan with all waits, in which robots keep apart.

        The relays leave in time, and go home as soon as they may; of robots that would come too near, one
        waits by the clock or for a signal of the other. Where that does not help, relays leave first of all,
        and wait for all to be home. What charges do not suffice for anyway is refused for that.
        """
        soonest = retimed(self._scene, whole, self._steps(team, needs, in_turns=False))
        apart: Plan | None = None
        with suppress(TooNearError):
            apart = separated(team, soonest)
        told = signalled(team, soonest, SearchLimit(apart), higher=False)
        found = apart if told is None else told
        if found is not None:
            return found
        try:
            return separated(team, retimed(self._scene, whole, self._steps(team, needs, in_turns=True)))
        except TooNearError:
            self._refuse_short(team, soonest, needs)
            raise

    def _steps(
        self, team: Team, needs: Mapping[str, _Need], *, in_turns: bool
    ) -> dict[str, tuple[Step, ...]]:
        """Return what robots do, with their waits.

        Args:
            team: of all.
            needs: by robot.
            in_turns: whether relays leave first of all, and not in time only, and stay until the others are
                home, not only back in range.
        """
        steps = {
            each.robot: self._waiting(
                team.pilots[each.robot], each.steps, needs.get(each.robot), at_once=not in_turns
            )
            for each in self._robots
        }
        needed = {name: self._plan_of(name).steps[need.begin].begin for name, need in needs.items()}
        for stay in reversed(self._placed):
            name = stay.robot.name
            users = [user for user, need in needs.items() if stay in need.relays]
            start = 0.0
            if not in_turns:
                start = self._start(stay, min((needed[user] for user in users), default=0.0))
            if name in needed:
                needed[name] += start
            idle = Await(0.0, start, stay.task, (), start)
            staying = _staying(steps[name], stay, users)
            steps[name] = (idle, *staying) if start > 0.0 else tuple(staying)
        return steps

    def _plan_of(self, name: str) -> RobotPlan:
        return next(each for each in self._robots if each.robot == name)

    def _start(self, stay: Stay, needed: float) -> float:
        """Return the whole seconds after which a relay leaves so as to be at its place when it is needed."""
        steps = self._plan_of(stay.robot.name).steps
        there = next(step.end for step in steps if isinstance(step, Serve) and step.last)
        return float(max(0, floor(needed - there)))

    def _least(self, team: Team) -> float:
        """Return a time that no plan's falls below: all robots do the other tasks, and relays are there."""
        tasks = {stay.task for stay in self._placed}
        jobs = [job for job in jobs_of(self._scene) if job.name not in tasks]
        return least_makespan(team, jobs) if any(job.tasks() for job in jobs) else 0.0

    def _need(self, plan: RobotPlan) -> _Need | None:
        """Return which relays a robot needs, and when; None: none ever."""
        robot, error = self._scene.robot(plan.robot), self._scene.position_error
        own = reach_of(robot, self._own, error)
        if own is None:
            return None
        outside = [i for i, step in enumerate(plan.steps) if not _covers(own, step)]
        if not outside:
            return None
        names = [stay.robot.name for stay in self._placed]
        before = names.index(plan.robot) if plan.robot in names else len(names)
        relays = list(self._placed[:before])
        for stay in self._placed[:before]:
            fewer = [each for each in relays if each is not stay]
            reach = reach_of(robot, (*self._own, *(each.station for each in fewer)), error)
            if reach is not None and all(_covers(reach, plan.steps[i]) for i in outside):
                relays = fewer
        last = outside[-1]
        if not own.contains([_end_of(plan.steps[last])]):
            words = " and ".join(f"'{each.task}'" for each in relays)
            raise InfeasibleError(
                f"no plan: robot '{plan.robot}' ends where its radio needs the relay {words}, which could"
                " never go home; let it return home"
            )
        launches = [i for i in range(outside[0] + 1) if isinstance(plan.steps[i], Launch)]
        return _Need(tuple(relays), (launches or [outside[0]])[-1], last)

    def _waiting(
        self, pilot: Pilot, steps: tuple[Step, ...], need: _Need | None, *, at_once: bool
    ) -> tuple[Step, ...]:
        """Return the steps of a robot that waits for the relays that it needs, and tells them to go."""
        if need is None:
            return steps
        name = pilot.robot.name
        begin = need.begin
        wait = Await(
            steps[begin].begin,
            steps[begin].begin,
            steps[begin].task,
            tuple(_in_place(stay) for stay in need.relays),
        )
        outside, inside = self._divided(pilot, steps[need.last]) if at_once else (steps[need.last :], ())
        receivers = tuple(stay.robot.name for stay in need.relays)
        told = Signal(outside[-1].end, outside[-1].end, outside[-1].task, _in_range(name), receivers)
        between, rest = (*steps[begin : need.last], *outside), steps[need.last + len(outside) :]
        return (*steps[:begin], wait, *between, told, *inside, *rest)

    def _divided(self, pilot: Pilot, step: Step) -> tuple[tuple[Step, ...], tuple[Step, ...]]:
        """Return the last step that leads out of a robot's range, until it is back there and from then on."""
        own = reach_of(pilot.robot, self._own, self._scene.position_error)
        if own is None or not isinstance(step, Transit):
            return (step,), ()
        before, after = _cut(step.route, _back_in_range(own, step.route))
        (_, first, _), (_, second, _) = (pilot.travel.going(each, step.speed) for each in (before, after))
        if second < _WORTH:
            return (step,), ()
        back = step.begin + first
        return (
            (replace(step, end=back, route=before),),
            (replace(step, begin=back, end=back + second, route=after),),
        )

    def _refuse_short(self, team: Team, made: Plan, needs: Mapping[str, _Need]) -> None:
        """Refuse what a charge does not suffice for.

        Raises:
            InfeasibleError: gives by how much, and what would help.
        """
        short, used = team.charges.short(made), team.charges.most_used(made)
        reasons = []
        for name in sorted(short):
            pilot = team.pilots[name]
            allowed, kept = allowed_by_charge(pilot), kept_of_charge(pilot)
            stay = next((each for each in self._placed if each.robot.name == name), None)
            charge = f"{allowed:.0f} s a charge{kept}"
            over = f"{ceil(used[name] - allowed)} s too long"
            if stay is None:
                reasons.append(
                    f"'{name}' would be out for up to {ceil(used[name])} s, it has {charge}: {over}"
                )
                continue
            users = ", ".join(f"'{user}'" for user, need in needs.items() if stay in need.relays)
            now = lifetime_of(self._scene, pilot.robot)
            enough = ceil(now * (used[name] + pilot.charge - allowed) / pilot.charge)
            reasons.append(
                f"'{name}' would be out for up to {ceil(used[name])} s as relay '{stay.task}' of {users}, it"
                f" has {charge}: {over}; a lifetime of {enough} s (now {now:.0f} s) would do; more robots"
                " beyond it, or fewer tasks there in one mission, would help"
            )
        if reasons:
            raise InfeasibleError(f"no plan: {reasons[0]}", reasons)


@dataclass(frozen=True, slots=True)
class _Need:
    """Which relays a robot needs: from the step on with which it leaves for what is out of its own range.

    Attributes:
        relays: that it needs.
        begin: index of that step: the launch for that sortie, if there is one.
        last: index of the last step that leads out of its range.
    """

    relays: tuple[Stay, ...]
    begin: int
    last: int


def _in_place(stay: Stay) -> str:
    return f"relay {stay.task} in place"


def _in_range(robot: str) -> str:
    return f"{robot} back in range"


def _staying(steps: Iterable[Step], stay: Stay, users: Sequence[str]) -> Iterator[Step]:
    """Yield the steps of a relay: at its place it tells others that it is there, and waits for them all."""
    for step in steps:
        if not (users and isinstance(step, Serve) and step.last):
            yield step
            continue
        yield replace(step, last=False)
        yield Signal(step.end, step.end, step.task, _in_place(stay), tuple(users))
        yield Await(step.end, step.end, step.task, tuple(_in_range(user) for user in users))
        here = Stroke(step.stroke.points[-1:])
        yield Serve(step.end, step.end, step.task, here, step.speed, _STAYS, last=True)


def _covers(reach: Reach, step: Step) -> bool:
    """Return whether a robot is in range all along a step."""
    return all(
        reach.contains(points, spare - SLACK)
        for each in all_steps((step,))
        for points, spare in _paths_of(each)
    )


def _paths_of(step: Step) -> Iterator[tuple[Sequence[Position], float]]:
    """Yield the polylines of a step, and by how much the robot may be off them, metres."""
    match step:
        case Transit():
            yield step.route, 0.0
        case Serve():
            yield step.stroke.points, unsure(step.stroke)
        case Launch() | Recover():
            yield (step.at, (step.at[0], step.at[1], step.up)), 0.0
        case _:
            return


def _back_in_range(own: Reach, route: Sequence[Position]) -> float:
    """Return the metres along a route after which a robot is in its own range all along the rest."""
    low, high = 0.0, length_of(route)
    while high - low > _CLOSE:
        middle = (low + high) / 2.0
        low, high = (low, middle) if own.contains(_cut(route, middle)[1], _INSIDE) else (middle, high)
    return high


def _cut(route: Sequence[Position], at: float) -> tuple[tuple[Position, ...], tuple[Position, ...]]:
    """Return a route up to a number of metres along it, and from there on."""
    left = at
    for i, (one, two) in enumerate(pairwise(route)):
        leg = dist(one, two)
        if left <= leg and leg > 0.0:
            east, north, up = (a + left / leg * (b - a) for a, b in zip(one, two, strict=True))
            place = (east, north, up)
            return (*route[: i + 1], place), (place, *route[i + 1 :])
        left -= leg
    return tuple(route), tuple(route[-1:])


def _end_of(step: Step) -> Position:
    """Return where a robot is after a step that leads somewhere."""
    ends = [points[-1] for each in all_steps((step,)) for points, _ in _paths_of(each)]
    return ends[-1]
