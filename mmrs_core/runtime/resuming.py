"""Takes up a run that was broken off, from what its logs tell."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.behaviour.log import merge
from mmrs_core.behaviour.program import Action, Program, RobotProgram
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.contributions.execution import CommandId
from mmrs_core.runtime.slots import InProcessBus

RESTORED = "restored"
"""Incarnation of senders whose notifies were sent before the run was broken off."""


def restore(bus: InProcessBus, program: Program, records: Iterable[StepRecord]) -> None:
    """Have a bus know every notify that was logged, and every wait that was passed.

    A notify that was logged and not delivered is delivered by that: its log line decides.
    """
    robots = {robot.id: robot for robot in program.robots}
    for record in merge(records):
        robot = robots[record.robot]
        if record.label == "ntf":
            action = _action(robot, record)
            id = CommandId(record.run, record.robot, RESTORED, record.seq)
            bus.apply(id, action.sets, action.active, record.lamport)
        elif record.label in ("take", "choose"):
            index = next(i for i, move in enumerate(robot.moves) if move.id == record.move)
            waits = [(robot.id, name) for name in robot.transitions[index].waits]
            bus.passed(waits, record.lamport)


def _action(robot: RobotProgram, record: StepRecord) -> Action:
    move = next(move for move in robot.moves if move.id == record.move)
    side, _, index = record.detail.partition(":")
    return (move.before if side == "pre" else move.after)[int(index)]
