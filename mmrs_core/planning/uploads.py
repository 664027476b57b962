"""Which legs of planned robots are flown as missions that are uploaded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from mmrs_core.planning.corners import InMissions, runs_between
from mmrs_core.planning.flown_legs import halts_of
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.strokes import commanded_speed, stops_of
from mmrs_core.planning.timeline import moves_along
from mmrs_core.scene import Position, RobotPlan, Serve, Transit


class _Move(NamedTuple):
    """A move of a step.

    Attributes:
        step: by its identity. legs: their numbers in it.
        start, end: of the move. speed: commanded, metres per second; None: the robot's cruise.
    """

    step: int
    legs: range
    start: Position
    end: Position
    speed: float | None


class Uploads:
    """Finds missions in plans of the same robots; what steps and corners of them have in common, once."""

    def __init__(self, pilots: Mapping[str, Pilot]) -> None:
        """Make it.

        Args:
            pilots: by name of robot.
        """
        self._pilots = pilots
        self._passes = dict[tuple[str, Position, Position, Position, float | None], bool]()

    def of(self, plan: RobotPlan) -> dict[int, InMissions]:
        """Return, by identity of each step on the way of a robot, which of its legs are part of missions."""
        pilot = self._pilots[plan.robot]
        moves, halts, stopped = list[_Move](), list[bool](), True
        for step in plan.steps if pilot.travel.uploading is not None else ():
            if not isinstance(step, Transit | Serve):
                stopped = True
                continue
            stopped = stopped or (isinstance(step, Serve) and halts_of(step.stroke, pilot.robot.type)[0])
            for move, stops in _moves(step, pilot):
                halts.append(stopped or not self._may_pass(plan.robot, moves[-1], move))
                moves.append(move)
                stopped = stops
        found = {id(step): InMissions() for step in plan.steps}
        for run, _ in runs_between([*halts, True], (0, 0)) if moves else ():
            for i in run:
                before = found[moves[i].step]
                found[moves[i].step] = InMissions(
                    before.legs.union(moves[i].legs), before.ends + (i == run[-1])
                )
        return found

    def _may_pass(self, robot: str, one: _Move, two: _Move) -> bool:
        key = robot, one.start, two.start, two.end, one.speed
        corners = self._pilots[robot].travel.uploading
        if key not in self._passes:
            self._passes[key] = corners is not None and corners.may_pass(*key[1:])
        return self._passes[key]


def _moves(step: Transit | Serve, pilot: Pilot) -> Iterator[tuple[_Move, bool]]:
    """Yield the moves of a step, and whether the robot stops for certain after each."""
    if isinstance(step, Serve):
        speed, halts = commanded_speed(step.stroke, pilot.kinematics), halts_of(step.stroke, pilot.robot.type)
        for i, (start, end) in enumerate(pairwise(stops_of(step.stroke))):
            yield _Move(id(step), range(i, i + 1), start, end, speed), halts[i + 1]
        return
    done = 0
    for points in moves_along(list(pairwise(step.route))):
        legs = range(done, done + len(points) - 1)
        yield _Move(id(step), legs, points[0], points[-1], step.speed), False
        done = legs.stop
