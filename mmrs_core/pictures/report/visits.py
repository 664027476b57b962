"""The visits of moves: how long each took, and how long robots waited after it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, RobotProgram, SlotId
from mmrs_core.pictures.flights.flight import Flight
from mmrs_core.pictures.report.contents import MoveReport, WaitReport
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.records.steps import StepRecord

SHORTEST_WAIT = 1.0
"""Shortest wait that a report lists, seconds."""
_ENDS = frozenset({"Start", "Stop"})


@dataclass(slots=True)
class Visit:
    """One visit of a move, all times in seconds of the run.

    Attributes:
        entered: when the robot came to it. begun, ended: of its movement; None where that never came.
        done: when its last movement or action was; the robot waits from then on.
        left: when it continued; None where it never did.
        fault: which one ended the program here; empty if none did.
    """

    move: str
    entered: float
    begun: float | None = None
    ended: float | None = None
    done: float = 0.0
    left: float | None = None
    fault: str = ""

    @property
    def complete(self) -> bool:
        """Return whether all of it was done: the robot continued, or its movement ended without a fault."""
        return self.left is not None or (self.ended is not None and not self.fault)


def visits_of(records: Iterable[StepRecord]) -> tuple[Visit, ...]:
    """Return the visits of one robot, in order."""
    visits: list[Visit] = []
    entered = 0.0
    for record in records:
        if not visits or visits[-1].left is not None or visits[-1].move != record.move:
            visits.append(Visit(record.move, entered, done=entered))
        _add(visits[-1], record)
        if record.label in ("take", "choose"):
            entered = record.time
    return tuple(visits)


def _add(visit: Visit, record: StepRecord) -> None:
    if record.label == "begin":
        visit.begun = record.time
    elif record.label == "end":
        visit.ended = visit.done = record.time
    elif record.label in ("act", "ntf"):
        visit.done = record.time
    elif record.label == "fault":
        visit.fault = record.detail or "fault"
        visit.done = record.time
    else:
        visit.left = record.time


def move_reports(program: Program, flight: Flight, plan: SimulatedRun | None) -> tuple[MoveReport, ...]:
    """Return every visit of a move that takes time, by robot, with the time of the visit in the plan."""
    return tuple(report for robot in program.robots for report in _moves(robot, flight, plan))


def wait_reports(program: Program, flight: Flight, plan: SimulatedRun | None) -> tuple[WaitReport, ...]:
    """Return every wait of a second or more, by robot."""
    setters = _setters(program, flight)
    return tuple(wait for robot in program.robots for wait in _waits(robot, flight, plan, setters))


def _moves(robot: RobotProgram, flight: Flight, plan: SimulatedRun | None) -> Iterator[MoveReport]:
    moves = {move.id: move for move in robot.moves}
    for visit, planned in _side_by_side(robot, flight, plan):
        move = moves[visit.move]
        if move.kind in _ENDS and visit.complete:
            continue
        yield MoveReport(
            robot.id,
            move.id,
            move.kind,
            move.task,
            visit.entered,
            visit.done - visit.entered,
            planned.done - planned.entered if planned is not None else None,
            visit.complete,
        )


def _side_by_side(
    robot: RobotProgram, flight: Flight, plan: SimulatedRun | None
) -> Iterator[tuple[Visit, Visit | None]]:
    """Yield each visit of a move with the corresponding visit in the plan."""
    ahead: dict[str, list[Visit]] = {}
    for visit in visits_of(record for record in (plan.records if plan else ()) if record.robot == robot.id):
        ahead.setdefault(visit.move, []).append(visit)
    for visit in visits_of(flight.robots[robot.id].records):
        planned = ahead.get(visit.move)
        yield visit, planned.pop(0) if planned else None


def _waits(
    robot: RobotProgram,
    flight: Flight,
    plan: SimulatedRun | None,
    setters: Mapping[SlotId, Sequence[tuple[float, str]]],
) -> Iterator[WaitReport]:
    index = {move.id: i for i, move in enumerate(robot.moves)}
    flown = flight.robots[robot.id]
    for visit, planned in _side_by_side(robot, flight, plan):
        transition = robot.transitions.get(index[visit.move])
        if transition is None or not transition.waits or visit.ended is None:
            continue
        since = visit.ended if visit.fault else visit.done
        last = visit.done if visit.fault else max(flown.end, visit.done)
        end = visit.left if visit.left is not None else last
        if end - since < SHORTEST_WAIT:
            continue
        yield WaitReport(
            robot.id,
            visit.move,
            transition.waits,
            tuple(
                dict.fromkeys(_setter(setters.get((robot.id, slot), ()), end) for slot in transition.waits)
            ),
            since,
            visit.left,
            end - since,
            planned.left - planned.done if planned is not None and planned.left is not None else None,
        )


def _setter(set_by: Sequence[tuple[float, str]], until: float) -> str:
    return next((robot for time, robot in reversed(set_by) if time <= until), "unknown")


def _setters(program: Program, flight: Flight) -> dict[SlotId, list[tuple[float, str]]]:
    """Return who activated each slot when, by time."""
    found: dict[SlotId, list[tuple[float, str]]] = {}
    for robot in program.robots:
        moves = {move.id: move for move in robot.moves}
        for record in flight.robots[robot.id].records:
            if record.label == "ntf":
                _note(found, record, moves[record.move].action(record.detail).sets)
    return {slot: sorted(set_by) for slot, set_by in found.items()}


def _note(found: dict[SlotId, list[tuple[float, str]]], record: StepRecord, slots: Sequence[SlotId]) -> None:
    if record.slot.startswith("+"):
        for slot in slots:
            found.setdefault(slot, []).append((record.time, record.robot))
