"""Keeps robots apart: finds when planned robots come too near to each other, and delays one of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations
from math import inf
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.segments import closest_approach
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.timeline import Track, track_of
from mmrs_core.scene import Plan, Scene

Indices: TypeAlias = NDArray[np.intp]

_ROUNDS = 60
_STEP = 2.0
"""Seconds by which delays are told apart."""

_LONGEST_DELAY = 36_000.0


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two robots that come too near to each other: when, and to how many metres."""

    first: str
    second: str
    time: float
    distance: float


def separated(scene: Scene, decisions: Decisions, planned: Callable[[Decisions], Plan | None]) -> Plan:
    """Return the plan of decisions, with robots' starts delayed until all keep apart.

    Robots at home, before they leave it and after they came back, are not counted.

    Args:
        scene: with or without a minimum separation.
        decisions: to begin with.
        planned: makes the plan of decisions; None where they lead to none.

    Raises:
        InfeasibleError: delays do not help, or lead to no plan.
    """
    found = planned(decisions)
    if found is None:
        raise InfeasibleError("no plan: the decisions found cannot be carried out")
    least = scene.minimum_separation
    if least is None or least <= 0:
        return found
    for _ in range(_ROUNDS):
        encounter = first_encounter(scene, found, least)
        if encounter is None:
            return found
        better = _resolved(scene, found, decisions, planned, encounter, least)
        if better is None:
            break
        decisions, found = better
    raise InfeasibleError(_words(first_encounter(scene, found, least), least))


def _resolved(
    scene: Scene,
    found: Plan,
    decisions: Decisions,
    planned: Callable[[Decisions], Plan | None],
    encounter: Encounter,
    least: float,
) -> tuple[Decisions, Plan] | None:
    """Return decisions, with their plan, in which an encounter is gone or comes later; None if none are.

    One of the two robots starts later, by as little as would do if all else stayed; where it waits for
    the other anyway, that changes nothing, and the other one is tried.
    """
    robots = {robot.name: robot for robot in scene.robots}
    steps = {each.robot: each.steps for each in found.robots}
    first = track_of(steps[encounter.first], robots[encounter.first])
    second = track_of(steps[encounter.second], robots[encounter.second])
    shifts = [
        (_shift(first, second, least), encounter.second),
        (_shift(second, first, least), encounter.first),
    ]
    for shift, name in sorted(shifts):
        delays = {**decisions.delays, name: decisions.delays.get(name, 0.0) + shift}
        later = replace(decisions, delays=delays)
        plan = planned(later) if shift < _LONGEST_DELAY else None
        left = None if plan is None else first_encounter(scene, plan, least)
        if plan is not None and (left is None or _is_progress(encounter, left)):
            return later, plan
    return None


def _is_progress(before: Encounter, after: Encounter) -> bool:
    alike = (before.first, before.second) == (after.first, after.second)
    return not alike or after.time > before.time + 0.5


def _shift(fixed: Track, late: Track, least: float) -> float:
    """Return by how many seconds a track must come later to keep apart from another; inf: never."""
    i, j = _near_in_space(fixed, late, least)
    longest = float(fixed.times.max() - late.times.min())
    for shift in np.arange(_STEP, longest + 2 * _STEP, _STEP).tolist():
        moved = Track(late.times + shift, late.places)
        if _nearest_of(fixed, moved, i, j, least) is None:
            return float(shift)
    return inf


def _near_in_space(one: Track, two: Track, least: float) -> tuple[Indices, Indices]:
    """Return pairs of pieces whose boxes come within a distance, whenever they are there."""
    low_one, high_one = one.places.min(axis=1)[:, None], one.places.max(axis=1)[:, None]
    low_two, high_two = two.places.min(axis=1)[None], two.places.max(axis=1)[None]
    near = ((low_one - least < high_two) & (low_two - least < high_one)).all(axis=2)
    i, j = np.nonzero(near)
    return i, j


def _words(encounter: Encounter | None, least: float) -> str:
    if encounter is None:
        return "no plan keeps robots apart"
    return (
        f"robots '{encounter.first}' and '{encounter.second}' come within {encounter.distance:.1f} m"
        f" after {encounter.time:.0f} s, {least:g} m are required: {least - encounter.distance:.1f} m short;"
        " starting later does not help"
    )


def first_encounter(scene: Scene, plan: Plan, least: float) -> Encounter | None:
    """Return the earliest encounter nearer than `least` metres; None if there is none."""
    robots = {robot.name: robot for robot in scene.robots}
    tracks = {each.robot: track_of(each.steps, robots[each.robot]) for each in plan.robots if each.steps}
    found = [
        Encounter(one, two, *nearest)
        for one, two in combinations(tracks, 2)
        if (nearest := _nearest(tracks[one], tracks[two], least)) is not None
    ]
    return min(found, key=lambda each: each.time, default=None)


def _nearest(one: Track, two: Track, least: float) -> tuple[float, float] | None:
    """Return (time, distance) at the beginning of the first encounter of two tracks."""
    return _nearest_of(one, two, *_near_in_space(one, two, least), least)


def _nearest_of(one: Track, two: Track, i: Indices, j: Indices, least: float) -> tuple[float, float] | None:
    """Return the same for certain pairs of pieces only."""
    start = np.maximum(one.times[i, 0], two.times[j, 0])
    stop = np.minimum(one.times[i, 1], two.times[j, 1])
    meet = start < stop
    if not meet.any():
        return None
    i, j, start, stop = i[meet], j[meet], start[meet], stop[meet]
    first = np.stack([one.at(i, start), one.at(i, stop)], axis=1)
    second = np.stack([two.at(j, start), two.at(j, stop)], axis=1)
    distance, when = closest_approach(first, second, start, stop)
    near = np.flatnonzero(distance < least - 1e-6)
    if not len(near):
        return None
    earliest = near[np.argmin(when[near])]
    return float(when[earliest]), float(distance[earliest])


def stacked_altitudes(scene: Scene) -> dict[str, float]:
    """Return transit altitudes for robots that launch, one above the other by the minimum separation.

    The lowest is the scene's own, or the height of the highest stroke. Empty where robots need not keep
    apart, or the lowest ceiling leaves no room for a second.
    """
    least = scene.minimum_separation or 0.0
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
