"""Robots that are relays where they hold their position, and during which moves of others they surely are.

A robot whose type has a relayRange passes on the radio of others wherever it stands; one that launches does
so off the ground only. A robot may count on it in a move if the stand is certain: in every run the robot
comes to its place before that move begins, and leaves it, if ever, after the move is over. Either follows
from what robots wait for, however uncertain times are, or from times that are certain enough.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import dist, inf

from mmrs_core.analysis.dependencies import At, certain_moves
from mmrs_core.analysis.figures import MissingFigureError
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.states import GROUNDED, States, possible_states, states_of
from mmrs_core.analysis.times import order_of, times_of
from mmrs_core.analysis.verdicts import once
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene import Position
from mmrs_core.scene.relays import Relay, relay_range

_SAME = 1e-6
"""Metres within which a robot stays where it is."""


@dataclass(frozen=True, slots=True)
class Stand:
    """A place at which a robot is a relay.

    Attributes:
        relay: with the robot's name.
        after: the move that leads there, which the robot makes in every run.
        until: the moves with whose begin it may leave, or may come down.
    """

    relay: Relay
    after: At
    until: tuple[At, ...]


def stands_of(input: CheckInput) -> tuple[Stand, ...]:
    """Return where robots are relays for longer than in passing; found once for all checks."""
    return once(input, _stands)


def _stands(input: CheckInput) -> tuple[Stand, ...]:
    found = list[Stand]()
    for robot in input.program.robots:
        type = input.types.get(robot.type_name)
        range = None if type is None else relay_range(type)
        if range is not None:
            found += _Standing(input, robot, range).all()
    return tuple(found)


def _states_of(input: CheckInput, robot: RobotProgram) -> States:
    try:
        return states_of(input, robot)
    except MissingFigureError:
        return possible_states(input, robot)


class _Standing:
    def __init__(self, input: CheckInput, robot: RobotProgram, range: float) -> None:
        self._robot, self._range, self._error = robot, range, input.program.position_error
        self._states = _states_of(input, robot)
        self._paths: dict[int, list[MovePath]] = {}
        motion = motions(input)[robot.id]
        for path in motion.paths:
            self._paths.setdefault(path.move, []).append(path)
        self._unknown = {gap.move for gap in motion.gaps}

    def all(self) -> Iterator[Stand]:
        """Yield the stands of the robot."""
        for move in sorted(certain_moves(self._robot) - {self._robot.start, self._robot.stop}):
            place = self._end_of(move)
            if place is None or self._stays(move, place):
                continue
            holds, until = self._from(move, place)
            if holds:
                centre, spread = place
                relay = Relay(self._robot.id, centre, self._range, spread + self._error)
                name = self._robot.id
                yield Stand(relay, (name, move), tuple((name, each) for each in until))

    def _end_of(self, move: int) -> tuple[Position, float] | None:
        """Return where a move ends away from the ground, and how far from there; None: not known."""
        paths = self._paths.get(move, ())
        if not paths or move in self._unknown or GROUNDED in self._states.after[move]:
            return None
        end, spread = paths[0].points[-1], max(path.radius for path in paths)
        return (end, spread) if all(dist(path.points[-1], end) <= _SAME for path in paths) else None

    def _stays(self, move: int, place: tuple[Position, float]) -> bool:
        """Return whether a robot that is at a place stays there all through a move."""
        paths = self._paths.get(move, ())
        still = all(dist(point, place[0]) <= _SAME for path in paths for point in path.points)
        return bool(paths) and still and self._end_of(move) is not None

    def _from(self, move: int, place: tuple[Position, float]) -> tuple[bool, tuple[int, ...]]:
        """Return whether a robot holds or waits where a move ends, and the moves with which it may leave."""
        holds, until = False, dict[int, None]()
        seen, pending = {move}, [move]
        while pending:
            transition = self._robot.transitions.get(pending.pop())
            if transition is None:
                continue
            holds |= bool(transition.waits)
            for after in transition.next_moves:
                if after == self._robot.stop or not self._stays(after, place):
                    until[after] = None
                elif after not in seen:
                    holds = True
                    seen.add(after)
                    pending.append(after)
        return holds, tuple(until)


def certain_stands(input: CheckInput, robot: RobotProgram, move: int, *, waiting: bool) -> list[Relay]:
    """Return the other robots that are certainly relays, and where, during a move of a robot.

    Args:
        input: with the whole behaviour.
        robot: that makes the move.
        move: index of it.
        waiting: whether the wait after the move is meant instead.
    """
    others = [stand for stand in stands_of(input) if stand.after[0] != robot.id]
    if not others:
        return []
    span = _Span(input, robot, move, waiting)
    return [stand.relay for stand in others if span.is_within(stand)]


class _Span:
    """A move of a robot, or the wait after it: when it begins and ends."""

    def __init__(self, input: CheckInput, robot: RobotProgram, move: int, waiting: bool) -> None:
        self._order, self._times = order_of(input), times_of(input)
        self._at, self._waiting = (robot.id, move), waiting
        latest: Mapping[At, float] = self._times.latest
        transition = robot.transitions.get(move)
        after = transition.next_moves if waiting and transition is not None else ()
        begun = [latest.get((robot.id, each), inf) for each in after]
        self._ended = max(begun) if begun else self._times.latest_end(robot.id, move)

    def is_within(self, stand: Stand) -> bool:
        """Return whether a robot stands at its place from before the begin to after the end."""
        name, index = stand.after
        arrived = self._order.is_over(stand.after, False, self._at) or (
            self._times.latest_end(name, index) <= self._times.earliest.get(self._at, inf)
        )
        return arrived and all(
            self._order.is_over(self._at, self._waiting, leave)
            or self._ended <= self._times.earliest.get(leave, inf)
            for leave in stand.until
        )
