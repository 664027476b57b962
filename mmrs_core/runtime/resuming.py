"""Takes up a run that was broken off, from what its logs tell."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.behaviour.semantics import Point, Step, entry, told_by
from mmrs_core.contributions.buses import CommandId
from mmrs_core.runtime.slots import InProcessBus
from mmrs_runtime.records.steps import StepRecord, merge

RESTORED = "restored"
"""Incarnation of senders whose notifies were sent before the run was broken off."""


def step_of(robot: RobotProgram, point: Point, record: StepRecord) -> Step:
    """Return the step from a point that a record tells of, whatever slots are active.

    Raises:
        ValueError: if it is none of the program's.
    """
    step = told_by(record, robot, point, {(robot.id, name) for name in robot.slots})
    if step is not None:
        return step
    raise ValueError(f"robot '{robot.id}': step {record.seq} of its log is none of its program's")


def point_after(robot: RobotProgram, records: Iterable[StepRecord]) -> Point:
    """Return where the steps of a robot lead, which stand among those of others in their order.

    Raises:
        ValueError: if they are not its program's.
    """
    point = entry(robot, robot.start)
    for record in records:
        if record.robot == robot.id:
            point = step_of(robot, point, record).leads_to
    return point


def over_by(program: Program, records: Iterable[StepRecord]) -> dict[str, str]:
    """Return the robots whose programs have ended, with the fault, or nothing where there was none.

    Raises:
        ValueError: if steps are not the program's.
    """
    given = tuple(records)
    last = {record.robot: record for record in given}
    return {
        robot.id: last[robot.id].detail if last[robot.id].label == "fault" else ""
        for robot in program.robots
        if point_after(robot, given).is_final
    }


def restore(bus: InProcessBus, program: Program, records: Iterable[StepRecord]) -> None:
    """Have a bus know every notify that was logged, and every wait that was passed.

    A notify that was logged and not delivered is delivered by that: its log line decides.
    """
    robots = {robot.id: robot for robot in program.robots}
    for record in merge(records):
        robot = robots[record.robot]
        if record.label == "ntf":
            action = robot.move(record.move).action(record.detail)
            id = CommandId(record.run, record.robot, RESTORED, record.seq)
            bus.apply(id, action.sets, action.active, record.lamport)
        elif record.label in ("take", "choose"):
            index = next(i for i, move in enumerate(robot.moves) if move.id == record.move)
            waits = [(robot.id, name) for name in robot.transitions[index].waits]
            bus.passed(waits, record.lamport)
