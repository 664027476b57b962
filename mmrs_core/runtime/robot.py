"""One robot of a run: where it is in its program, and what its backend is doing."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from mmrs_core.behaviour.program import Move, RobotProgram, SlotId
from mmrs_core.behaviour.semantics import Phase, Step, entry, fault
from mmrs_core.contributions.abilities import Noting, Preparing, Recognising, Telling, Watched
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.buses import Bus
from mmrs_core.contributions.execution import Fault
from mmrs_core.errors import LinkLostError
from mmrs_core.runtime.answers import Answers
from mmrs_core.runtime.doing import Doing
from mmrs_core.runtime.halting import Halt
from mmrs_core.runtime.outgoing import Outgoing
from mmrs_core.runtime.pausing import Pause
from mmrs_core.runtime.peers import Peers
from mmrs_core.runtime.recovery import Recovery
from mmrs_core.runtime.resuming import step_of
from mmrs_core.runtime.rules import Rules
from mmrs_core.runtime.stages import Stage
from mmrs_core.runtime.waiting import Wait
from mmrs_runtime.faults import BATTERY_LOW, LINK_LOST, LOG_FAILED, PEER_LOST, STOPPED
from mmrs_runtime.policies import COMES_DOWN, NOTHING, still_low
from mmrs_runtime.records.steps import StepRecord


class RunningRobot:
    """A robot while it runs.

    Attributes:
        point: where it is in its program.
        stage: how far it is with getting there.
        lamport: its logical time.
        looked: when it was looked at last; what happens after that has yet to be seen.
        number: of its next step.
        notify: that owners of slots have still to answer or to acknowledge.
        ordered: what ends its program because somebody ordered that, and the response; None: nobody did.
        halt: what ended its program, or broke it off, and how it stops.
        questions: that its choices ask the operator.
    """

    def __init__(self, program: RobotProgram, backend: Backend, bus: Bus, rules: Rules) -> None:
        self.id = program.id
        self.backend = backend
        self.point = entry(program, program.start)
        self.stage = Stage.WORKING
        self.lamport, self.number = 0, 0
        self.looked = 0.0
        self.notify = Outgoing()
        self.ordered: tuple[Fault, str] | None = None
        self.halt = Halt()
        self._pause = Pause(backend)
        self._recovery = Recovery(backend)
        self._doing = Doing(program, backend, bus, rules)
        self.questions = self._doing.questions
        self._program, self._bus, self._rules = program, bus, rules
        self._policies = (*program.policies, *rules.policies)

    @property
    def move(self) -> Move:
        """Return the move that it is at."""
        return self._program.moves[self.point.move]

    @property
    def wait(self) -> Wait:
        """Return what keeps it from leaving its move."""
        return self._doing.wait

    @property
    def is_waiting(self) -> bool:
        """Return whether it waits for slots."""
        return bool(self.wait.lacking)

    @property
    def preparing(self) -> bool:
        """Return whether it has still to get ready."""
        return self.stage is Stage.PREPARING

    @property
    def absent(self) -> bool:
        """Return whether it did not get ready, so that it is left alone."""
        return self.stage is Stage.ABSENT

    @property
    def recovering(self) -> bool:
        """Return whether it is on its way back to where its program was broken off."""
        return self.stage is Stage.RECOVERING

    @property
    def suspended(self) -> bool:
        """Return whether its program is broken off, or could not begin, and has not ended."""
        return self.stage in (Stage.SUSPENDED, Stage.ABSENT)

    @property
    def held(self) -> bool:
        """Return whether somebody ordered it to hold, and nothing else since."""
        return self._pause.held

    @property
    def may_be_resumed(self) -> bool:
        """Return whether somebody may order it to go on, although it does nothing by itself."""
        return (self.suspended and not self.halt.released) or self.held

    @property
    def rests(self) -> bool:
        """Return whether its motors are seen to be off, those of whatever answers on its link."""
        return isinstance(self.backend, Telling) and self.backend.told().get("armed") is False

    @property
    def _underway(self) -> str:
        return self.move.id if self.point.phase is Phase.BUSY else ""

    def take_number(self) -> int:
        """Return the number of its next step, and count on."""
        self.number += 1
        return self.number - 1

    def awaited(self) -> tuple[SlotId, ...]:
        """Return the slots that must be active before it leaves its move."""
        return self._doing.awaited(self.point)

    def follow(self, step: Step, now: float) -> None:
        """Go where a step leads."""
        if step.label == "end":
            self._recovery.passed(step.move)
        if self.wait.since is not None and isinstance(self.backend, Noting):
            waited = {"slots": [name for _, name in self.awaited()], "seconds": now - self.wait.since}
            self.backend.note("wait", waited)
        self.point = step.leads_to
        self._doing.forget()

    def restore(self, records: Iterable[StepRecord]) -> None:
        """Be where its own log leads, whose steps are those of its program in order.

        Raises:
            ValueError: if they are not.
        """
        for record in records:
            self.follow(step_of(self._program, self.point, record), record.time)
            self.lamport, self.number = record.lamport, record.seq + 1

    def prepare(self, now: float) -> None:
        """Begin to get ready; once it is, its program begins, or goes on where it was broken off."""
        self.stage = self._once_ready()
        if isinstance(self.backend, Preparing):
            self.stage = Stage.PREPARING
            self.backend.prepare(now)

    def _once_ready(self) -> Stage:
        return Stage.AWAY if self.number > 0 else Stage.WORKING

    def is_unknown(self, now: float) -> bool:
        """Return whether it must not be told anything: nobody knows yet if it is the program's robot."""
        return self.preparing and not (isinstance(self.backend, Recognising) and self.backend.known(now))

    def get_ready(self, now: float) -> bool:
        """Return whether it is ready now.

        What goes wrong meanwhile is answered as on the way back to where its program was broken off, unless
        nobody knows yet whether it is the program's robot: then nobody is to touch it.
        """
        try:
            found = self.backend.fault(now)
            if found is None and self.backend.finished(now):
                self.stage = self._once_ready()
                if self.held:
                    self.hold(now)
        except LinkLostError as error:
            found = Fault(LINK_LOST, str(error))
        if found is not None:
            known = not self.is_unknown(now)
            self._suspend(found, self._answers().response(found) if known else NOTHING)
            self.halt.released = not known
            if not known:
                self.stage = Stage.ABSENT
        return not (self.preparing or self.suspended)

    def recover(self, now: float) -> None:
        """Begin to go back to where the program was broken off."""
        self.halt, self.stage = Halt(), Stage.RECOVERING
        self._doing.forget()
        if not self._recovery.begin(self._underway, now):
            self.stage = Stage.WORKING

    def hindrance(self, now: float) -> str:
        """Return why its program cannot be gone on with; empty if it can, as far as anybody knows."""
        return self.astray(now) or self._still_low(now)

    def astray(self, now: float) -> str:
        """Return that it is where its program cannot be gone on with, or out of reach; empty: it is not."""
        return self._recovery.astray(self._underway, now)

    def away(self, now: float) -> str:
        """Return why it does not stand at home, as far as anybody knows; empty where it may."""
        return self._recovery.from_home(now)

    def _still_low(self, now: float) -> str:
        if not self.halt.is_for(BATTERY_LOW):
            return ""
        return still_low(self.backend.state(now).charge, self._rules.reserve)

    def may_move(self, now: float) -> bool:
        """Return whether it is at work and its motors are seen to run, so that nobody may leave it alone."""
        return not (self.point.is_final or self.suspended) and self._recovery.moves(now)

    def is_watched(self, now: float) -> bool:
        """Return whether it has stopped, or is out of reach, so that somebody must stay with it."""
        return isinstance(self.backend, Watched) and self.backend.watched(now)

    def hold(self, now: float) -> None:
        """Have it stay where it is, once it may be told; nothing counts against others meanwhile."""
        self._pause.begin(now, known=not self.is_unknown(now))

    def go_on(self, now: float) -> None:
        """Have it be held no longer."""
        seconds = self._pause.end(now)
        self.wait.extend(seconds)
        self.notify.extend(seconds)

    def end_by(self, found: Fault, response: str) -> None:
        """Have the program end because somebody ordered that."""
        self.ordered, self.halt.released = (found, response), found.which == STOPPED
        self._pause.forget()

    def due(self, now: float, peers: Peers) -> Step | None:
        """Return the step to be made now, beginning what has to be begun; None: not yet.

        The only place where a fault of a robot, its device, its link or a condition becomes a step.
        """
        if self.absent:
            return None
        if self.ordered is not None:
            return self._ended(*self.ordered)
        if self.preparing or self.suspended:
            return None
        answers = self._answers()
        try:
            found = self._unkept(answers) or self._unanswered(answers, now) or self._due(answers, now, peers)
        except LinkLostError as error:
            found = Fault(LINK_LOST, str(error))
        if not isinstance(found, Fault):
            return found
        response = answers.response(found)
        changes_battery = found.which == BATTERY_LOW and response in COMES_DOWN
        if self.recovering or (self._rules.suspends and changes_battery):
            self._suspend(found, response)
            return None
        return self._ended(found, response)

    def _due(self, answers: Answers, now: float, peers: Peers) -> Step | Fault | None:
        if self.stage is Stage.AWAY and not self.held:
            self.recover(now)
        if self.held or self.recovering:
            found = self._detained(answers, now)
            if found is not None or self.held or self.recovering:
                return found
        return None if self.notify.is_waiting else self._doing.due(self.point, answers, now, peers)

    def _detained(self, answers: Answers, now: float) -> Fault | None:
        """Return what goes wrong while nothing else may be begun."""
        if (found := answers.unborne(self.backend, now)) is not None:
            return found
        if self.recovering and self.backend.finished(now):
            self.stage = Stage.WORKING
        return None

    def send(self) -> None:
        """Send the notify that was recorded last."""
        self.notify.send(self.lamport)

    def next_event(self, now: float) -> float | None:
        """Return when something may have changed; inf: only slots can wake it; None: unknown."""
        if self.point.is_final:
            return inf
        event = self.backend.next_event(now)
        return min(event, self.wait.deadline) if event is not None else None

    def overtaken_by(self, found: Fault) -> bool:
        """Return whether a fault is answered now although the robot still answers another one."""
        if not self.halt.is_overtaken_by(found):
            return False
        self.halt.answer(found, self._answers().response(found))
        return True

    def fail(self, found: Fault) -> None:
        """End the program by a fault that cannot be recorded."""
        step = self._ended(found, self._answers().response(found))
        self.point = step.leads_to

    def _suspend(self, found: Fault, response: str) -> None:
        """Break the program off; its log ends where it can be taken up again."""
        self.notify.give_up()
        self.halt.end(found, response)
        self.stage = Stage.SUSPENDED
        self._pause.forget()

    def _ended(self, found: Fault, response: str) -> Step:
        self.notify.give_up()
        self.halt.end(found, response)
        self.ordered, self.stage = None, Stage.WORKING
        self._pause.forget()
        return fault(self._program, self.point, found.which if self._rules.live else str(found))

    def _unkept(self, answers: Answers) -> Fault | None:
        """Return the fault that is left where what others tell this robot cannot be kept."""
        why = "" if self.point.is_final else self._bus.trouble(self.id)
        found = Fault(LOG_FAILED, why)
        return found if why and not answers.bears(found) else None

    def _unanswered(self, answers: Answers, now: float) -> Fault | None:
        """Return the fault that ends waiting for owners of slots; None: they have answered, or still may."""
        silence = None if self.held else self.notify.silence(now)
        if silence is None:
            return None
        if (found := answers.unborne(self.backend, now)) is not None:
            return found
        found = Fault(PEER_LOST, self.notify.why(self._bus))
        return found if silence >= answers.patience(found) else None

    def _answers(self) -> Answers:
        """Return what it does about faults here, a wait's own policies first."""
        declared = self._policies
        if self.point.phase is Phase.OUT:
            declared = (*self._program.transitions[self.point.move].policies, *declared)
        return Answers(declared, live=self._rules.live)
