"""How a robot's moves are flown: which as a mission, and which ends it passes without a stop."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

from mmrs_core.behaviour.program import BEHAVIOUR
from mmrs_core.behaviour.walk import successors
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.scene.passing import SHORTEST_RUN, goes_straight, passed

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Move, RobotProgram, Transition
    from mmrs_core.scene import Kinematics, Name, Position, RobotType
    from mmrs_core.scene.passing import Passage
    from mmrs_core.scene.timing import Push

RECHARGE = (BEHAVIOUR, "Recharge")


class Passages:
    """The moves of a robot that its autopilot takes as a mission, and the ends that it passes.

    An autopilot that takes missions in a way of its own is given the robot's runs as missions; it stops at
    the end of a run's first move, and where the path turns. One that needs room to turn passes every end of
    a run but the last, and an autopilot of which nothing is known every end that it may. A run on which the
    robot looks at one place is a mission only where it is quicker so.

    Attributes:
        runs: that are missions, as indices of moves.
    """

    def __init__(
        self,
        robot: RobotProgram,
        type: RobotType | None,
        move_kinds: Mapping[Name, MoveKind],
        kinematics: Kinematics,
        *,
        local: bool,
    ) -> None:
        """Find the runs of a robot.

        Args:
            robot: of a behaviour.
            type: of the robot; None: not known.
            move_kinds: by metaclass.
            kinematics: of the robot.
            local: whether the behaviour has no place on the Earth, so that no mission can be uploaded.
        """
        self._robot, self._move_kinds, self._kinematics = robot, move_kinds, kinematics
        self._mission, self._careful = kinematics.in_mission(), kinematics.mission is not None
        self._index = {move.id: index for index, move in enumerate(robot.moves)}
        late = replace(self._mission.timing, settling=self._mission.timing.settling + kinematics.noticing)
        self._ending = replace(self._mission, timing=late)
        self._stops = kinematics.turning_radius <= 0.0
        self._fly(())
        found = runs_of(robot, type, move_kinds) if self._careful and not local else ()
        self._fly(tuple(run for run in found if robot.moves[run[0]].heading is None or self._is_quicker(run)))
        self._saved = dict(self._saved_for_certain()) if self._stops and self._mission.timing.passes else {}

    def _fly(self, runs: tuple[tuple[int, ...], ...]) -> None:
        """Take runs as missions."""
        self.runs = runs
        self._uploaded = frozenset(index for run in runs for index in run)
        self._lasts = frozenset(run[-1] for run in runs)
        self._held = frozenset(run[0] for run in runs if self._stops)
        expected = self._kinematics.setting_out().expected
        self._first = frozenset(self._setting_out()) if expected else frozenset()

    def _is_quicker(self, run: tuple[int, ...]) -> bool:
        """Return whether a run takes less time as a mission than leg by leg."""
        stepped = self._seconds(run)
        self._fly((run,))
        return self._seconds(run) < stepped

    def _seconds(self, run: Sequence[int]) -> float:
        return sum(seconds - saved for _, seconds, saved in self._timed(run))

    def _saved_for_certain(self) -> Iterator[tuple[int, float]]:
        for run in self.runs:
            if inner := frozenset(_passed(self._robot, run)):
                yield from ((index, saved) for index, _, saved in self._timed(run) if index in inner)

    def _timed(self, run: Sequence[int]) -> Iterator[tuple[int, float, float]]:
        """Yield the moves of a run with their seconds between two stops, and those that passing saves."""
        here = self._place_before(run[0])
        passage: Passage | None = None
        for index in run:
            move = self._robot.moves[index]
            name = most_specific(move.metaclasses, self._move_kinds)
            target = move.target.position if move.target is not None else None
            if here is not None and name is not None and target is not None:
                path, known = (here, target), self.kinematics(move)
                seconds = self._move_kinds[name].seconds(move, path, known, self._robot.travel_mode).expected
                saved = passage.onward if passage is not None else 0.0
                passage = self.ahead(move, path, passage)
                yield index, seconds, saved + (passage.saved if passage is not None else 0.0)
            here = target

    def kinematics(self, move: Move) -> Kinematics:
        """Return what the robot can do in a move."""
        index = self._index[move.id]
        known = self._mission if index in self._uploaded else self._kinematics
        known = self._ending if index in self._lasts else known
        return replace(known, sets_out=True) if index in self._first else known

    def saved(self, move: Move) -> float | None:
        """Return the seconds that a move takes less since it begins and ends without a stop for certain.

        It is part of a mission then. None: it is not certain.
        """
        return self._saved.get(self._index[move.id])

    @cached_property
    def _before(self) -> Mapping[int, int]:
        return {to: source for source, each in self._robot.transitions.items() for to in each.next_moves}

    def _place_before(self, index: int) -> Position | None:
        """Return where a robot is when it begins a move: where the nearest move before that led."""
        passed = {index}
        while (source := self._before.get(index)) is not None and source not in passed:
            target = self._robot.moves[source].target
            if target is not None and target.position is not None:
                return target.position
            passed.add(source)
            index = source
        return self._robot.home

    def _setting_out(self) -> Iterator[int]:
        """Yield the moves before which the robot may have to set out.

        These are the first ones and those after charging, before which motors may be off; of a robot that
        launches, those after that which are commanded one by one.
        """
        moves, launches = self._robot.moves, self._kinematics.launches
        names = [most_specific(move.metaclasses, self._move_kinds) for move in moves]
        kinds = [None if name is None else self._move_kinds[name] for name in names]
        rests = [i == self._robot.start or move.is_a(RECHARGE) for i, move in enumerate(moves)]
        rises = [kind is not None and kind.leaves == "airborne" for kind in kinds]
        pending = [index for index, counts in enumerate(rises if launches else rests) if counts]
        after, seen = successors(self._robot), set[int]()
        while pending:
            for index in set(after[pending.pop()]) - seen:
                seen.add(index)
                if (kind := kinds[index]) is not None and "grounded" in kind.needs:
                    pending.append(index)
                elif not launches or index not in self._uploaded:
                    yield index

    def facing(self, move: Move, path: tuple[Position, ...], before: float | None) -> float | None:
        """Return where the robot looks after a move that it ends with a stop, degrees clockwise from north.

        One that cannot turn on the spot looks where it drives, whatever its devices point at.

        Args:
            move: of the robot.
            path: of the move.
            before: where the robot looked before; None: not known.
        """
        look = move.heading if self._stops else None
        seen = None if look is None else look.seen_from(path[-1])
        if seen is not None:
            return seen
        rates = self.kinematics(move).rates(move.speed)
        for leg in pairwise(path):
            before = rates.faces(*leg, before)
        return before

    def push(self, move: Move, path: tuple[Position, ...], before: Push | None) -> Push | None:
        """Return the push that a robot has after a move along a path; `before`: that with which it began."""
        rates = self.kinematics(move).rates(move.speed)
        for leg in pairwise(path):
            before = rates.push(*leg, before)
        return before

    def ahead(
        self, move: Move, path: tuple[Position, ...], before: Passage | None = None, push: Push | None = None
    ) -> Passage | None:
        """Return what a robot saves that need not stop at the end of a move; None: it stops there.

        Args:
            move: of the robot.
            path: of the move.
            before: with which it has begun the move; None: from a stop.
            push: with which it begins the move; None: not known.
        """
        index = self._index[move.id]
        transition = self._robot.transitions.get(index)
        if transition is None or not transition.fluid or len(path) < 2 or index in self._held:
            return None
        following = self._robot.moves[transition.to]
        name = most_specific(following.metaclasses, self._move_kinds)
        beyond = self._move_kinds[name].path(following, path[-1], self._robot.home) if name else None
        if beyond is None or len(beyond) < 2:
            return None
        acts = not all(action.notifies for action in (*move.after, *following.before))
        if acts and self._careful and index not in self._uploaded:
            return None
        flowing = not self._careful or (index in self._uploaded and not self._stops)
        if not flowing and not goes_straight(path[-2], path[-1], beyond[1]):
            return None
        rates = self.kinematics(move).rates(move.speed)
        if not rates.timing.passes:
            return None
        entered = before if len(path) == 2 else None
        onward = self.kinematics(following).rates(following.speed)
        return passed(rates, (path[-2], path[-1]), (beyond[0], beyond[1]), entered, onward, push)


def runs_of(
    robot: RobotProgram, type: RobotType | None, move_kinds: Mapping[Name, MoveKind]
) -> tuple[tuple[int, ...], ...]:
    """Return the runs of a robot as indices of moves, in the order of their first moves.

    A run is a longest chain of at least `SHORTEST_RUN` straight GoTo moves with fluid, unconditional
    transitions without waits, and without actions inside. On the whole of it the robot looks where it goes,
    or at one place on the Earth. At the end of its first move the vehicle stops.

    Args:
        robot: of a behaviour.
        type: of the robot; None: not known.
        move_kinds: by metaclass.
    """
    chained = {
        source: transition.to
        for source, transition in robot.transitions.items()
        if _chains(robot, source, transition, move_kinds) and _looks_on(robot, source, transition, type)
    }
    entered = set(chained.values())
    chains = (_chain(each, chained) for each in chained if each not in entered)
    return tuple(sorted(each for each in chains if len(each) >= SHORTEST_RUN))


def _passed(robot: RobotProgram, run: Sequence[int]) -> Iterator[int]:
    """Yield the moves of a run that begin and end where the path continues straight, without a stop."""
    places = [target.position for index in run if (target := robot.moves[index].target)]
    known = [place for place in places if place is not None]
    straight = [goes_straight(*each) for each in zip(known, known[1:], known[2:], strict=False)]
    yield from (run[i + 2] for i, both in enumerate(pairwise(straight)) if all(both))


def _chain(first: int, chained: Mapping[int, int]) -> tuple[int, ...]:
    moves = [first]
    while moves[-1] in chained and chained[moves[-1]] not in moves:
        moves.append(chained[moves[-1]])
    return tuple(moves)


def _chains(
    robot: RobotProgram, source: int, transition: Transition, move_kinds: Mapping[Name, MoveKind]
) -> bool:
    if not transition.fluid or transition.waits or transition.condition is not None:
        return False
    before, after = robot.moves[source], robot.moves[transition.to]
    alone = sum(transition.to in other.next_moves for other in robot.transitions.values()) == 1
    plain = _is_plain(before, move_kinds) and _is_plain(after, move_kinds)
    return alone and plain and not before.after and not after.before


def _looks_on(robot: RobotProgram, source: int, transition: Transition, type: RobotType | None) -> bool:
    """Return whether a robot looks ahead in two moves, or at the same place on the Earth."""
    before, after = robot.moves[source].heading, robot.moves[transition.to].heading
    if before is None or after is None:
        return before is after
    steady = before.target.position is not None and before.angle_degrees == after.angle_degrees == 0.0
    same = before.device == after.device and before.target.position == after.target.position
    return steady and same and (type is None or type.looks_ahead(before.device))


def _is_plain(move: Move, move_kinds: Mapping[Name, MoveKind]) -> bool:
    """Return whether a move goes straight to a coordinate."""
    name = most_specific(move.metaclasses, move_kinds)
    target = move.target
    if name is None or move_kinds[name].manoeuvre != "go_to" or target is None or target.position is None:
        return False
    east, north, up = target.position
    path = move_kinds[name].path(move, (east - 10.0, north - 10.0, up - 10.0), None)
    plain = target.description is None and move.distance == 0.0
    return plain and path is not None and len(path) == 2
