"""A makespan that no plan falls below, whatever it decides.

It is the larger of two. One task after the other: a robot has to get there, do it, perhaps after those that
it waits for, and come back. All tasks together: who visits them leaves behind a tree that spans them and the
homes, so that a shortest spanning tree (Prim, "Shortest connection networks and some generalizations", Bell
Syst. Tech. J. 36, 1957) and all work, shared by all robots alike, take no longer; that bounds tours since
Held and Karp, "The traveling-salesman problem and minimum spanning trees", Oper. Res. 18 (1970).

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

from mmrs_core.planning.jobs import Job
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import commanded_speed, joined, serve_seconds
from mmrs_core.planning.team import Team
from mmrs_core.scene import Work, distinct_works

_CREWS = 8
"""Sets of robots that are looked at one by one, with the tasks that no others can do."""

_MOST = 1000
"""Places up to which distances between them are exact; beyond, those of the rectangles around them."""

Array = NDArray[np.float64]
Places = NDArray[np.object_]


def least_makespan(team: Team, jobs: Sequence[Job]) -> float:
    """Return seconds that no plan's makespan falls below; 0 where nothing is known.

    That is where an autopilot reports legs as done before their end, so that many short ones take less
    than a long one.
    """
    tasks = [job.name for job in jobs if job.choice is None and job.tasks()]
    names = [name for name in team.pilots if any(name in team.able(task) for task in tasks)]
    pilots = [team.pilots[name] for name in names]
    if not pilots or any(pilot.kinematics.timing.settling < 0.0 for pilot in pilots):
        return 0.0
    places = {task: _places(team, task) for task in tasks}
    homes = shapely.multipoints([pilot.robot.home[:2] for pilot in pilots])
    away = {task: shapely.distance(each, homes) for task, each in places.items()}
    seconds = _quickest(team, names, max(each.max() for each in away.values()) * 2.0)
    work = {task: _work(team, task) for task in tasks}
    aloft, down = _aloft_and_down(team, pilots, tasks)
    returns = all(pilot.robot.return_home for pilot in pilots)
    there = {task: float(seconds(each).min()) for task, each in away.items()}
    ends = _earliest_ends(team, jobs, {task: aloft + seconds for task, seconds in there.items()}, work)
    least = [ends[task] + (there[task] if returns else 0.0) + down for task in tasks]
    crews = Counter(map(team.able, tasks)).most_common(_CREWS)
    for crew in {frozenset(each) for each, _ in crews} | {frozenset(names)}:
        mine = [task for task in tasks if crew.issuperset(team.able(task))]
        tree = _spanned(*(np.concatenate([each[task] for task in mine]) for each in (places, away)))
        together = float(seconds(tree).sum()) + sum(work[task] for task in mine)
        home = min(there[task] for task in mine) if returns else 0.0
        least.append(aloft + down + together / len(crew) + home)
    return max(least)


def _aloft_and_down(team: Team, pilots: Sequence[Pilot], tasks: Sequence[str]) -> tuple[float, float]:
    """Return the fewest seconds of a launch, and of a landing.

    Where nothing is in the way, robots launch to the height of transit or of a task and come down from one.
    """
    works = (work for task in tasks for work in _works(team, task).values())
    low = min(point[2] for work in works for stroke in work.strokes for point in stroke.points)
    if team.scene.transit_altitude is not None:
        low = min(low, team.scene.transit_altitude)
    free = not team.scene.areas and team.scene.minimum_separation is None
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
        return min(sum(serve_seconds(each, p.robot, p.kinematics) for each in strokes) for p in pilots)
    materials = [team.forwards(task, name) for name in names] if team.whole(task) else []
    return min((each.seconds(0, len(each) - 1) for each in materials if each is not None), default=0.0)


def _places(team: Team, task: str) -> Places:
    """Return what must be visited for a task: each stroke; all of it where robots lay it out differently."""
    work = _shared(team, task)
    strokes = joined(work.strokes) if work is not None else ()
    groups = [each.points for each in strokes] or [
        tuple(p for each in _works(team, task).values() for stroke in each.strokes for p in stroke.points)
    ]
    hulls = [shapely.multipoints([point[:2] for point in points]).convex_hull for points in groups]
    return np.array(hulls, dtype=object)


def _spanned(places: Places, away: Array) -> Array:
    """Return the lengths of a shortest tree that spans places and what they are so far away from."""
    boxes = shapely.bounds(places)
    exact = len(places) <= _MOST and bool((boxes[:, :2] < boxes[:, 2:]).any())
    near, lengths = away.copy(), np.zeros(len(places))
    for i in range(len(places)):
        nearest = int(near.argmin())
        lengths[i] = near[nearest]
        if exact:
            closer = shapely.distance(places, places[nearest])
        else:
            gap = np.maximum(boxes[:, :2] - boxes[nearest, 2:], boxes[nearest, :2] - boxes[:, 2:])
            closer = np.linalg.norm(np.maximum(gap, 0.0), axis=1)
        near = np.where(near < inf, np.minimum(near, closer), inf)
        near[nearest] = inf
    return lengths


def _quickest(team: Team, names: Sequence[str], longest: float) -> Callable[[Array], Array]:
    """Return a function from level distances up to a longest to seconds that no robot falls below."""
    kinds = [team.pilots[name].kinematics for name in dict.fromkeys(team.kinds[name] for name in names)]
    short = max(0.05, *(kinematics.accepts for kinematics in kinds))
    lengths = np.concatenate([[0.0], np.geomspace(2.0 * short, max(4.0 * short, longest), 200)])
    least = np.full(len(lengths), inf)
    strokes = [stroke for work in distinct_works(team.scene.works) for stroke in work.strokes]
    for kinematics in kinds:
        speed = max(kinematics.cruise, *(commanded_speed(each, kinematics) for each in strokes))
        timing = replace(kinematics.timing, overshoot=0.0, lag=0.0)
        rates = replace(kinematics.rates(speed), timing=timing, shunting=0.0, accepts=0.0)
        times = [rates.from_stop_to_stop((0.0, 0.0, 0.0), (each, 0.0, 0.0)) for each in lengths.tolist()]
        least = np.minimum(least, times)
    # Seconds grow the more slowly the longer the leg: chords between points of that curve lie below it, the
    # first one also below what short legs count that are taken together.
    return lambda level: np.interp(level, lengths, least)
