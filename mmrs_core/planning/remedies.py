"""What would make a mission feasible that has no plan; each remedy is tried before it is named."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, product
from math import ceil, dist, floor, inf

from mmrs_core.planning.jobs import Job
from mmrs_core.planning.materials import shortages
from mmrs_core.planning.schedule import Decisions, Schedule, schedule
from mmrs_core.planning.team import Team, teams_to_try
from mmrs_core.planning.travel import Spaces
from mmrs_core.scene import Area, AreaUse, Corridor, Robot, Scene
from mmrs_runtime.policies import RETURN, Policy

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


def too_long(team: Team, jobs: Sequence[Job]) -> list[str]:
    """Return why tasks fit into no sortie of any robot, and what would do for the best of them."""
    tasks = [task for job in jobs for task in job.tasks() if team.too_long(task)]
    worst = {task: _best(team, task) for task in tasks}
    lifetimes, charging = _lifetimes(team, jobs, worst.values())
    diverting = [*for_diversions(team, jobs)]
    reasons = []
    for task, (name, short, index) in worst.items():
        why = "; ".join(team.short_of_charge(task))
        if not name:
            reasons.append(f"task '{task}' can be done by no robot ({team.why_not(task)})")
            continue
        if short == inf:
            remedy = or_else([*_passages(team, task, why), *_corridors(team, task, why)])
            reasons.append(f"task '{task}' can be reached by no robot ({why}){remedy}")
            continue
        remedies = [*_homes(team, jobs, task, name, index)]
        if name in lifetimes:
            now = lifetime_of(team.scene, team.scene.robot(name))
            remedies.insert(0, f"a lifetime of {lifetimes[name]} s (now {now:.0f} s){charging}")
        remedies[:1] = [f"for '{name}', {each}" for each in remedies[:1]]
        remedies += diverting
        reasons.append(f"task '{task}' is too long for every robot ({why}){or_else(remedies)}")
    return reasons


def _best(team: Team, task: str) -> tuple[str, float, int]:
    """Return the robot that is least short of charge for a task: by how many seconds, for which portion."""
    found = [(*_worst(team, task, name), name) for name in team.able(task)]
    short, index, name = min(found, key=lambda each: each[0], default=(inf, 0, ""))
    return name, short, index


def _lifetimes(
    team: Team, jobs: Sequence[Job], worst: Iterable[tuple[str, float, int]]
) -> tuple[dict[str, int], str]:
    """Return by robot the lifetime with which all jobs would be done, seconds, and what else it takes.

    They are none where lifetimes do not help.
    """
    scene, needed = team.scene, dict[str, int]()
    for name, short, _ in worst:
        lifetime = lifetime_of(scene, scene.robot(name)) if name else inf
        if inf in (lifetime, short):
            return {}, ""
        charge = team.pilots[name].charge
        needed[name] = max(needed.get(name, 0), ceil(lifetime * (charge + short) / charge - 1e-6))
    if len(jobs) * len(scene.robots) > _MOST_PAIRS:
        return needed, ""

    def plannable(factor: float, change: Callable[[Robot], Robot] = lambda robot: robot) -> bool:
        def changed(robot: Robot) -> Robot:
            return _lasting(change(robot), factor * needed[robot.name] / lifetime_of(scene, robot))

        return is_plannable(_with(scene, [*needed], changed), jobs, team.spaces)

    if plannable(1.0):
        return needed, ""
    enough = _least(plannable)
    if enough is not None:
        return {name: ceil(seconds * enough) for name, seconds in needed.items()}, ""
    return (needed, " together with a rechargeTime") if plannable(1.0, _rechargeable) else ({}, "")


def _passages(team: Team, task: str, why: str) -> Iterator[str]:
    """Yield the areas that are in the way of robots, each of which alone keeps them from a task."""
    users = dict[str, list[str]]()
    for name in team.able(task):
        robot = team.scene.robot(name)
        blocking = [each for each in team.scene.kept_from(robot) if f"'{each.name}'" in why][:_MOST_AREAS]
        opened = [f"'{each.name}'" for each in blocking if _fits(team, task, robot, without=each)]
        if opened:
            users.setdefault(f"a passage through {' or '.join(opened)}", []).append(f"'{name}'")
    yield from _for_each(users)


def _corridors(team: Team, task: str, why: str) -> Iterator[str]:
    """Yield how corridors that keep robots from a task would let them through, each alone."""
    users = dict[str, list[str]]()
    for kind in team.able_kinds(task).values():
        robot = team.scene.robot(kind)
        for each in team.scene.corridors_of(robot):
            opened = _opened(team.scene, each, robot) if f"corridor '{each.name}'" in why else ()
            fit = (words for words, other in opened if _fits(team, task, robot, corridors=other))
            for words in islice(fit, 1):
                alike = [name for name in team.able(task) if team.kinds[name] == team.kinds[kind]]
                users.setdefault(words, []).extend(f"'{name}'" for name in alike)
    yield from _for_each(users)


def _for_each(users: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Yield each remedy once, with the robots that it is for."""
    yield from (f"for {', '.join(names)} {words}" for words, names in users.items())


def _opened(scene: Scene, corridor: Corridor, robot: Robot) -> Iterator[tuple[str, tuple[Corridor, ...]]]:
    """Yield changes of a corridor that may let a robot through, in words, with the corridors of the scene."""
    needed, kinematics = 2.0 * robot.clearance, robot.kinematics
    floor_up, ceiling = (kinematics.floor, kinematics.ceiling) if kinematics is not None else (-inf, inf)
    wide = max(corridor.width, _up(needed))
    low = min(corridor.low, -_up(max(needed - corridor.high, robot.clearance - ceiling)))
    high = max(corridor.high, _up(max(corridor.low + needed, floor_up + robot.clearance)))
    widths = [(corridor.width, ""), (wide, f"a width of {wide:g} m")]
    heights = [
        (corridor.low, corridor.high, ""),
        (low, corridor.high, f"a minHeight of {low:g} m"),
        (corridor.low, high, f"a maxHeight of {high:g} m"),
        (-inf, corridor.high, "no minHeight"),
        (corridor.low, inf, "no maxHeight"),
    ]
    tried = [corridor]
    for (lower, upper, words), (width, more) in product(heights, widths):
        changed = replace(corridor, width=width, low=lower, high=upper)
        if changed not in tried:
            tried.append(changed)
            told = " and ".join(filter(None, (more, words)))
            yield f"{told} of corridor '{corridor.name}'", _instead(scene, corridor, changed)
    types = {each.type.name for each in scene.robots} if corridor.types is None else corridor.types
    if others := types - {robot.type.name}:
        words = f"robotTypes of corridor '{corridor.name}' without '{robot.type.name}'"
        yield words, _instead(scene, corridor, replace(corridor, types=frozenset(others)))


def _up(metres: float) -> float:
    """Return a length rounded up to centimetres."""
    return ceil(100.0 * metres - 1e-9) / 100.0 if abs(metres) < inf else metres


def _instead(scene: Scene, corridor: Corridor, changed: Corridor) -> tuple[Corridor, ...]:
    return tuple(changed if each is corridor else each for each in scene.corridors)


def _homes(team: Team, jobs: Sequence[Job], task: str, name: str, index: int) -> Iterator[str]:
    """Yield the home next to a robot's own from which a task fits into its sorties, if all jobs then do."""
    scene, robot = team.scene, team.scene.robot(name)
    material = team.forwards(task, name)
    goal = material.first(index) if material is not None else robot.home
    away = dist(goal[:2], robot.home[:2])

    def nearer(metres: float) -> Robot:
        east, north = (b + (a - b) * metres / away for a, b in zip(robot.home[:2], goal[:2], strict=True))
        return replace(robot, home=(round(east), round(north), robot.home[2]))

    if away > 0.0 and len(jobs) * len(scene.robots) <= _MOST_PAIRS and _fits(team, task, nearer(0.0)):
        metres = floor(_last(lambda share: _fits(team, task, nearer(share)), 0.0, away))
        home = nearer(metres).home
        if is_plannable(_with(scene, [name], lambda _: nearer(metres)), jobs):
            far = dist(home[:2], goal[:2])
            yield f"a home at ({home[0]:.0f}, {home[1]:.0f}), {far:.0f} m from '{task}'"


def for_diversions(team: Team, jobs: Sequence[Job]) -> Iterator[str]:
    """Yield what would do where robots keep too much of a charge to reach an emergency area."""
    scene = team.scene
    kept = {name: each.diversions for name, each in team.pilots.items() if each.diversions is not None}
    if not any(each.from_home > 0.0 for each in kept.values()):
        return
    if len(jobs) * len(scene.robots) > _MOST_PAIRS:
        return

    def plannable(away: float) -> bool:
        landings = [_landing(team, name, away) for name in kept]
        return is_plannable(replace(scene, areas=(*scene.areas, *landings)), jobs, team.spaces)

    if plannable(0.0):
        pilots = [team.pilots[name] for name in kept]
        farthest = max(each.charge * each.kinematics.cruise for each in pilots)
        metres = floor(_last(plannable, 0.0, farthest))
        yield f"an emergency area within {metres} m of each home"
    events = dict.fromkeys(event for each in kept.values() for event in each.events)
    returning = tuple(Policy(event, RETURN) for event in events)
    if is_plannable(replace(scene, policies=(*returning, *scene.policies)), jobs, team.spaces):
        yield f"RETURN as the response to {' and '.join(events)}"


def _landing(team: Team, name: str, away: float) -> Area:
    """Return an emergency area with room for all, `away` metres from a robot's home."""
    robot, diversions = team.scene.robot(name), team.pilots[name].diversions
    places = diversions.places if diversions is not None else ()
    goal = min(
        places, key=lambda each: dist(each, robot.home[:2]), default=(robot.home[0] + 1.0, robot.home[1])
    )
    share = away / max(dist(goal, robot.home[:2]), 1e-9)
    east, north = (a + share * (b - a) for a, b in zip(robot.home[:2], goal, strict=True))
    half = 2.0 * max(robot.clearance, team.scene.minimum_separation or 0.0) * len(team.scene.robots)
    shell = tuple((east + half * x, north + half * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return Area(f"area for {name}", AreaUse.EMERGENCY, shell, types=frozenset({robot.type.name}))


def for_all_charges(team: Team, jobs: Sequence[Job], job: Job) -> Iterator[str]:
    """Yield what would let robots do a job after what comes before, where their charges do not suffice."""
    scene, able = team.scene, _able(team, job)
    if len(jobs) * len(scene.robots) > _MOST_PAIRS or not able:
        return
    lifetimes = {lifetime_of(scene, scene.robot(name)) for name in able}

    def plannable(change: Callable[[Robot], Robot]) -> bool:
        return is_plannable(_with(scene, able, change), jobs, team.spaces)

    enough = _least(lambda each: plannable(lambda robot: _lasting(robot, each)))
    if max(lifetimes) < inf and enough is not None:
        (lifetime, *others) = lifetimes
        exact = f"a lifetime of {ceil(lifetime * enough)} s (now {lifetime:.0f} s)"
        yield f"lifetimes {ceil(100.0 * (enough - 1.0))} % longer" if others else exact
    stuck = any(_recharge(scene.robot(name)) is None for name in able)
    if stuck and plannable(_rechargeable):
        yield "a rechargeTime for the batteries"
    if job.choice is None and team.tasks[job.name].wanted is not None:
        for count in range(1, team.sharers(job.name) + 1):
            if is_plannable(team.wanting({job.name: count}).scene, jobs):
                yield f"robotsWanted of {count}"
                break
    for count in range(1, _MOST_ROBOTS + 1):
        if is_plannable(_with_more(scene, able[0], count), jobs):
            yield f"{counted(count).replace(' ', ' more ')} like '{able[0]}'"
            break


def _worst(team: Team, task: str, robot: str) -> tuple[float, int]:
    """Return by how many seconds the longest portion of a task is too long for a sortie, and which it is."""
    material = team.forwards(task, robot)
    short = [] if material is None else shortages(material, team.pilots[robot])
    return max(((each, i) for i, each in enumerate(short)), default=(inf, 0))


def _fits(
    team: Team,
    task: str,
    robot: Robot,
    without: Area | None = None,
    corridors: tuple[Corridor, ...] | None = None,
) -> bool:
    """Return whether a robot has sorties for each portion of a task, finely divided.

    Args:
        without: an area that is taken away.
        corridors: instead of the scene's.
    """
    works = {(task, robot.name): team.scene.works[task, robot.name]}
    scene = replace(
        team.scene,
        robots=(robot,),
        tasks=(team.tasks[task],),
        areas=tuple(each for each in team.scene.areas if each is not without),
        corridors=team.scene.corridors if corridors is None else corridors,
        dependencies=(),
        works=works,
        refusals={},
    )
    alone = Team(scene, fine=True, homebound=team.homebound & {robot.name})
    return alone.forwards(task, robot.name) is not None and not alone.too_long(task)


def is_plannable(scene: Scene, jobs: Sequence[Job], spaces: Spaces | None = None) -> bool:
    """Return whether even the decisions with which a search begins lead to a schedule.

    Args:
        scene: changed.
        jobs: of it.
        spaces: of a scene with the same obstacles, whose robots differ in charges only; None: new ones.
    """
    order = tuple(job.name for job in jobs)
    starts = (Decisions(order), Decisions(order, {name: 1 for name in order}))
    return any(
        isinstance(schedule(team, jobs, each), Schedule)
        for team in teams_to_try(Team(scene, spaces=spaces))
        for each in starts
    )


def _able(team: Team, job: Job) -> list[str]:
    return [name for name in team.pilots if all(name in team.able(task) for task in job.tasks())]


def lifetime_of(scene: Scene, robot: Robot) -> float:
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
