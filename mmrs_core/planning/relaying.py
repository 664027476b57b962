"""Plans in which some robots stay somewhere as relays for the radios of the others.

Who is a relay is decided first, the rest is planned as if the relays had always been at their places; then
robots are made to wait for each other. A relay leaves in time to be at its place when it is needed, and
tells those that need it when it is there. One that needs it leaves home for a sortie out of its own range
only then, and tells the relay when it is back in that range for the rest of the plan; when all have told
it, the relay goes home, and waits only where another one would come too near. A relay that needs another
one to get to its own place is one of those that need that. No circle of waits comes about, since relays are
put up one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, product
from math import cos, dist, pi, sin

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.delaying import retimed
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.reach import Reach, in_range_of, reach_of, unsure
from mmrs_core.planning.relay_waits import Joining, Stay
from mmrs_core.planning.separation import distance_to_keep
from mmrs_core.scene import (
    Area,
    AreaUse,
    Await,
    Plan,
    Scene,
    Serve,
    Signal,
    Step,
    Stroke,
    Work,
    distinct_works,
)
from mmrs_core.scene.relays import relays_of, station_of

_MOST_CREWS = 6
"""Choices of the robots that are relays that are tried."""

_CORNERS = 16
"""Corners of the area about a relay that others keep out of, where robots keep apart."""

Planned = Callable[[Scene, Effort | None], Plan]


def relay_tasks(scene: Scene) -> tuple[str, ...]:
    """Return the names of the tasks in which a robot stays as a relay, in the scene's order."""
    if not any(work.relays for work in distinct_works(scene.works)):
        return ()
    found = {task for (task, _), work in scene.works.items() if work.relays}
    return tuple(task.name for task in scene.tasks if task.name in found)


def plan_with_relays(scene: Scene, planned: Planned, effort: Effort | None) -> Plan:
    """Return the best plan that is found with robots as relays: for each such task some robot that can do it.

    Args:
        scene: expanded, with tasks in which robots stay as relays.
        planned: plans a scene without such tasks.
        effort: of the whole.

    Raises:
        InfeasibleError: no plan was found with the first choice of these robots, nor with another one.
    """
    tasks = relay_tasks(scene)
    _refuse_what_is_not_supported(scene, tasks)
    crews = list(islice(_crews(scene, tasks), _MOST_CREWS))
    if not crews:
        able = {task: [name for name in _robots(scene) if (task, name) in scene.works] for task in tasks}
        names = ", ".join(sorted({f"'{name}'" for each in able.values() for name in each}))
        raise InfeasibleError(
            f"no plan: {len(tasks)} tasks want a robot each that is a relay and does nothing else,"
            f" and only {names} can do them"
        )
    best: Plan | None = None
    refusal: InfeasibleError | None = None
    for crew in crews:
        mine = effort.trial() if effort is not None and crew is not crews[-1] else effort
        try:
            made = _made(scene, crew, planned, mine)
        except InfeasibleError as error:
            refusal = refusal or error
        else:
            best = made if best is None or made.makespan < best.makespan - 1e-3 else best
        if effort is not None and mine is not None and mine.stopped:
            effort.stopped = True
            break
    if best is None:
        raise refusal or InfeasibleError("no plan")
    return best


def without_relays(scene: Scene, plan: Plan) -> tuple[Scene, Plan]:
    """Return the scene of the robots that are not relays in a plan, and what these do if relays are there."""
    serving = {
        step.task: each.robot for each in plan.robots for step in each.steps if isinstance(step, Serve)
    }
    stays = [stay for task in relay_tasks(scene) for stay in _stays(scene, task)]
    crew = [stay for stay in stays if serving.get(stay.task) == stay.robot.name]
    if not crew:
        return scene, plan
    names = {stay.robot.name for stay in crew}
    rest = tuple(each for each in plan.robots if each.robot not in names)
    given = {
        step.signal: tuple(name for name in step.receivers if name not in names)
        for each in rest
        for step in each.steps
        if isinstance(step, Signal)
    }
    others = _without(scene, crew)
    steps = {each.robot: tuple(_not_waiting(each.steps, given)) for each in rest}
    return others, retimed(others, replace(plan, robots=rest), steps)


def _not_waiting(steps: Iterable[Step], given: Mapping[str, tuple[str, ...]]) -> Iterator[Step]:
    """Yield the steps of a robot with those signals only that are given, and received."""
    for step in steps:
        if isinstance(step, Await):
            step = replace(step, signals=tuple(each for each in step.signals if each in given))
            if not step.signals and step.until is None:
                continue
        elif isinstance(step, Signal):
            step = replace(step, receivers=given[step.signal])
            if not step.receivers:
                continue
        yield step


def _robots(scene: Scene) -> tuple[str, ...]:
    return tuple(robot.name for robot in scene.robots)


def _refuse_what_is_not_supported(scene: Scene, tasks: Sequence[str]) -> None:
    """Refuse what a robot that stays for others cannot do.

    Raises:
        InfeasibleError: a task of a relay depends on others, or others on it, or it wants several robots, or
            has an earliest time.
    """
    reasons = []
    for task in (scene.task(name) for name in tasks):
        edges = [each for each in scene.dependencies if task.name in (each.before, each.after)]
        reasons += [
            f"task '{task.name}' lasts as long as other robots need it: it cannot come"
            f" {'before' if each.before == task.name else 'after'}"
            f" '{each.after if each.before == task.name else each.before}'; remove the dependency"
            for each in edges
        ]
        if (task.wanted or 1) > 1:
            reasons.append(f"task '{task.name}' wants {task.wanted} robots, but one robot is the relay")
        if task.earliest:
            reasons.append(
                f"task '{task.name}' has an earliestStart, but its robot goes when others need it; remove it"
            )
    if reasons:
        raise InfeasibleError(f"no plan: {reasons[0]}", reasons)


def _stays(scene: Scene, task: str) -> Iterator[Stay]:
    for robot in scene.robots:
        work = scene.works.get((task, robot.name))
        station = None if work is None else station_of(task, work, robot.type, scene.position_error)
        if station is not None:
            yield Stay(task, robot, station)


def _crews(scene: Scene, tasks: Sequence[str]) -> Iterator[tuple[Stay, ...]]:
    """Yield choices of different robots for tasks, those first whose homes are nearest to their places.

    Of robots of one type, no more are looked at than there are tasks.
    """
    choices = []
    for task in tasks:
        by_type = dict[str, list[Stay]]()
        for stay in sorted(_stays(scene, task), key=_away):
            by_type.setdefault(stay.robot.type.name, []).append(stay)
        choices.append([stay for each in by_type.values() for stay in each[: len(tasks)]])
    crews = [each for each in product(*choices) if len({stay.robot.name for stay in each}) == len(tasks)]
    yield from sorted(crews, key=lambda crew: sum(map(_away, crew)))


def _away(stay: Stay) -> float:
    return dist(stay.robot.home, stay.station.position)


def _made(scene: Scene, crew: Sequence[Stay], planned: Planned, effort: Effort | None) -> Plan:
    """Return a plan in which these robots are relays."""
    plans, placed, left = dict[str, Plan](), list[Stay](), list(crew)
    while left:
        refusals = list[InfeasibleError]()
        for stay in left:
            try:
                plans[stay.robot.name] = planned(_only(scene, stay, placed), None)
            except InfeasibleError as error:
                refusals.append(_about(stay, error))
                continue
            left.remove(stay)
            placed.append(stay)
            break
        else:
            raise refusals[0]
    others = _without(scene, crew)
    names = ", ".join(f"'{stay.robot.name}' at '{stay.task}'" for stay in crew)
    if others.tasks and not others.robots:
        raise InfeasibleError(f"no plan: with {names} as relay, no robot is left for the other tasks")
    try:
        rest = planned(others, effort)
    except InfeasibleError as error:
        reasons = [f"with {names} as relay: {reason}" for reason in error.reasons or (str(error),)]
        raise InfeasibleError(f"no plan: {reasons[0]}", reasons) from error
    return Joining(scene, placed, plans, rest).plan()


def _about(stay: Stay, error: InfeasibleError) -> InfeasibleError:
    reasons = [f"'{stay.robot.name}' as relay: {reason}" for reason in error.reasons or (str(error),)]
    return InfeasibleError(f"no plan: {reasons[0]}", reasons)


def _only(scene: Scene, stay: Stay, placed: Sequence[Stay]) -> Scene:
    """Return the scene of one robot that is to be a relay, when others are at their places already."""
    task, robot = scene.task(stay.task), stay.robot
    work = replace(scene.works[task.name, robot.name], relays=False)
    return replace(
        scene,
        tasks=(replace(task, deadline=None, longest=None),),
        dependencies=(),
        robots=(robot,),
        works={(task.name, robot.name): work},
        stations=tuple(each.station for each in placed),
        areas=(*scene.areas, *_kept_clear(scene, placed)),
    )


def _without(scene: Scene, crew: Sequence[Stay]) -> Scene:
    """Return the scene of all other robots and tasks, when the relays of a crew are at their places."""
    busy, tasks = {stay.robot.name for stay in crew}, {stay.task for stay in crew}
    stations = tuple(stay.station for stay in crew)
    relays = (*relays_of(scene.elements), *stations)
    robots = tuple(robot for robot in scene.robots if robot.name not in busy)
    reaches = {robot.name: reach_of(robot, relays, scene.position_error) for robot in robots}
    works, refusals = dict[tuple[str, str], Work](), dict[tuple[str, str], str]()
    for (task, name), work in scene.works.items():
        if task in tasks or name in busy:
            continue
        if (beyond := _beyond(reaches[name], work.strokes)) is None:
            works[task, name] = work
        else:
            refusals[task, name] = f"would be {beyond}"
    return replace(
        scene,
        tasks=tuple(task for task in scene.tasks if task.name not in tasks),
        robots=robots,
        works=works,
        refusals={**scene.refusals, **refusals} if refusals else scene.refusals,
        stations=stations,
        areas=(*scene.areas, *_kept_clear(scene, crew)),
    )


def _beyond(reach: Reach | None, strokes: Sequence[Stroke]) -> str | None:
    """Return in words how far the first stroke that is out of range is so; None: none is."""
    if reach is None:
        return None
    outside = (each for each in strokes if not in_range_of(reach, [each]))
    return next((reach.beyond(each.points, unsure(each)) for each in outside), None)


def _kept_clear(scene: Scene, crew: Sequence[Stay]) -> Iterator[Area]:
    """Yield the areas about relays that others must not come into, where robots keep apart."""
    least = distance_to_keep(scene)
    for stay in crew if least is not None else ():
        assert least is not None
        east, north, up = stay.station.position
        out = least / cos(pi / _CORNERS)
        angles = [2.0 * pi * i / _CORNERS for i in range(_CORNERS)]
        shell = tuple((east + out * cos(each), north + out * sin(each)) for each in angles)
        name = f"surroundings of relay {stay.task}"
        yield Area(name, AreaUse.OBSTACLE, shell, up - least, up + least)
