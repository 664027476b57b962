"""The judge of every log: replays it through the step rules and reports where it deviates.

The oracle for engine, simulators, exports, generated code and logs from the field.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program
from mmrs_runtime.program import ExecutableRobot, SlotId
from mmrs_runtime.records.steps import StepRecord, merge
from mmrs_runtime.semantics import (
    GlobalState,
    Outcome,
    Phase,
    Point,
    PossibleStep,
    Waiting,
    entry,
    missing,
    recorded_step,
    steps,
    waiting,
)

HOLD_POSITION, RECHARGE = (BEHAVIOUR, "HoldPosition"), (BEHAVIOUR, "Recharge")


_TOLERANCE = 1e-3
"""Seconds by which a hold may seem shorter than its duration."""


@dataclass(frozen=True, slots=True)
class Complaint:
    """Where a log and the behaviour disagree.

    Attributes:
        robot, seq, move: of the record; seq is -1 and move empty where no record is to blame.
        message: what the record says and what was expected.
    """

    robot: str
    seq: int
    move: str
    message: str

    def __str__(self) -> str:
        """Return the complaint in one line."""
        where = f"{self.robot}: step {self.seq} at '{self.move}'" if self.seq >= 0 else self.robot
        return f"{where}: {self.message}"


@dataclass(frozen=True, slots=True)
class ReplayResult:
    """What a replay found.

    Attributes:
        outcome: where the replayed steps lead.
        complaints: empty if the log is one of the behaviour's traces.
        waiting: robots that wait for slots at the end.
        faults: by robot, which fault ended it.
        steps: how many were replayed.
        duration: seconds of the run's clock until the last step.
    """

    outcome: Outcome
    complaints: tuple[Complaint, ...]
    waiting: tuple[Waiting, ...]
    faults: Mapping[str, str]
    steps: int
    duration: float

    @property
    def accepted(self) -> bool:
        """Return whether there was nothing to complain of."""
        return not self.complaints


@dataclass(slots=True)
class _Robot:
    program: ExecutableRobot
    point: Point
    began: float = 0.0
    last: StepRecord | None = None


@dataclass(slots=True)
class _Replay:
    robots: dict[str, _Robot]
    active: set[SlotId] = field(default_factory=set)
    faults: dict[str, str] = field(default_factory=dict)
    steps: int = 0


def replay(program: Program, records: Iterable[StepRecord], *, partial: bool = False) -> ReplayResult:
    """Return whether the records are a trace of the program, and how it ended.

    The first step that the rules do not allow ends the replay: what follows it has no meaning.
    Linear in the number of records, merging aside.

    Args:
        program: what the robots should do.
        records: of all robots; those of one robot in the order of its log.
        partial: accept a log that ends before the run does.
    """
    in_file_order = tuple(records)
    complaints = list(_order_complaints(in_file_order))
    run = _Replay({robot.id: _Robot(robot, entry(robot, robot.start)) for robot in program.executable.robots})
    if not complaints:
        complaints.extend(_replayed(run, merge(in_file_order)))
    state = GlobalState(tuple(robot.point for robot in run.robots.values()), frozenset(run.active))
    outcome = _outcome(run, state)
    if outcome is Outcome.INCOMPLETE and not complaints and not partial:
        complaints.extend(_unfinished(run))
    duration = max((record.time for record in in_file_order), default=0.0)
    return ReplayResult(
        outcome, tuple(complaints), waiting(program.executable, state), run.faults, run.steps, duration
    )


def _order_complaints(records: tuple[StepRecord, ...]) -> Iterable[Complaint]:
    last: dict[str, StepRecord] = {}
    for record in records:
        before = last.get(record.robot)
        last[record.robot] = record
        if message := _order_fault(before, record, records[0].run):
            yield _complaint(record, message)


def _order_fault(before: StepRecord | None, record: StepRecord, run: str) -> str:
    if record.run != run:
        return f"belongs to run '{record.run}', the first record to '{run}'"
    expected = before.seq + 1 if before else 0
    if record.seq != expected:
        return f"is numbered {record.seq}, expected {expected}"
    if before and record.lamport <= before.lamport:
        return f"logical time {record.lamport} does not follow {before.lamport}"
    if before and record.time < before.time:
        return f"time goes back from {before.time:g} s to {record.time:g} s"
    return ""


def _replayed(run: _Replay, records: tuple[StepRecord, ...]) -> Iterable[Complaint]:
    for record in records:
        robot = run.robots.get(record.robot)
        if robot is None:
            yield _complaint(record, "no such robot in the behaviour")
            return
        step = recorded_step(record, robot.program, robot.point, run.active)
        if step is None:
            yield _complaint(record, f"is {_shown(record)}, expected {_expected(run, robot)}")
            return
        if message := _too_short(robot, record):
            yield _complaint(record, message)
            return
        _advance(run, robot, step, record)


def _too_short(robot: _Robot, record: StepRecord) -> str:
    if record.label != "end":
        return ""
    move = robot.program.by_id[robot.point.move].order
    assert isinstance(move, Move)
    duration = move.attributes.get("duration")
    if not move.is_a(HOLD_POSITION) or not isinstance(duration, int | float):
        return ""
    if move.is_a(RECHARGE):  # over as soon as the batteries are full, and an operator may have changed them
        return ""
    held = record.time - robot.began
    return f"holds for {held:g} s, expected at least {duration:g} s" if held < duration - _TOLERANCE else ""


def _advance(run: _Replay, robot: _Robot, step: PossibleStep, record: StepRecord) -> None:
    if step.label == "begin":
        robot.began = record.time
    if step.label == "fault":
        run.faults[record.robot] = record.detail
    if step.sets and step.active:
        run.active.update(step.sets)
    elif step.sets:
        run.active.difference_update(step.sets)
    robot.point, robot.last = step.leads_to, record
    run.steps += 1


def _outcome(run: _Replay, state: GlobalState) -> Outcome:
    if any(steps(robot.program, robot.point, state.active) for robot in run.robots.values()):
        return Outcome.INCOMPLETE
    if run.faults:
        return Outcome.FAILED
    done = all(robot.point.phase is Phase.DONE for robot in run.robots.values())
    return Outcome.SUCCESS if done else Outcome.STUCK


def _unfinished(run: _Replay) -> Iterable[Complaint]:
    for robot in run.robots.values():
        if not steps(robot.program, robot.point, run.active):
            continue
        message = f"log ends although the robot can continue: expected {_expected(run, robot)}"
        if robot.last is None:
            yield Complaint(robot.program.id, -1, "", message)
        else:
            yield _complaint(robot.last, message)


def _complaint(record: StepRecord, message: str) -> Complaint:
    return Complaint(record.robot, record.seq, record.move, message)


def _expected(run: _Replay, robot: _Robot) -> str:
    possible = steps(robot.program, robot.point, run.active)
    if possible:
        return " or ".join(map(_shown, possible))
    if lacking := missing(robot.program, robot.point, run.active):
        return f"no step before {', '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} active"
    return f"no step after it has {'finished' if robot.point.phase is Phase.DONE else 'failed'}"


def _shown(step: StepRecord | PossibleStep) -> str:
    parts = (step.label, step.detail, step.slot)
    return " ".join(part for part in parts if part) + f" of '{step.move}'"
