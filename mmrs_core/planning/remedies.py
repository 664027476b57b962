"""What would make a mission feasible that has no plan; each remedy is tried before it is named."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import ceil, dist, floor, inf

from mmrs_core.planning.jobs import Job
from mmrs_core.planning.materials import shortages
from mmrs_core.planning.schedule import Decisions, Schedule, schedule
from mmrs_core.planning.search import broken_times
from mmrs_core.planning.team import Team, teams_to_try
from mmrs_core.scene import Area, Robot, Scene

_MOST_PAIRS = 1000
"""Jobs times robots up to which remedies for the whole mission are tried."""

_MOST_ROBOTS = 3
"""Further robots that are tried."""

_MOST_AREAS = 10
"""Areas in the way that are tried."""

_LONGEST = 64.0
"""Times the lifetime that are tried at most."""

_CLOSE = 4e-3
"""Margin within which the least factor of the lifetime is found."""


def or_else(remedies: Sequence[str]) -> str:
    """Return remedies as the end of a sentence; empty where there are none.

    >>> or_else(["a lifetime of 30 s", "2 more robots"])
    '; a lifetime of 30 s or 2 more robots would do'
    """
    *others, last = remedies or ("",)
    return f"; {', '.join(others)}{' or ' if others else ''}{last} would do" if last else ""


def counted(robots: int) -> str:
    """Return a number of robots.

    >>> counted(1), counted(2)
    ('1 robot', '2 robots')
    """
    return f"{robots} robot{'' if robots == 1 else 's'}"


def too_long(team: Team, task: str) -> str:
    """Return why a task fits into no sortie of any robot, and what would do for the best of them."""
    worst = {name: _worst(team, task, name) for name in team.able(task)}
    name = min(worst, key=lambda each: worst[each][0], default="")
    why = "; ".join(team.short_of_charge(task))
    if not name:
        return f"task '{task}' is left to no robot"
    short, index = worst[name]
    if short == inf:
        remedies = [*_passages(team, task, why)]
        return f"task '{task}' can be reached by no robot ({why}){or_else(remedies)}"
    remedies = [*_for_long_sorties(team, task, name, short, index)]
    return f"task '{task}' is too long for every robot ({why}){or_else(remedies)}"


def _passages(team: Team, task: str, why: str) -> Iterator[str]:
    """Yield the areas that are in the way of robots, each of which alone keeps them from a task."""
    for name in team.able(task):
        robot = team.scene.robot(name)
        blocking = [each for each in team.scene.kept_from(robot) if f"'{each.name}'" in why][:_MOST_AREAS]
        opened = [f"'{each.name}'" for each in blocking if _fits(team, task, robot, without=each)]
        if opened:
            yield f"for '{name}' a passage through {' or '.join(opened)}"


def _for_long_sorties(team: Team, task: str, name: str, short: float, index: int) -> Iterator[str]:
    """Yield what would make a task fit into sorties of a robot."""
    robot, limit = team.scene.robot(name), team.pilots[name].limit
    lifetime = _lifetime(team.scene, robot)
    longer = ceil(lifetime * (limit + short) / limit - 1e-6) if lifetime < inf else 0
    if longer and _fits(team, task, _lasting(robot, longer / lifetime)):
        yield f"for '{name}', a lifetime of {longer} s (now {lifetime:.0f} s)"
    material = team.forwards(task, name)
    goal = material.first(index) if material is not None else robot.home
    away = dist(goal[:2], robot.home[:2])

    def nearer(metres: float) -> Robot:
        east, north = (b + (a - b) * metres / away for a, b in zip(robot.home[:2], goal[:2], strict=True))
        return replace(robot, home=(round(east), round(north), robot.home[2]))

    if away > 0.0 and _fits(team, task, nearer(0.0)):
        metres = _last(lambda share: _fits(team, task, nearer(share)), 0.0, away)
        home = nearer(floor(metres)).home
        yield f"a home at ({home[0]:.0f}, {home[1]:.0f}), {dist(home[:2], goal[:2]):.0f} m away,"


def for_times(team: Team, jobs: Sequence[Job], spans: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    """Yield each deadline and longest duration that the best schedule found breaks, and what would do."""
    single = {job.name: replace(job, after=()) for job in jobs if job.choice is None}
    for name, words, _ in broken_times(team, spans):
        begin, end = spans[name]
        if "deadline" not in words:
            yield f"task '{name}' {words}; {ceil(end - begin)} s would do"
            continue
        alone = schedule(team, [single[name]], Decisions((name,))) if name in single else None
        soonest = alone.spans[name][1] if isinstance(alone, Schedule) else 0.0
        sooner = (
            "; no robot can end it sooner"
            if round(end - soonest) == 0
            else f"; as the only task it would end after {ceil(soonest)} s"
            if soonest
            else ""
        )
        yield f"task '{name}' {words}{sooner}; a deadline of {ceil(end)} s would do"


def for_all_charges(team: Team, jobs: Sequence[Job], job: Job) -> Iterator[str]:
    """Yield what would let robots do a job after what comes before, where their charges do not suffice."""
    scene, able = team.scene, _able(team, job)
    if len(jobs) * len(scene.robots) > _MOST_PAIRS or not able:
        return
    lifetimes = {_lifetime(scene, scene.robot(name)) for name in able}
    enough = _least(lambda each: _plannable(_with(scene, able, lambda robot: _lasting(robot, each)), jobs))
    if max(lifetimes) < inf and enough is not None:
        (lifetime, *others) = lifetimes
        exact = f"a lifetime of {ceil(lifetime * enough)} s (now {lifetime:.0f} s)"
        yield f"lifetimes {ceil(100.0 * (enough - 1.0))} % longer" if others else exact
    stuck = any(_recharge(scene.robot(name)) is None for name in able)
    if stuck and _plannable(_with(scene, able, _rechargeable), jobs):
        yield "a rechargeTime for the batteries"
    if job.choice is None and team.tasks[job.name].wanted is not None:
        for count in range(1, team.sharers(job.name) + 1):
            if _plannable(team.wanting({job.name: count}).scene, jobs):
                yield f"robotsWanted of {count}"
                break
    for count in range(1, _MOST_ROBOTS + 1):
        if _plannable(_with_more(scene, able[0], count), jobs):
            yield f"{counted(count).replace(' ', ' more ')} like '{able[0]}'"
            break


def _worst(team: Team, task: str, robot: str) -> tuple[float, int]:
    """Return by how many seconds the longest portion of a task is too long for a sortie, and which it is."""
    material = team.forwards(task, robot)
    short = [] if material is None else shortages(material, team.pilots[robot])
    return max(((each, i) for i, each in enumerate(short)), default=(inf, 0))


def _fits(team: Team, task: str, robot: Robot, without: Area | None = None) -> bool:
    """Return whether a robot has sorties for each portion of a task, finely divided; without an area."""
    works = {(task, robot.name): team.scene.works[task, robot.name]}
    scene = replace(
        team.scene,
        robots=(robot,),
        tasks=(team.tasks[task],),
        areas=tuple(each for each in team.scene.areas if each is not without),
        dependencies=(),
        works=works,
        refusals={},
    )
    alone = Team(scene, fine=True, homebound=team.homebound & {robot.name})
    return alone.forwards(task, robot.name) is not None and not alone.too_long(task)


def _plannable(scene: Scene, jobs: Sequence[Job]) -> bool:
    """Return whether even the decisions with which a search begins lead to a schedule."""
    order = tuple(job.name for job in jobs)
    starts = (Decisions(order), Decisions(order, {name: 1 for name in order}))
    return any(
        isinstance(schedule(team, jobs, each), Schedule)
        for team in teams_to_try(Team(scene))
        for each in starts
    )


def _able(team: Team, job: Job) -> list[str]:
    return [name for name in team.pilots if all(name in team.able(task) for task in job.tasks())]


def _lifetime(scene: Scene, robot: Robot) -> float:
    """Return how long a robot's batteries last, seconds, its reserve included."""
    return robot.kinematics.endurance / (1.0 - scene.reserve) if robot.kinematics is not None else inf


def _recharge(robot: Robot) -> float | None:
    return None if robot.kinematics is None else robot.kinematics.recharge


def _with(scene: Scene, names: Sequence[str], change: Callable[[Robot], Robot]) -> Scene:
    robots = tuple(change(robot) if robot.name in names else robot for robot in scene.robots)
    return replace(scene, robots=robots)


def _lasting(robot: Robot, factor: float) -> Robot:
    """Return a robot whose batteries last longer."""
    if robot.kinematics is None:
        return robot
    endurance, energy = (factor * each for each in (robot.kinematics.endurance, robot.kinematics.energy))
    return replace(robot, kinematics=replace(robot.kinematics, endurance=endurance, energy=energy))


def _rechargeable(robot: Robot) -> Robot:
    if robot.kinematics is None or robot.kinematics.recharge is not None:
        return robot
    return replace(robot, kinematics=replace(robot.kinematics, recharge=0.0))


def _with_more(scene: Scene, name: str, count: int) -> Scene:
    """Return a scene with further robots like one of its own."""
    copies = tuple(replace(scene.robot(name), name=f"{name} {number}'") for number in range(count))
    works, refusals = dict(scene.works.items()), dict(scene.refusals)
    for task in scene.tasks:
        for each in copies:
            if (task.name, name) in works:
                works[task.name, each.name] = works[task.name, name]
            else:
                refusals[task.name, each.name] = refusals.get((task.name, name), "")
    return replace(scene, robots=(*scene.robots, *copies), works=works, refusals=refusals)


def _least(enough: Callable[[float], bool]) -> float | None:
    """Return about the least factor that is enough; None if none is."""
    high = 2.0
    while not enough(high):
        high *= 2.0
        if high > _LONGEST:
            return None
    return -_last(lambda each: enough(-each), -high, -high / 2.0, _CLOSE)


def _last(holds: Callable[[float], bool], low: float, high: float, close: float = 0.5) -> float:
    """Return about the largest value up to which something holds that holds for the low one."""
    while high - low > close:
        middle = (low + high) / 2.0
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
