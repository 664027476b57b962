"""Takes up a run that was broken off, from what its logs tell."""

from __future__ import annotations

from collections.abc import Iterable

from ..program import ExecutableRobot, Notify, Program
from ..records.steps import StepRecord, merge
from ..semantics import Point, PossibleStep, entry, recorded_step
from ..slots import LocalSlots


def step_of(robot: ExecutableRobot, point: Point, record: StepRecord) -> PossibleStep:
    """Return the step from a point that a record belongs to, whatever slots are active.

    Raises:
        ValueError: if it is not one of the program's.
    """
    step = recorded_step(record, robot, point, {(robot.id, name) for name in robot.slots})
    if step is not None:
        return step
    raise ValueError(f"robot '{robot.id}': step {record.seq} of its log is not one of its program's")


def point_after(robot: ExecutableRobot, records: Iterable[StepRecord]) -> Point:
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


def restore(slots: LocalSlots, program: Program, records: Iterable[StepRecord]) -> None:
    """Restore slots from every notify that was logged, and every wait that was passed.

    A notify that was logged and not delivered is delivered by that: its log line decides.
    """
    for record in merge(records):
        robot = program.by_id[record.robot]
        if record.label == "ntf":
            notify = robot.by_id[record.move].action(record.detail)
            assert isinstance(notify, Notify)
            slots.apply(record.robot, notify.slots, notify.active, record.lamport)
        elif record.label in ("take", "choose"):
            then = robot.by_id[record.move].then
            slots.passed([(robot.id, name) for name in then.waits] if then else (), record.lamport)
