"""Whether each robot's moves lead from its Start to its Stop and include all its work."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from mmrs_core.analysis.verdicts import for_each_robot, safe, violated
from mmrs_core.behaviour.program import BEHAVIOUR, Program, RobotProgram, Transition
from mmrs_core.behaviour.walk import moves_reaching_stop, reachable_moves
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.scene import Name

NAME = "structure"
START: Name = (BEHAVIOUR, "Start")
STOP: Name = (BEHAVIOUR, "Stop")


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    faults = [*_ends(robot), *_names(robot), *_transitions(robot)]
    if not any(move is not None for _, move in faults):
        faults += [*_dead_ends(robot), *_undone(robot)]
    faults += _strangers(input.program, robot)
    for message, move in faults:
        yield violated(NAME, robot, message, move)
    if not faults:
        found = safe(NAME, robot, "every move is on a path from Start to Stop")
        yield replace(found, caveat=_never(robot))


def _ends(robot: RobotProgram) -> Iterator[tuple[str, int | None]]:
    for metaclass, expected in ((START, robot.start), (STOP, robot.stop)):
        found = [index for index, move in enumerate(robot.moves) if move.is_a(metaclass)]
        if found != [expected]:
            yield f"it has {len(found)} {metaclass[1]} moves instead of exactly one", None


def _names(robot: RobotProgram) -> Iterator[tuple[str, int | None]]:
    for id, number in Counter(move.id for move in robot.moves).items():
        if number > 1:
            yield f"{number} moves are called '{id}'", None
    for slot, number in Counter(robot.slots).items():
        if number > 1:
            yield f"{number} slots are called '{slot}'", None


def _transitions(robot: RobotProgram) -> Iterator[tuple[str, int | None]]:
    for index, move in enumerate(robot.moves):
        transition = robot.transitions.get(index)
        if index == robot.stop:
            if transition is not None:
                yield f"a transition leaves Stop '{move.id}'", index
        elif transition is None:
            yield f"{move.kind} '{move.id}' has no transition to a next move", index
        else:
            yield from ((fault, index) for fault in _faults(robot, index, transition))


def _faults(robot: RobotProgram, index: int, transition: Transition) -> Iterator[str]:
    move = robot.moves[index]
    if transition.source != index:
        yield f"the transition after '{move.id}' belongs to another move"
    for after in transition.next_moves:
        if not 0 <= after < len(robot.moves):
            yield f"the transition after '{move.id}' leaves the robot"
        elif after == robot.start:
            yield f"the transition after '{move.id}' leads back to Start"
    for slot in transition.waits:
        if slot not in robot.slots:
            yield f"the transition after '{move.id}' waits for '{slot}', which is not a slot of the robot"


def _dead_ends(robot: RobotProgram) -> list[tuple[str, int | None]]:
    ending = moves_reaching_stop(robot)
    return [
        (f"no path leads from {move.kind} '{move.id}' to Stop", index)
        for index, move in enumerate(robot.moves)
        if index not in ending
    ]


def _strangers(program: Program, robot: RobotProgram) -> Iterator[tuple[str, int | None]]:
    slots = {(other.id, slot) for other in program.robots for slot in other.slots}
    for index, move in enumerate(robot.moves):
        for action in (*move.before, *move.after):
            for owner, slot in action.sets:
                if (owner, slot) not in slots:
                    yield f"'{move.id}' notifies '{owner}.{slot}', which is not a slot of any robot", index


def _undone(robot: RobotProgram) -> Iterator[tuple[str, int | None]]:
    """Yield the moves with work, a task's or actions, that no transition leads to."""
    for index in _unreached(robot):
        move = robot.moves[index]
        work = f"task '{move.task}' is" if move.task else "actions are"
        if move.task or move.before or move.after:
            yield f"{move.kind} '{move.id}' is never reached: its {work} not carried out there", index


def _unreached(robot: RobotProgram) -> list[int]:
    reachable = reachable_moves(robot)
    return [index for index in range(len(robot.moves)) if index not in reachable]


def _never(robot: RobotProgram) -> str:
    never = [robot.moves[index].id for index in _unreached(robot)]
    return f"never reached: {', '.join(never)}" if never else ""


STRUCTURE = Check(
    name=NAME,
    title="Every robot has one Start and one Stop, every move leads to Stop, and all work is reached.",
    run=for_each_robot(NAME, _judge),
    hint="add the transition that is missing, so that every move leads on to the Stop",
)
