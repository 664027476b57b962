"""Whether robots are on the ground or not when moves need it, whatever Choices decide.

A forward pass over the moves of each robot propagates the set of states that it may be in.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of, move_kind_of
from mmrs_core.analysis.verdicts import UnknownMove, for_each_robot, safe, unknown_moves, violated
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict

NAME = "states"
GROUNDED = "grounded"
MOVING = "moving"


@dataclass(frozen=True, slots=True)
class States:
    """In which states a robot may be before and after each reachable move, by the move's index.

    Attributes:
        gaps: moves of kinds that no plug-in provides: they are taken to leave the state as it was.
    """

    before: Mapping[int, frozenset[str]]
    after: Mapping[int, frozenset[str]]
    gaps: tuple[UnknownMove, ...]

    def only_grounded(self, move: int) -> bool:
        """Return whether the robot is on the ground all through that move."""
        return self.before[move] | self.after[move] == {GROUNDED}

    def touches_ground(self, move: int) -> bool:
        """Return whether the robot may be on the ground when that move begins or ends."""
        return GROUNDED in self.before[move] | self.after[move]


def states_of(input: CheckInput, robot: RobotProgram) -> States:
    """Return the states of one robot; linear in its moves.

    Raises:
        MissingFigureError: it is unknown whether the robot launches.
    """
    first = GROUNDED if kinematics_of(input, robot).launches else MOVING
    return _states_from(input, robot, frozenset({first}))


def possible_states(input: CheckInput, robot: RobotProgram) -> States:
    """Return the states of one robot whether it launches or not; linear in its moves."""
    return _states_from(input, robot, frozenset({GROUNDED, MOVING}))


def _states_from(input: CheckInput, robot: RobotProgram, first: frozenset[str]) -> States:
    before: dict[int, frozenset[str]] = {}
    after: dict[int, frozenset[str]] = {}
    gaps: dict[int, UnknownMove] = {}
    pending: deque[tuple[int, frozenset[str]]] = deque([(robot.start, first)])
    while pending:
        index, states = pending.popleft()
        if states <= before.get(index, frozenset()):
            continue
        before[index] = before.get(index, frozenset()) | states
        kind = move_kind_of(input, robot.moves[index])
        if kind is None:
            reason = f"no plug-in provides the move kind '{robot.moves[index].kind}'"
            gaps[index] = UnknownMove(index, reason)
        leaves = kind.leaves if kind else None
        after[index] = frozenset({leaves}) if leaves else before[index]
        transition = robot.transitions.get(index)
        pending.extend(
            (successor, after[index]) for successor in (transition.next_moves if transition else ())
        )
    return States(before, after, tuple(gaps.values()))


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    try:
        states = states_of(input, robot)
    except MissingFigureError:
        yield from _misplaced(input, robot, possible_states(input, robot), certainly=True)
        raise
    broken = tuple(_misplaced(input, robot, states))
    yield from broken
    if states.gaps:
        yield unknown_moves(NAME, robot, states.gaps)
    elif not broken:
        yield safe(NAME, robot, "every move begins in a state that it needs")


def _misplaced(
    input: CheckInput, robot: RobotProgram, states: States, certainly: bool = False
) -> Iterator[Verdict]:
    """Yield the moves that may begin in a state that they cannot, or only those that certainly do."""
    for index, before in sorted(states.before.items()):
        move = robot.moves[index]
        kind = move_kind_of(input, move)
        wrong = before - kind.needs if kind and kind.needs else frozenset()
        if kind and wrong and not (certainly and before & kind.needs):
            words = (
                f"{move.kind} '{move.id}' begins while the robot may be {_words(wrong)},"
                f" it needs it to be {_words(kind.needs)}"
            )
            yield violated(NAME, robot, words, index)


def _words(states: frozenset[str]) -> str:
    return " or ".join(sorted(states))


STATES = Check(
    name=NAME,
    title="Robots are on the ground, in the air or in motion when their moves need it.",
    run=for_each_robot(NAME, _judge),
    hint="put the move that is missing before it, such as a take-off or a landing",
)
