"""A makespan that no plan falls below, whatever it decides.

It is the larger of two. One task after the other: a robot has to get there, do it, perhaps after those that
it waits for, and come back. All tasks together: tours that come to all places, and all work, see `forests`
and `few_places`.

Legs count as straight and level, from a stop to a stop, at the highest speed that a robot is ever commanded:
no detour, corner or stop between is quicker. Strokes count as the hulls of their points, within which a robot
is anywhere at once.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf

import numpy as np
import shapely
from numpy.typing import NDArray

from mmrs_core.planning.few_places import longest_to_few
from mmrs_core.planning.flown_legs import flown_legs
from mmrs_core.planning.forests import least_longest, shared, spanning_tree
from mmrs_core.planning.jobs import Job
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import commanded_speed, continues, joined, serve_seconds
from mmrs_core.planning.team import Team
from mmrs_core.scene import Coverage, Stroke, Work, distinct_works

_CREWS = 8
"""Sets of robots that are looked at one by one, with the tasks that no others can do."""

_MOST = 2000
"""Places up to which distances between them are exact; beyond, those of the rectangles around them."""

_WHOLLY = 0.99
"""Share of a task at least that robots with different works for it do, thin strips between left out."""

Array = NDArray[np.float64]
Places = NDArray[np.object_]


def least_makespan(team: Team, jobs: Sequence[Job]) -> float:
    """Return seconds that no plan's makespan falls below; 0 where nothing is known."""
    tasks = [job.name for job in jobs if job.choice is None and job.tasks()]
    crews = {task: team.able(task) for task in tasks}
    known = {name for crew in set(crews.values()) for name in crew}
    names = {name: i for i, name in enumerate(each for each in team.pilots if each in known)}
    pilots = [team.pilots[name] for name in names]
    if not pilots:
        return 0.0
    hulls = [_places(team, task) for task in tasks]
    places, owners = np.concatenate(hulls), np.repeat(np.arange(len(tasks)), list(map(len, hulls)))
    away = _distances(places, shapely.points([pilot.robot.home[:2] for pilot in pilots]))
    seconds = _quickest(team, list(names), float(away.max()) * 2.0)
    work = {task: _work(team, task) for task in tasks}
    aloft, down = _aloft_and_down(team, pilots, tasks)
    back = all(pilot.robot.return_home for pilot in pilots)
    nearest = seconds(np.minimum.reduceat(away.min(axis=1), np.searchsorted(owners, np.arange(len(tasks)))))
    there = dict(zip(tasks, nearest.tolist(), strict=True))
    ends = _earliest_ends(team, jobs, {task: aloft + seconds for task, seconds in there.items()}, work)
    least = [ends[task] + (there[task] if back else 0.0) + down for task in tasks]
    common = Counter(crews.values()).most_common(_CREWS)
    for crew in {frozenset(each) for each, _ in common} | {frozenset(names)}:
        mine = np.array([crew.issuperset(crews[task]) for task in tasks])
        robots, some = sorted(names[name] for name in crew), mine[owners]
        whole = sum(work[task] for task, own in zip(tasks, mine.tolist(), strict=True) if own)
        together = _together(places[some], away[some][:, robots].T, seconds, back, whole)
        least.append(aloft + down + together)
        if least[-1] > max(pilots[robot].charge for robot in robots):
            sortie = aloft + down + (1.0 + back) * float(seconds(away[some][:, robots].min()))
            edges = seconds(_tree(places[some]))
            least.append(_charged([pilots[robot] for robot in robots], edges, sortie, whole))
    return max(least)


def _together(
    places: Places, away: Array, seconds: Callable[[Array], Array], back: bool, work: float
) -> float:
    """Return seconds that the longest of tours to all places does not fall below.

    Multipliers are for points only: where robots are anywhere at once, they may come twice for nothing.
    """
    if _are_points(places) and len(places) <= _MOST:
        between, there = seconds(_distances(places, places)), seconds(away)
        return max(least_longest(between, there, back, work), longest_to_few(between, there, back))
    edges = seconds(_tree(places))
    return float(shared(edges, (1.0 + back) * seconds(away.min(axis=1)), work).min())


def _tree(places: Places) -> Array:
    """Return the lengths of a shortest spanning tree of all places, longest first."""
    (west, south, east, north), points = shapely.bounds(places).T.copy(), _are_points(places)

    def lengths_from(i: int) -> Array:
        if not points and len(places) <= _MOST:
            exact: Array = shapely.distance(places, places[i])
            return exact
        level = (west - west[i], south - south[i]) if points else _gaps(west, south, east, north, i)
        least: Array = np.sqrt(level[0] ** 2 + level[1] ** 2)
        return least

    return np.sort(spanning_tree(lengths_from, len(places))[0])[::-1]


def _are_points(places: Places) -> bool:
    boxes = shapely.bounds(places)
    return bool((boxes[:, :2] == boxes[:, 2:]).all())


def _charged(pilots: Sequence[Pilot], edges: Array, sortie: float, work: float) -> float:
    """Return seconds that no plan falls below in which each sortie takes no more than a charge.

    So many sorties that all of them together suffice take at least: a shortest forest of so many trees, what
    each takes besides, and all work. All but the first of each robot come after charging.

    Args:
        pilots: of all robots that take part.
        edges: seconds of a shortest spanning tree of all places, longest first.
        sortie: seconds of a launch, to the nearest place and back, and of a landing.
        work: seconds at all places together.
    """
    charge, robots = max(pilot.charge for pilot in pilots), len(pilots)
    charging = [pilot.kinematics.recharge for pilot in pilots if pilot.kinematics.recharge is not None]
    left = float(edges.sum())
    least, sorties = inf, 0
    while sorties < robots or (charging and least == inf and sortie < charge):
        sorties += 1
        busy = left + sorties * sortie + work
        if busy <= sorties * charge:
            least = min(least, (busy + max(0, sorties - robots) * min(charging, default=0.0)) / robots)
        left -= float(edges[sorties - 1]) if sorties <= len(edges) else 0.0
    return 0.0 if least == inf else least


def _gaps(west: Array, south: Array, east: Array, north: Array, i: int) -> tuple[Array, Array]:
    """Return metres between the sides of one rectangle and those of all."""
    return (
        np.maximum(np.maximum(west - east[i], west[i] - east), 0.0),
        np.maximum(np.maximum(south - north[i], south[i] - north), 0.0),
    )


def _distances(places: Places, others: Places) -> Array:
    """Return (places, others) metres between them."""
    if _are_points(places) and _are_points(others):
        east, north = shapely.bounds(places)[:, :2].T[:, :, None] - shapely.bounds(others)[:, :2].T[:, None]
        found: Array = np.sqrt(east * east + north * north)
        return found
    exact: Array = shapely.distance(places[:, None], others)
    return exact


def _aloft_and_down(team: Team, pilots: Sequence[Pilot], tasks: Sequence[str]) -> tuple[float, float]:
    """Return the fewest seconds of a launch, and of a landing.

    Where nothing is in the way, robots launch to the height of transit or of a task and come down from one.
    """
    works = (work for task in tasks for work in _works(team, task).values())
    low = min(point[2] for work in works for stroke in work.strokes for point in stroke.points)
    if team.scene.transit_altitude is not None:
        low = min(low, team.scene.transit_altitude)
    free = not team.scene.areas
    launches, landings = [], []
    for kinematics, home in ((pilot.kinematics, pilot.robot.home) for pilot in pilots):
        rise = max(0.0, min(low, kinematics.ceiling) - home[2]) if free and kinematics.launches else 0.0
        launches.append(kinematics.launching(rise))
        landings.append(kinematics.landing(rise))
    return min(launches), min(landings)


def _earliest_ends(
    team: Team, jobs: Sequence[Job], there: Mapping[str, float], work: Mapping[str, float]
) -> dict[str, float]:
    """Return, by job, when it ends at the earliest, by whatever robots."""
    ends = dict[str, float]()
    for job in jobs:
        before = max((ends[name] for name in job.after), default=0.0)
        if job.name in there:
            task = team.tasks[job.name]
            begin = max(before, there[job.name], task.earliest or 0.0)
            ends[job.name] = begin + work[job.name] / max(1, task.wanted or team.sharers(job.name))
        else:
            ends[job.name] = before
    return ends


def _works(team: Team, task: str) -> dict[str, Work]:
    """Return the works of a task by one of all robots that do it alike."""
    return {name: team.scene.works[task, name] for name in team.able_kinds(task).values()}


def _shared(team: Team, task: str) -> Work | None:
    """Return the work of a task that robots may share; None where they are to lay it out in several ways."""
    first, *others = _works(team, task).values()
    return None if team.whole(task) or any(each != first for each in others) else first


def _work(team: Team, task: str) -> float:
    """Return the seconds that a task takes at least without getting there; 0 where nothing is known."""
    names, work = _works(team, task), _shared(team, task)
    if work is not None:
        strokes, pilots = joined(work.strokes), [team.pilots[name] for name in names]
        return min(sum(_least_seconds(each, pilot) for each in strokes) for pilot in pilots)
    if not team.whole(task):
        return _at_best(team, names)
    materials = [team.forwards(task, name) for name in names]
    return min((each.seconds(0, len(each) - 1) for each in materials if each is not None), default=0.0)


def _least_seconds(stroke: Stroke, pilot: Pilot) -> float:
    """Return seconds that a stroke takes at least, in whatever parts."""
    flown = flown_legs(stroke, pilot.travel)
    return serve_seconds(stroke, pilot.robot, pilot.kinematics) - flown.most


def _at_best(team: Team, works: Mapping[str, Work]) -> float:
    """Return the seconds of different works for a task if all went as the quickest stroke of any of them."""
    amounts, rates = list[float](), list[float]()
    for name, work in works.items():
        pilot, coverage = team.pilots[name], work.coverage
        done = [_amount(stroke, coverage) for stroke in work.strokes]
        layers = len({stroke.part for stroke in work.strokes})
        area = sum(shapely.Polygon(*piece).area for piece in coverage.target) if coverage else 0.0
        amounts.append(layers * area if coverage else sum(done))
        chain = list[int]()
        for i, stroke in enumerate(work.strokes):
            chain = [*chain, i] if chain and continues(work.strokes[i - 1], stroke) else [i]
            (whole,) = joined(work.strokes[j] for j in chain)
            seconds = _least_seconds(whole, pilot)
            rates.append(sum(done[j] for j in chain) / seconds if seconds > 0.0 else inf)
    return _WHOLLY * min(amounts) / max(rates)


def _amount(stroke: Stroke, coverage: Coverage | None) -> float:
    """Return square metres that a stroke covers at most, or how much of a line it is, in its measure."""
    if coverage is None:
        return abs(stroke.stretch[1] - stroke.stretch[0])
    return coverage.width * (len(stroke.spots) * coverage.length if coverage.length else stroke.length)


def _places(team: Team, task: str) -> Places:
    """Return what must be visited for a task: each stroke; all of it where robots lay it out differently."""
    work = _shared(team, task)
    strokes = joined(work.strokes) if work is not None else ()
    groups = [each.points for each in strokes] or [
        tuple(p for each in _works(team, task).values() for stroke in each.strokes for p in stroke.points)
    ]
    hulls = [shapely.multipoints([point[:2] for point in points]).convex_hull for points in groups]
    return np.array(hulls, dtype=object)


def _quickest(team: Team, names: Sequence[str], longest: float) -> Callable[[Array], Array]:
    """Return a function from level distances up to a longest to seconds that no robot falls below."""
    pilots = [team.pilots[name] for name in dict.fromkeys(team.kinds[name] for name in names)]
    kinds = [pilot.kinematics for pilot in pilots]
    kinds += [pilot.kinematics.in_mission() for pilot in pilots if pilot.travel.uploading is not None]
    short = max(0.05, *(kinematics.accepts for kinematics in kinds))
    lengths = np.concatenate([[0.0], np.geomspace(2.0 * short, max(4.0 * short, longest), 200)])
    least = np.full(len(lengths), inf)
    strokes = [stroke for work in distinct_works(team.scene.works) for stroke in work.strokes]
    for kinematics in kinds:
        speed = max(kinematics.cruise, *(commanded_speed(each, kinematics) for each in strokes))
        timing = replace(kinematics.timing, overshoot=0.0, lag=0.0)
        rates = replace(kinematics.rates(speed), timing=timing, shunting=0.0, accepts=0.0)
        times = np.array([rates.from_stop_to_stop((0.0, 0.0, 0.0), (x, 0.0, 0.0)) for x in lengths.tolist()])
        if timing.settling < 0.0:  # reports legs as done before their end: many short ones may take less
            times = lengths * max(0.0, min(1.0 / speed, (times[1:] / lengths[1:]).min()))
        least = np.minimum(least, times)
    # Seconds grow the more slowly the longer the leg: chords between points of that curve lie below it, the
    # first one also below what short legs count that are taken together.
    return lambda level: np.interp(level, lengths, least)
