"""Keeps robots apart: finds when planned robots come too near to each other, and delays one of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.segments import closest_approach
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.timeline import Track, track_of
from mmrs_core.scene import Plan, Scene

_ROUNDS = 60
_LONGEST_DELAY = 3600.0


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
    before: Encounter | None = None
    for _ in range(_ROUNDS):
        encounter = first_encounter(scene, found, least)
        if encounter is None:
            return found
        decisions = _delayed(scene, decisions, encounter, least, before)
        later = planned(decisions)
        if later is None or max(decisions.delays.values()) > _LONGEST_DELAY:
            break
        found, before = later, encounter
    raise InfeasibleError(_words(first_encounter(scene, found, least), least))


def _words(encounter: Encounter | None, least: float) -> str:
    if encounter is None:
        return "no plan keeps robots apart"
    return (
        f"robots '{encounter.first}' and '{encounter.second}' come within {encounter.distance:.1f} m"
        f" after {encounter.time:.0f} s, {least:g} m are required: {least - encounter.distance:.1f} m short;"
        " starting later does not help"
    )


def _delayed(
    scene: Scene, decisions: Decisions, encounter: Encounter, least: float, before: Encounter | None
) -> Decisions:
    """Delay one of the robots by the time in which it goes twice the distance.

    It is the one that comes later in the team, unless delaying that one changed nothing: then it waits
    for the other anyway.
    """
    again = before is not None and (before.first, before.second) == (encounter.first, encounter.second)
    stays = before is not None and again and abs(before.time - encounter.time) < 0.5
    name = encounter.first if stays else encounter.second
    kinematics = scene.robot(name).kinematics
    speed = kinematics.cruise if kinematics is not None else 1.0
    delays = dict(decisions.delays)
    delays[name] = delays.get(name, 0.0) + max(1.0, 2.0 * least / speed)
    return replace(decisions, delays=delays)


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
    begin = np.maximum(one.times[:, None, 0], two.times[None, :, 0])
    end = np.minimum(one.times[:, None, 1], two.times[None, :, 1])
    i, j = np.nonzero(begin < end)
    if not len(i):
        return None
    start, stop = begin[i, j], end[i, j]
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
