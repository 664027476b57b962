"""A robot's steps as visits of its moves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from mmrs_runtime.records.steps import StepRecord


@dataclass(slots=True)
class Visit:
    """One visit of a move, all times in seconds of the run.

    Attributes:
        entered: when the robot came to it. begun, ended: of its movement; None where that never came.
        done: when its last movement or action was; the robot waits from then on.
        left: when it went on; None where it never did.
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
        """Return whether all of it was done: the robot went on, or its movement ended without a fault."""
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
