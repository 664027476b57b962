"""The situation of one robot of a run: its point in its program, its wait, and its orders."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from math import inf
from typing import TYPE_CHECKING

from ..faults import BATTERY_LOW, STOPPED
from ..policies import Policy, still_low
from ..program import ExecutableRobot, Move
from ..questions import Questions
from ..records.steps import StepRecord
from ..semantics import Phase, PossibleStep, awaited, entry
from ..vehicle import Fault, Vehicle
from .responses import LEAST_PEER_SECONDS, Halt, Responses
from .resuming import step_of
from .waits import NotifyWait, Wait, noted

if TYPE_CHECKING:
    from .run import Run


class Stage(Enum):
    """How far a robot is; one whose program has ended stays at work, with nothing left to do.

    Attributes:
        PREPARING: it has still to get ready.
        ABSENT: it did not get ready, and may not be the program's robot: it is left alone.
        AWAY: it is ready, and has still to be sent back to where its program was broken off.
        RECOVERING: it is returning there.
        WORKING: its program continues.
        SUSPENDED: its program is broken off, until its battery was changed, or because it could not be
            resumed.
    """

    PREPARING = "preparing"
    ABSENT = "absent"
    AWAY = "away"
    RECOVERING = "recovering"
    WORKING = "working"
    SUSPENDED = "suspended"


class Situation:
    """A robot of a run.

    Attributes:
        point: where it is in its program.
        stage: how far it is with getting there.
        lamport: its logical time.
        number: of its next step. last: the last step made; None: none yet.
        wait: what keeps it from leaving its move.
        sending: whether it notifies others, and they have still to answer.
        held: whether its last order was to hold.
        ordered: the fault and response of an order that ends its program; None without one.
        halt: what ended its program, or broke it off, and how it stops.
        questions: that its choices ask the operator.
    """

    def __init__(
        self, robot: ExecutableRobot, vehicle: Vehicle, run: Run, policies: tuple[Policy, ...], *, live: bool
    ) -> None:
        """Start at the beginning of a program; `policies` come after its own."""
        self.id, self.robot, self.vehicle = robot.id, robot, vehicle
        self.point = entry(robot, robot.start)
        self.stage = Stage.WORKING
        self.lamport, self.number = 0, 0
        self.last: StepRecord | None = None
        self.wait = Wait(robot.id)
        self.held = False
        self.ordered: tuple[Fault, str] | None = None
        self.halt = Halt()
        self.questions = Questions(robot.conditions)
        self._run, self._slots, self._live = run, run.slots, live
        self._speedup: float = getattr(run.clock, "speedup", 1.0)
        self._least = LEAST_PEER_SECONDS * self._speedup if live else 0.0
        self._policies = (*robot.policies, *policies)
        self._passed: list[str] = []
        self._outgoing = NotifyWait()
        self._pausing, self._held_since = False, 0.0
        self._looked, self._look_at = 0.0, inf
        self._unsure = False
        self._borne = ""
        self.sending = False

    def restore(self, records: Iterable[StepRecord]) -> None:
        """Restore the point that its own log leads to, whose steps are those of its program in order.

        Raises:
            ValueError: if they are not.
        """
        for record in records:
            self.follow(step_of(self.robot, self.point, record), record.time)
            self.lamport, self.number, self.last = record.lamport, record.seq + 1, record

    def follow(self, step: PossibleStep, now: float) -> None:
        """Go to the point that a step leads to."""
        if step.label == "end":
            self._passed.append(step.move)
        if self.wait.since is not None:
            names = [name for _, name in awaited(self.robot, self.point)]
            self.vehicle.note("wait", noted(self.wait, names, now))
            self.wait = Wait(self.id)
        self.questions.asked = ""
        self.point = step.leads_to

    def teach(self) -> None:
        """Pass on to the vehicle where the robots that notified this one have detected objects."""
        if places := {name: place for name, place in self._slots.finds(self.id) if place is not None}:
            self.vehicle.learn(places)

    def answers(self) -> Responses:
        """Return what it does about faults here, a wait's own policies first."""
        declared = self._policies
        if self.point.phase is Phase.OUT and self.move.then is not None:
            declared = (*self.move.then.policies, *declared)
        return Responses(declared, live=self._live, least=self._least)

    def now(self) -> float:
        """Return the time of the run."""
        return self._run.clock.now()

    def is_unknown(self) -> bool:
        """Return whether it must not be commanded: it may not be the program's robot."""
        return self.is_preparing and not self.vehicle.known(self.now())

    def recover(self) -> None:
        """Begin to go back to where the program was broken off."""
        self.halt, self.stage = Halt(), Stage.RECOVERING
        self.wait, self.questions.asked = Wait(self.id), ""
        if not self.vehicle.recover(tuple(self._passed), self._underway, self.now()):
            self.stage = Stage.WORKING

    def overtaken_by(self, found: Fault) -> bool:
        """Return whether a fault is answered now although the robot still answers another one."""
        if not self.halt.is_overtaken_by(found):
            return False
        self.halt.answer(found, self.answers().response(found))
        return True

    def end_by(self, found: Fault, response: str) -> None:
        """End the program by an order."""
        self.ordered, self.halt.released = (found, response), found.which == STOPPED
        self.forget_hold()

    # Holding.

    def hold(self) -> None:
        """Hold position, once it may be commanded; the time does not count against others' waits."""
        if not self.held:
            self.held, self._pausing, self._held_since = True, False, self.now()
        if not self._pausing and self.vehicle.pauses and not self.is_unknown():
            self._pausing = True
            self.vehicle.pause(self.now())

    def go_on(self) -> None:
        """End the hold and extend pending deadlines."""
        self.held = False
        if self._pausing:
            self.vehicle.resume(self.now())
        seconds = self.now() - self._held_since
        self.wait.extend(seconds)
        self._outgoing.extend(seconds)

    def forget_hold(self) -> None:
        """Take it that something else ends the hold, which need not be undone."""
        self.held = False

    # What others ask.

    @property
    def move(self) -> Move:
        """Return the move that it is at."""
        return self.robot.by_id[self.point.move]

    @property
    def is_preparing(self) -> bool:
        """Return whether it has still to get ready."""
        return self.stage is Stage.PREPARING

    @property
    def is_absent(self) -> bool:
        """Return whether it did not get ready, so that it is left alone."""
        return self.stage is Stage.ABSENT

    @property
    def is_waiting(self) -> bool:
        """Return whether it waits for slots."""
        return bool(self.wait.lacking)

    @property
    def suspended(self) -> bool:
        """Return whether its program is broken off, or could not begin, and has not ended."""
        return self.stage in (Stage.SUSPENDED, Stage.ABSENT)

    @property
    def waits_for_ever(self) -> bool:
        """Return whether it waits, and neither a policy nor its vehicle ends that at any time to come."""
        return self.wait.since is not None and self.wait.deadline == inf and self._look_at == inf

    @property
    def is_quiet(self) -> bool:
        """Return whether it makes no step unless others do, or an order comes."""
        return self.point.is_final or bool(self.wait.lacking) or self.suspended

    @property
    def may_be_resumed(self) -> bool:
        """Return whether an order may resume it, although it does nothing now."""
        return (self.suspended and not self.halt.released) or self.held

    @property
    def rests(self) -> bool:
        """Return whether its motors are seen to be off, those of whatever answers on its link."""
        return self.vehicle.status().get("armed") is False

    def hindrance(self) -> str:
        """Return why its program cannot be continued; empty if it can, as far as is known."""
        if why := self.astray():
            return why
        low = self.halt.is_for(BATTERY_LOW)
        return still_low(self.vehicle.state(self.now()).charge, self.robot.reserve) if low else ""

    def astray(self) -> str:
        """Return that it is where its program cannot be gone on with, or out of reach; empty: it is not."""
        return self.vehicle.hindrance(tuple(self._passed), self._underway, self.now())

    def away(self) -> str:
        """Return why it does not stand at home, as far as is known; empty where it may."""
        return self.vehicle.away(self.now())

    def may_move(self) -> bool:
        """Return whether it is at work and seen armed, so that it must not be left alone."""
        return not (self.point.is_final or self.suspended) and self.vehicle.moves(self.now())

    def is_watched(self) -> bool:
        """Return whether it has stopped, or is out of reach, so that an operator must stay with it."""
        return self.vehicle.watched(self.now())

    def decided(self, what: str, why: str, response: str) -> None:
        """Record a decision in the black box."""
        self.vehicle.note("decision", {"what": what, "why": why, "response": response})

    @property
    def _underway(self) -> str:
        return self.point.move if self.point.phase is Phase.BUSY else ""
