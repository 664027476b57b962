"""What would bring a task into the range of a robot's radio; each remedy is tried before it is named."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, dist

import numpy as np

from mmrs_core.planning.jobs import jobs_of
from mmrs_core.planning.obstacles import Floats
from mmrs_core.planning.positions import SLACK
from mmrs_core.planning.reach import in_range_of, reach_of, unsure
from mmrs_core.planning.remedies import is_plannable, or_else, too_long
from mmrs_core.planning.team import Team
from mmrs_core.scene import Position, Robot, RobotType, Scene, Stroke, Task, Work
from mmrs_core.scene.relays import Relay, relays_of

_MOST_RELAYS = 3
"""Relays in a row that are tried where tasks are out of range."""

_HALVINGS = 60
"""Times that the stretch is cut on which the position of a relay is looked for."""


def for_radio(
    scene: Scene, task: Task, works: Mapping[str, Work], robot: Robot, relays: Sequence[Relay]
) -> str:
    """Return what would let a robot do a task that is out of its range, as the end of a sentence.

    What brings the task into range and is not enough is named with what is short then.

    Args:
        scene: expanded, but for works.
        task: that no robot can do.
        works: of that task, by robot, of those whose radio is all that is short.
        robot: one of these.
        relays: of the context, and all that robots may be.
    """
    enough, short = list[str](), ""
    for words, type, more in remedies_for(robot, relays, scene.position_error, works[robot.name].strokes):
        others = (each for each in scene.robots if each.name in works and each.name != robot.name)
        alone = _alone(scene, task, works, [replace(robot, type=type), *others], [*relays, *more])
        jobs = jobs_of(alone)
        if is_plannable(alone, jobs):
            enough.append(words if enough else f"for '{robot.name}', {words}")
        elif not short:
            team = Team(alone)
            reasons = [*team.shortfalls()] or too_long(team, jobs)
            short = f"; with {words}, {reasons[0]}" if reasons else ""
    return or_else(enough) or short


def _alone(
    scene: Scene, task: Task, works: Mapping[str, Work], robots: Sequence[Robot], relays: Sequence[Relay]
) -> Scene:
    """Return a scene with one task and as many robots in range as it needs, the first ones."""
    reaches = ((each, reach_of(each, relays, scene.position_error)) for each in robots)
    able = [each for each, reach in reaches if reach is None or in_range_of(reach, works[each.name].strokes)]
    able = able[: task.wanted or 1]
    return replace(
        scene,
        robots=tuple(able),
        tasks=(task,),
        dependencies=(),
        works={(task.name, each.name): works[each.name] for each in able},
        refusals={},
        stations=tuple(each for each in relays if each not in relays_of(scene.elements)),
    )


def remedies_for(
    robot: Robot, relays: Sequence[Relay], error: float, strokes: Sequence[Stroke]
) -> Iterator[tuple[str, RobotType, list[Relay]]]:
    """Yield what would bring strokes into a robot's range: a relay, or a short chain, or a farther range.

    Each comes in words, with the robot's type and the further relays then.
    """
    reach = reach_of(robot, relays, error)
    if reach is None or in_range_of(reach, strokes):
        return
    outside = [each for each in strokes if not reach.contains(each.points, unsure(each) - SLACK)]
    points = np.array([point for each in outside for point in each.points])
    needed = error + max(map(unsure, outside))
    for count in range(1, _MOST_RELAYS + 1):
        chains = [_chain_between(each, points, needed, robot.home[2], count) for each in reach.centres]
        for chain in sorted(chains, key=lambda each: each[0].range):
            more = reach_of(robot, [*relays, *chain], error)
            if more is not None and in_range_of(more, strokes):
                break
        else:
            continue
        at = " and ".join(
            "({:.0f}, {:.0f}, {:.0f})".format(*(round(p) + 0.0 for p in each.position)) for each in chain
        )
        named = "a relay" if count == 1 else f"{count} relays"
        yield f"{named} of range {chain[0].range:.0f} m at {at}", robot.type, chain
        break
    farthest = ceil(float(np.linalg.norm(points - np.array(robot.home), axis=1).max()) + needed)
    attributes = {**robot.type.part.attributes, "communicationRange": float(farthest)}
    type = replace(robot.type, part=replace(robot.type.part, attributes=attributes))
    yield f"a communicationRange of {farthest} m", type, []


def _chain_between(
    station: Position, points: Floats, needed: float, ground: float, count: int
) -> list[Relay]:
    """Return relays of the least range that lead from a station to some points, all on the ground."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0

    def at(share: float) -> list[Relay]:
        places = [station]
        for i in range(1, count + 1):
            part = share * i / count
            east, north = (a + part * (b - a) for a, b in zip(station[:2], middle[:2].tolist(), strict=True))
            places.append((float(round(east)), float(round(north)), ground))
        farthest = float(np.linalg.norm(points - np.array(places[-1]), axis=1).max()) + needed
        reach = float(ceil(max(farthest, *(dist(a, b) for a, b in pairwise(places)))))
        return [Relay(str(i), place, reach) for i, place in enumerate(places[1:])]

    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        one, two = low + (high - low) / 3.0, high - (high - low) / 3.0
        low, high = (low, two) if at(one)[0].range <= at(two)[0].range else (one, high)
    return min(at(low), at(high), key=lambda each: each[0].range)
