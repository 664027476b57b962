"""Keeps robots apart: finds when planned robots may come too near to each other, and delays one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import dist

import numpy as np

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.proximity import ClosePairs, Floats, TimedTrack, near_pairs, track_of
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.timeline import rides_of
from mmrs_core.scene import Plan, Position, Scene

_ROUNDS = 60
_LONGEST_DELAY = 36_000.0

_ROUNDING = 1e-3
"""Metres that robots keep apart beyond what is required, since files round coordinates."""

_SPARE = 0.05
"""Seconds that robots are apart in time at one place, since times follow from rounded coordinates."""

_PARTS = 8
"""Pieces as long as the distance to keep are distinguished in so many parts, but none shorter than 0.5 m."""


class TooNearError(InfeasibleError):
    """Robots cannot be kept apart.

    Attributes:
        at_home: whether one of those that come too near first stands at its home.
        robots: names of those two; empty where they are unknown.
    """

    def __init__(self, conflict: Conflict | None, least: float, homes: Mapping[str, Position]) -> None:
        super().__init__(_words(conflict, least, homes))
        self.at_home = conflict is not None and conflict.at_home
        self.robots = frozenset() if conflict is None else frozenset((conflict.first, conflict.second))


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two robots that may come too near to each other: when, to how many metres, and if one is at home."""

    first: str
    second: str
    time: float
    distance: float
    at_home: bool


def distance_to_keep(scene: Scene) -> float | None:
    """Return the metres that planned robots keep apart; None where none are asked for.

    Each of two robots may be off by the position error, and by the radius that it turns in.
    """
    if scene.minimum_separation is None or scene.minimum_separation <= 0:
        return None
    radii = sorted(robot.kinematics.turning_radius for robot in scene.robots if robot.kinematics is not None)
    return scene.minimum_separation + 2.0 * scene.position_error + sum(radii[-2:]) + _ROUNDING


def separated(scene: Scene, decisions: Decisions, planned: Callable[[Decisions], Plan | None]) -> Plan:
    """Return the plan of decisions, with robots' starts delayed until all keep apart.

    Robots on the ground and at home count as all others do, but for neighbouring homes (see `near_pairs`).

    Args:
        scene: with or without a minimum separation.
        decisions: to begin with.
        planned: makes the plan of decisions; None where they lead to none.

    Raises:
        TooNearError: delays do not help, or lead to no plan.
    """
    found = planned(decisions)
    if found is None:
        raise InfeasibleError("no plan: the decisions found cannot be carried out")
    least = distance_to_keep(scene)
    if least is None:
        return found
    for _ in range(_ROUNDS):
        tracks = tracks_of(scene, found)
        conflict = earliest_conflict(tracks, least)
        if conflict is None:
            return found
        better = _resolved(scene, tracks, decisions, planned, conflict, least)
        if better is None:
            break
        decisions, found = better
    homes = {robot.name: robot.home for robot in scene.robots}
    raise TooNearError(first_conflict(scene, found, least), least, homes)


def _resolved(
    scene: Scene,
    tracks: Mapping[str, TimedTrack],
    decisions: Decisions,
    planned: Callable[[Decisions], Plan | None],
    conflict: Conflict,
    least: float,
) -> tuple[Decisions, Plan] | None:
    """Return decisions, with their plan, in which an conflict is gone or comes later; None if none are.

    One of the two robots starts later, by as little as would do if all else stayed; where it waits for
    the other anyway, that changes nothing, and the other one is tried.
    """
    pairs = near_pairs(tracks[conflict.first], tracks[conflict.second], least, finest=_finest(least))
    shifts = [(_shift(pairs.one, pairs.two), conflict.second), (_shift(pairs.two, pairs.one), conflict.first)]
    for shift, name in sorted(shifts):
        delays = {**decisions.delays, name: decisions.delays.get(name, 0.0) + shift}
        later = replace(decisions, delays=delays)
        plan = planned(later) if shift < _LONGEST_DELAY else None
        left = None if plan is None else first_conflict(scene, plan, least)
        if plan is not None and (left is None or _is_progress(conflict, left)):
            return later, plan
    return None


def _is_progress(before: Conflict, after: Conflict) -> bool:
    alike = (before.first, before.second) == (after.first, after.second)
    return not alike or after.time > before.time + 0.5


def _shift(fixed: Floats, late: Floats) -> float:
    """Return by how many whole seconds a robot must come later to keep apart from another; inf: never.

    Args:
        fixed: (n, 2): when the other one begins and ends each piece that is near to one of it.
        late: (n, 2): the same of those pieces of its own.
    """
    begins, ends = fixed[:, 0] - late[:, 1] - _SPARE, fixed[:, 1] - late[:, 0] + _SPARE
    shift = 1.0
    for i in np.argsort(begins).tolist():
        if begins[i] < shift < ends[i]:
            shift = float(np.ceil(ends[i]))
    return shift


def _finest(least: float) -> float:
    return max(0.5, least / _PARTS)


def _words(conflict: Conflict | None, least: float, homes: Mapping[str, Position]) -> str:
    if conflict is None:
        return "no plan keeps robots apart"
    at_home = ", one of them at its home" if conflict.at_home else ""
    apart = dist(homes[conflict.first], homes[conflict.second])
    near = f" (their homes are {apart:.1f} m apart)" if apart < least else ""
    return (
        f"robots '{conflict.first}' and '{conflict.second}' come within {conflict.distance:.1f} m"
        f" after {conflict.time:.0f} s{at_home}{near}, {least:g} m are required:"
        f" {least - conflict.distance:.1f} m short; starting later does not help"
    )


def tracks_of(scene: Scene, plan: Plan) -> dict[str, TimedTrack]:
    """Return the tracks of all robots, those without work included."""
    robots = {robot.name: robot for robot in scene.robots}
    return {name: track_of(rides, robots[name].home) for name, rides in rides_of(plan, robots).items()}


def first_conflict(scene: Scene, plan: Plan, least: float) -> Conflict | None:
    """Return the earliest conflict nearer than `least` metres; None if there is none."""
    return earliest_conflict(tracks_of(scene, plan), least)


def earliest_conflict(tracks: Mapping[str, TimedTrack], least: float) -> Conflict | None:
    """Return the same of tracks."""
    found: Iterable[Conflict | None] = (
        _met(one, two, near_pairs(tracks[one], tracks[two], least, finest=_finest(least), spare=_SPARE))
        for one, two in _neighbours(tracks, least)
    )
    return min((each for each in found if each is not None), key=lambda each: each.time, default=None)


def _neighbours(tracks: Mapping[str, TimedTrack], least: float) -> Iterator[tuple[str, str]]:
    names = [name for name, track in tracks.items() if len(track.times)]
    boxes = np.array([tracks[name].box() for name in names]).reshape(-1, 2, 3)
    low, high = boxes[:, 0], boxes[:, 1]
    for i, name in enumerate(names):
        near = (low[i] < high[i + 1 :] + least).all(axis=1) & (low[i + 1 :] < high[i] + least).all(axis=1)
        for j in np.flatnonzero(near).tolist():
            yield name, names[i + 1 + j]


def _met(one: str, two: str, pairs: ClosePairs) -> Conflict | None:
    if not len(pairs.distance):
        return None
    times = np.maximum(pairs.one[:, 0], pairs.two[:, 0])
    time = max(0.0, float(times.min()))
    soon = times <= time + 1.0
    nearest, at_home = float(pairs.distance[soon].min()), bool(pairs.at_home[soon].any())
    return Conflict(one, two, time, max(0.0, nearest), at_home)


def stacked_altitudes(scene: Scene) -> dict[str, float]:
    """Return transit altitudes for robots that launch, one above the other by the minimum separation.

    The lowest is the scene's own, or the height of the highest stroke. Empty where robots need not keep
    apart, or the lowest ceiling leaves no room for a second.
    """
    least = distance_to_keep(scene) or 0.0
    robots = [robot for robot in scene.robots if robot.kinematics is not None and robot.kinematics.launches]
    heights = [
        point[2] for work in scene.works.values() for stroke in work.strokes for point in stroke.points
    ]
    if least <= 0.0 or len(robots) < 2 or not heights:
        return {}
    lowest = max(heights) if scene.transit_altitude is None else scene.transit_altitude
    ceiling = min(robot.kinematics.ceiling for robot in robots if robot.kinematics is not None)
    levels = max(1, int((ceiling - lowest) / (least + 0.1)) + 1) if ceiling < 1e6 else len(robots)
    if levels < 2:
        return {}
    return {robot.name: lowest + (i % levels) * (least + 0.1) for i, robot in enumerate(robots)}
