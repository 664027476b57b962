"""Keeps robots apart: finds when planned robots come too near to each other, and delays one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise
from math import dist
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.segments import closest_approach
from mmrs_core.planning.schedule import Decisions
from mmrs_core.scene import (
    Branch,
    Launch,
    Plan,
    Position,
    Recharge,
    Recover,
    Robot,
    Scene,
    Serve,
    Step,
    Transit,
)

Floats: TypeAlias = NDArray[np.float64]

_ROUNDS = 60
_LONGEST_DELAY = 3600.0


@dataclass(frozen=True, slots=True)
class Track:
    """Where a robot is while it is away from home, as pieces that it moves along steadily.

    Attributes:
        times: (n, 2) seconds at which each piece begins and ends.
        places: (n, 2, 3) where it is then.
    """

    times: Floats
    places: Floats


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
        decisions = _delayed(scene, decisions, encounter, least)
        later = planned(decisions)
        if later is None or max(decisions.delays.values()) > _LONGEST_DELAY:
            break
        found = later
    raise InfeasibleError(_words(first_encounter(scene, found, least), least))


def _words(encounter: Encounter | None, least: float) -> str:
    if encounter is None:
        return "no plan keeps robots apart"
    return (
        f"robots '{encounter.first}' and '{encounter.second}' come within {encounter.distance:.1f} m"
        f" after {encounter.time:.0f} s, {least:g} m are required: {least - encounter.distance:.1f} m short;"
        " starting later does not help"
    )


def _delayed(scene: Scene, decisions: Decisions, encounter: Encounter, least: float) -> Decisions:
    """Delay the robot that comes later in the team, by the time in which it goes twice the distance."""
    kinematics = scene.robot(encounter.second).kinematics
    speed = kinematics.cruise if kinematics is not None else 1.0
    delays = dict(decisions.delays)
    delays[encounter.second] = delays.get(encounter.second, 0.0) + max(1.0, 2.0 * least / speed)
    return replace(decisions, delays=delays)


def first_encounter(scene: Scene, plan: Plan, least: float) -> Encounter | None:
    """Return the earliest encounter nearer than `least` metres; None if there is none."""
    robots = {robot.name: robot for robot in scene.robots}
    tracks = {each.robot: track(each.steps, robots[each.robot]) for each in plan.robots if each.steps}
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
    first = np.stack([_where(one, i, start), _where(one, i, stop)], axis=1)
    second = np.stack([_where(two, j, start), _where(two, j, stop)], axis=1)
    distance, when = closest_approach(first, second, start, stop)
    near = np.flatnonzero(distance < least - 1e-6)
    if not len(near):
        return None
    earliest = near[np.argmin(when[near])]
    return float(when[earliest]), float(distance[earliest])


def _where(track: Track, piece: NDArray[np.intp], time: Floats) -> Floats:
    begin, end = track.times[piece, 0], track.times[piece, 1]
    share = ((time - begin) / np.where(end > begin, end - begin, 1.0))[:, None]
    place: Floats = track.places[piece, 0] + share * (track.places[piece, 1] - track.places[piece, 0])
    return place


def track(steps: Sequence[Step], robot: Robot) -> Track:
    """Return where a robot is from each time it leaves home until it is back; the longest arm counts."""
    pieces = [piece for piece in _pieces(steps, robot.home) if piece[1] > piece[0]]
    return Track(
        np.array([piece[:2] for piece in pieces], dtype=np.float64).reshape(-1, 2),
        np.array([piece[2:] for piece in pieces], dtype=np.float64).reshape(-1, 2, 3),
    )


_Piece: TypeAlias = tuple[float, float, Position, Position]


def _pieces(steps: Sequence[Step], here: Position) -> Iterator[_Piece]:
    away = False
    for step in steps:
        if isinstance(step, Branch):
            longest = max((arm for _, arm in step.arms), key=lambda arm: arm[-1].end if arm else 0.0)
            yield from _pieces(longest, here)
            if longest and longest[-1].end < step.end:
                yield (longest[-1].end, step.end, step.exit, step.exit)
            here = step.exit
            continue
        line = _line(step, here)
        away = not isinstance(step, Recharge) and (away or len(line) > 1 or isinstance(step, Launch))
        if away:
            yield from _along(line, step.begin, step.end)
        here = line[-1]
        if isinstance(step, Recover):
            away = False


def _line(step: Step, here: Position) -> tuple[Position, ...]:
    if isinstance(step, Launch):
        return (step.at, (step.at[0], step.at[1], step.up))
    if isinstance(step, Recover):
        return (step.at, (step.at[0], step.at[1], step.up))
    if isinstance(step, Transit):
        return step.route
    return step.stroke.points if isinstance(step, Serve) else (here,)


def _along(line: Sequence[Position], begin: float, end: float) -> Iterator[_Piece]:
    """Yield the pieces of a line that is followed steadily; stops on the way are spread over it."""
    whole = sum(dist(one, two) for one, two in pairwise(line))
    if whole <= 0.0:
        yield (begin, end, line[-1], line[-1])
        return
    now = begin
    for one, two in pairwise(line):
        later = now + (end - begin) * dist(one, two) / whole
        yield (now, later, one, two)
        now = later
