"""Where a planned robot is at each moment: its steps as pieces that it moves along steadily."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist, inf
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.layers import Rates
from mmrs_core.planning.strokes import NEAR, action_seconds, rates_of, stops_of
from mmrs_core.planning.travel import kinematics_of
from mmrs_core.scene import Branch, Launch, Position, Recover, Robot, Serve, Step, Transit

Floats: TypeAlias = NDArray[np.float64]
Piece: TypeAlias = tuple[float, float, Position, Position]
"""Seconds at which it begins and ends, and where the robot is then."""


@dataclass(frozen=True, slots=True)
class Track:
    """Where a robot is while it is away from home.

    Attributes:
        times: (n, 2) seconds at which each piece begins and ends.
        places: (n, 2, 3) where the robot is then.
    """

    times: Floats
    places: Floats

    def at(self, piece: NDArray[np.intp], time: Floats) -> Floats:
        """Return (m, 3) where the robot is at m times within m pieces."""
        begin, end = self.times[piece, 0], self.times[piece, 1]
        share = ((time - begin) / np.where(end > begin, end - begin, 1.0))[:, None]
        start = self.places[piece, 0]
        place: Floats = start + share * (self.places[piece, 1] - start)
        return place


def track_of(steps: Sequence[Step], robot: Robot) -> Track:
    """Return where a robot is from each time it leaves home until it is back; the longest arm counts."""
    pieces = [piece for piece in _away(steps, robot) if piece[1] > piece[0]]
    return Track(
        np.array([piece[:2] for piece in pieces], dtype=np.float64).reshape(-1, 2),
        np.array([piece[2:] for piece in pieces], dtype=np.float64).reshape(-1, 2, 3),
    )


def _away(steps: Sequence[Step], robot: Robot) -> Iterator[Piece]:
    """Yield the pieces during which a robot is neither at home nor on the ground."""
    grounded = True
    for step, pieces in _pieces(steps, robot, robot.home):
        if isinstance(step, Launch) or not kinematics_of(robot).launches:
            grounded = False
        for piece in pieces:
            if not grounded and not (piece[2] == piece[3] == robot.home):
                yield piece
        if isinstance(step, Recover):
            grounded = True


def _pieces(steps: Sequence[Step], robot: Robot, here: Position) -> Iterator[tuple[Step, list[Piece]]]:
    for step in steps:
        if isinstance(step, Branch):
            longest = max((arm for _, arm in step.arms), key=lambda arm: arm[-1].end if arm else -inf)
            yield from _pieces(longest, robot, here)
            end = longest[-1].end if longest else step.begin
            yield step, [(end, step.end, step.exit, step.exit)]
            here = step.exit
        else:
            pieces = list(_of_step(step, robot, here))
            yield step, pieces
            here = pieces[-1][3] if pieces else here


def _of_step(step: Step, robot: Robot, here: Position) -> Iterator[Piece]:
    """Yield a step's pieces; what is left of its time is spent where it ends."""
    now = step.begin
    for seconds, place in _stops(step, robot, here):
        later = min(now + seconds, step.end)
        yield (now, later, here, place)
        now, here = later, place
    if now < step.end:
        yield (now, step.end, here, here)


def _stops(step: Step, robot: Robot, here: Position) -> Iterator[tuple[float, Position]]:
    """Yield (seconds, where the robot is after them) through a step."""
    kinematics = kinematics_of(robot)
    rates = rates_of(kinematics, kinematics.cruise)
    if isinstance(step, Launch):
        yield kinematics.launch, step.at
        yield rates.rise(step.up - step.at[2]), (step.at[0], step.at[1], step.up)
    elif isinstance(step, Recover):
        yield rates.rise(step.up - step.at[2]), (step.at[0], step.at[1], step.up)
    elif isinstance(step, Transit):
        for one, two in pairwise(step.route):
            yield rates.from_stop_to_stop(one, two), two
    elif isinstance(step, Serve):
        yield from _served(step, robot, rates_of(kinematics, step.speed))


def _served(step: Serve, robot: Robot, rates: Rates) -> Iterator[tuple[float, Position]]:
    todo = list(step.stroke.actions)
    stops = stops_of(step.stroke)
    done, here = 0.0, stops[0]
    for place in stops:
        done += dist(here, place)
        yield rates.from_stop_to_stop(here, place), place
        here = place
        while todo and todo[0].at <= done + NEAR:
            yield action_seconds(robot.type, todo.pop(0)), place
