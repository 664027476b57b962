"""Has a plan choose as its flight did: every Choice answers as the log of its robot says, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.execution import Condition, RobotState
from mmrs_core.pictures.flights.values import Flight

_LONGEST = 100
"""How often a Choice answers like the last time once the log says no more; then it answers otherwise.

A flight that was broken off in a loop has no answer that ends it, and its plan must end.
"""


@dataclass(slots=True)
class Choosing:
    """What decides the Choices of a plan.

    Attributes:
        program: the behaviour, each Choice with a condition of its own.
        conditions: by their identifiers there.
        notes: what had to be guessed, for people.
    """

    program: Program
    conditions: dict[str, Condition] = field(default_factory=dict)
    notes: dict[str, None] = field(default_factory=dict)


def choosing_as(
    flight: Flight, program: Program, assume: Mapping[str, bool], known: Mapping[str, Condition]
) -> Choosing:
    """Return what has a plan choose as a flight did.

    A Choice that the flight never came to answers as it is told to; else as the condition did elsewhere
    in the flight; else as is known; else it holds, and a note says so.

    Args:
        assume: answers by condition identifier.
        known: conditions that decide by the state of the robot, by identifier.
    """
    elsewhere = _first_answers(flight, program)
    made = Choosing(program)

    def decided(robot: RobotProgram, move: int, condition: str) -> Callable[[RobotState], bool]:
        answers = list(_answers(flight, robot, robot.moves[move].id))
        if answers:
            return _in_order(answers)
        fixed = assume.get(condition, elsewhere.get(condition))
        if fixed is None and condition in known:
            return known[condition].holds
        if fixed is None:
            made.notes[f"condition '{condition}' was never asked; the plan takes it that it holds"] = None
        return _in_order([True if fixed is None else fixed])

    robots = []
    for robot in program.robots:
        transitions = dict(robot.transitions)
        for move, transition in robot.transitions.items():
            if transition.condition is not None:
                own = f"{robot.id}, {robot.moves[move].id}: {transition.condition}"
                made.conditions[own] = Condition(own, decided(robot, move, transition.condition))
                transitions[move] = replace(transition, condition=own)
        robots.append(replace(robot, transitions=transitions))
    made.program = replace(program, robots=tuple(robots))
    return made


def _answers(flight: Flight, robot: RobotProgram, move: str) -> Iterator[bool]:
    flown = flight.robots.get(robot.id)
    for record in flown.records if flown is not None else ():
        if record.label == "choose" and record.move == move:
            yield record.detail == "true"


def _first_answers(flight: Flight, program: Program) -> dict[str, bool]:
    """Return what each condition answered first, by identifier."""
    answers: dict[str, bool] = {}
    for robot in program.robots:
        for move, transition in robot.transitions.items():
            if transition.condition is not None:
                for answer in _answers(flight, robot, robot.moves[move].id):
                    answers.setdefault(transition.condition, answer)
    return answers


def _in_order(answers: Sequence[bool]) -> Callable[[RobotState], bool]:
    asked = 0

    def holds(state: RobotState) -> bool:
        nonlocal asked
        asked += 1
        if asked <= len(answers):
            return answers[asked - 1]
        return answers[-1] is (asked <= len(answers) + _LONGEST)

    return holds
