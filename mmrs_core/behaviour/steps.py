"""One step of one robot, as logs record it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StepRecord:
    """A step: one label of the semantics of BL.

    Attributes:
        run: identifier of the run.
        robot: identifier of the robot.
        seq: counted from 0 in each robot's log, without gaps.
        lamport: logical time; a notify's is below that of every step that it enabled.
        time: seconds of the run's clock.
        label: ``act``, ``ntf``, ``begin``, ``end``, ``take``, ``choose`` or ``fault``.
        move: identifier of the move that the step belongs to.
        detail: of an act or ntf: index of the action, as ``pre:0`` or ``post:1``; of a take: the
            identifier of the next move; of a choose: ``true`` or ``false``; of a fault: which one.
        slot: of a ntf: the slots set, as ``robot.slot`` joined by blanks, with ``+`` or ``-`` before
            the first; empty otherwise.
    """

    run: str
    robot: str
    seq: int
    lamport: int
    time: float
    label: str
    move: str
    detail: str = ""
    slot: str = ""
