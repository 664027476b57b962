"""One robot of a run: where it is in its program, and what its backend is doing."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from mmrs_core.behaviour.program import Action, Move, RobotProgram, SlotId
from mmrs_core.behaviour.semantics import NOTIFY, Phase, Step, action_at, entry, fault, steps
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.contributions.abilities import Bearing, Noting, Preparing, Recognising, Recovering, Watched
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.buses import Bus
from mmrs_core.contributions.execution import Fault
from mmrs_core.errors import LinkLostError
from mmrs_core.flight.faults import LINK_LOST, STOPPED, TAKEN_OVER
from mmrs_core.flight.policies import COMES_DOWN, NOTHING, OVERTAKES, still_low
from mmrs_core.runtime.answers import Answers
from mmrs_core.runtime.choosing import Choosing
from mmrs_core.runtime.outgoing import Outgoing
from mmrs_core.runtime.pausing import Pause
from mmrs_core.runtime.peers import Peers
from mmrs_core.runtime.resuming import step_of
from mmrs_core.runtime.rules import Rules
from mmrs_core.runtime.waiting import Wait

OVERTAKING = OVERTAKES | {TAKEN_OVER}


class RunningRobot:
    """A robot while it runs.

    Attributes:
        point: where it is in its program.
        lamport: its logical time.
        looked: when it was looked at last; what happens after that has yet to be seen.
        wait: what keeps it from leaving its move.
        fault: what ended its mission; None as long as nothing did.
        notify: that owners of slots have still to answer or to acknowledge.
        number: of its next step.
        response: how it was told to stop.
        broken_off: how it was told to stop before somebody ordered it to hold meanwhile.
        ordered: what ends its program because somebody ordered that, and the response; None: nobody did.
        released: whether somebody ordered it to stop, so that it need not be watched, and nothing since.
        suspended: whether its program is broken off, until its battery was changed, or because it could not
            be taken up again.
        stopping: whether it has still to confirm that it has stopped.
        down: whether it has come down, as it was told to, and not gone on since.
        rested: whether its motors were seen to be off then.
        recovering: whether it is on its way back to where its program was broken off.
        preparing: whether it has still to get ready.
        absent: whether it did not get ready, so that it is left alone.
        questions: that its choices ask the operator.
    """

    def __init__(self, program: RobotProgram, backend: Backend, bus: Bus, rules: Rules) -> None:
        self.id = program.id
        self.backend = backend
        self.point = entry(program, program.start)
        self.lamport = 0
        self.looked = 0.0
        self.wait = Wait(program.id)
        self.fault: Fault | None = None
        self.notify = Outgoing()
        self.number = 0
        self.response = self.broken_off = ""
        self.ordered: tuple[Fault, str] | None = None
        self.released = self.suspended = self.stopping = self.down = self.recovering = False
        self.preparing = self.absent = self.rested = self._returns = False
        self._pause = Pause(backend)
        self._choosing = Choosing(program, backend, rules)
        self.questions = self._choosing.questions
        self._program, self._bus, self._rules = program, bus, rules
        self._policies = (*program.policies, *rules.policies)
        self._passed: list[str] = []
        self._answered: set[str] = set()
        self._begun = False

    @property
    def move(self) -> Move:
        """Return the move that it is at."""
        return self._program.moves[self.point.move]

    @property
    def is_waiting(self) -> bool:
        """Return whether it waits for slots."""
        return bool(self.wait.lacking)

    def take_number(self) -> int:
        """Return the number of its next step, and count on."""
        self.number += 1
        return self.number - 1

    def awaited(self) -> tuple[SlotId, ...]:
        """Return the slots that must be active before it leaves its move."""
        if self.point.phase is not Phase.OUT:
            return ()
        return tuple((self.id, name) for name in self._program.transitions[self.point.move].waits)

    def follow(self, step: Step, now: float) -> None:
        """Go where a step leads."""
        if step.label == "end":
            self._passed.append(step.move)
        if self.wait.since is not None and isinstance(self.backend, Noting):
            waited = {"slots": [name for _, name in self.awaited()], "seconds": now - self.wait.since}
            self.backend.note("wait", waited)
        self.point = step.leads_to
        self._forget()

    def restore(self, records: Iterable[StepRecord]) -> None:
        """Be where its own log leads, whose steps are those of its program in order.

        Raises:
            ValueError: if they are not.
        """
        for record in records:
            self.follow(step_of(self._program, self.point, record), record.time)
            self.lamport, self.number = record.lamport, record.seq + 1

    def hindrance(self, now: float) -> str:
        """Return why its program cannot be gone on with; empty if it can, as far as anybody knows."""
        return self.astray(now) or self._still_low(now)

    def astray(self, now: float) -> str:
        """Return that it is where its program cannot be gone on with, or out of reach; empty: it is not."""
        if not isinstance(self.backend, Recovering):
            return ""
        return self.backend.hindrance(tuple(self._passed), self._underway, now)

    def away(self, now: float) -> str:
        """Return why it does not stand at home, as far as anybody knows; empty where it may."""
        return self.backend.away(now) if isinstance(self.backend, Recovering) else ""

    def _still_low(self, now: float) -> str:
        if self.fault is None or self.fault.which != "BATTERY_LOW":
            return ""
        return still_low(self.backend.state(now).charge, self._rules.reserve)

    def is_watched(self, now: float) -> bool:
        """Return whether it has stopped, or is out of reach, so that somebody must stay with it."""
        return isinstance(self.backend, Watched) and self.backend.watched(now)

    def recover(self, now: float) -> None:
        """Begin to go back to where the program was broken off."""
        self.fault, self.suspended, self.response, self.broken_off = None, False, "", ""
        self.released = self.down = self.rested = self._returns = False
        self._answered.clear()
        self._forget()
        if isinstance(self.backend, Recovering):
            self.recovering = True
            self.backend.recover(tuple(self._passed), self._underway, now)

    @property
    def may_be_resumed(self) -> bool:
        """Return whether somebody may order it to go on, although it does nothing by itself."""
        return (self.suspended and not self.released) or self.held

    def may_move(self, now: float) -> bool:
        """Return whether it is at work and its motors are seen to run, so that nobody may leave it alone."""
        at_work = not (self.point.is_final or self.suspended)
        return at_work and isinstance(self.backend, Recovering) and self.backend.moves(now)

    @property
    def held(self) -> bool:
        """Return whether somebody ordered it to hold, and nothing else since."""
        return self._pause.held

    def hold(self, now: float) -> None:
        """Have it stay where it is, once it may be told; nothing counts against others meanwhile."""
        self._pause.begin(now, known=not self.is_unknown(now))

    def go_on(self, now: float) -> None:
        """Have it be held no longer."""
        seconds = self._pause.end(now)
        self.wait.extend(seconds)
        self.notify.extend(seconds)

    def prepare(self, now: float) -> None:
        """Begin to get ready; once it is, its program begins, or goes on where it was broken off."""
        self._returns = self.number > 0
        if isinstance(self.backend, Preparing):
            self.preparing = True
            self.backend.prepare(now)

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
                self.preparing = False
                if self.held:
                    self.hold(now)
        except LinkLostError as error:
            found = Fault(LINK_LOST, str(error))
        if found is not None:
            known = not self.is_unknown(now)
            self._suspend(found, self._answers().response(found) if known else NOTHING)
            self.preparing, self.absent, self.released = False, not known, not known
        return not (self.preparing or self.suspended)

    @property
    def _underway(self) -> str:
        return self.move.id if self.point.phase is Phase.BUSY else ""

    def end_by(self, found: Fault, response: str) -> None:
        """Have the program end because somebody ordered that."""
        self.ordered, self.released = (found, response), found.which == STOPPED
        self._pause.forget()

    def due(self, now: float, peers: Peers) -> Step | None:
        """Return the step to be made now, beginning what has to be begun; None: not yet.

        The only place where a fault of a robot, its device, its link or a condition becomes a step.
        """
        if self.absent or (self.preparing and self.ordered is None):
            return None
        if self.suspended:
            return self._ended(*self.ordered) if self.ordered is not None else None
        if self.ordered is not None:
            return self._ended(*self.ordered)
        try:
            found = self._unkept() or self._unanswered(now) or self._due(now, peers)
        except LinkLostError as error:
            found = Fault("LINK_LOST", str(error))
        if not isinstance(found, Fault):
            return found
        response = self._answers().response(found)
        changes_battery = found.which == "BATTERY_LOW" and response in COMES_DOWN
        if self.recovering or (self._rules.suspends and changes_battery):
            self._suspend(found, response)
            return None
        return self._ended(found, response)

    def send(self) -> None:
        """Send the notify that was recorded last."""
        self.notify.send(self.lamport)

    def next_event(self, now: float) -> float | None:
        """Return when something may have changed; inf: only slots can wake it; None: unknown."""
        if self.point.is_final:
            return inf
        event = self.backend.next_event(now)
        return min(event, self.wait.deadline) if event is not None else None

    def _suspend(self, found: Fault, response: str) -> None:
        """Break the program off; its log ends where it can be taken up again."""
        self.notify.give_up()
        self.fault, self.response, self.suspended = found, response, True
        self.recovering = False
        self._pause.forget()
        self._answered.add(found.which)

    def overtaken_by(self, found: Fault) -> bool:
        """Return whether a fault is answered now although the robot still answers another one."""
        if not found.instead and (found.which not in OVERTAKING or found.which in self._answered):
            return False
        self._answered.add(found.which)
        self.response = self._answers().response(found)
        return True

    def fail(self, found: Fault) -> None:
        """End the program by a fault that cannot be recorded."""
        step = self._ended(found, self._answers().response(found))
        self.point = step.leads_to

    def _ended(self, found: Fault, response: str) -> Step:
        self.notify.give_up()
        self.fault, self.response = found, response
        self._answered.add(found.which)
        self.ordered = None
        self.suspended = self.recovering = self.preparing = False
        self._pause.forget()
        return fault(self._program, self.point, found.which if self._rules.live else str(found))

    def _forget(self) -> None:
        self._begun, self.wait = False, Wait(self.id)
        self._choosing.forget()

    def _unkept(self) -> Fault | None:
        """Return the fault that is left where what others tell this robot cannot be kept."""
        why = "" if self.point.is_final else self._bus.trouble(self.id)
        found = Fault("LOG_FAILED", why)
        return found if why and not self._answers().bears(found) else None

    def _unanswered(self, now: float) -> Fault | None:
        """Return the fault that ends waiting for owners of slots; None: they have answered, or still may."""
        silence = None if self.held else self.notify.silence(now)
        if silence is None:
            return None
        if (found := self._unborne(now)) is not None:
            return found
        found = Fault("PEER_LOST", self.notify.why(self._bus))
        return found if silence >= self._answers().patience(found) else None

    def _unborne(self, now: float) -> Fault | None:
        """Return what the backend says went wrong, unless the robot goes on as if nothing were."""
        found = self.backend.fault(now)
        if found is None or not self._answers().bears(found):
            return found
        goes_on = not isinstance(self.backend, Bearing) or self.backend.bear(now)
        return None if goes_on else found

    def _due(self, now: float, peers: Peers) -> Step | Fault | None:
        if self._returns and not self.held:
            self.recover(now)
        if self.held or self.recovering:
            found = self._detained(now)
            if found is not None or self.held or self.recovering:
                return found
        if self.notify.is_waiting:
            return None
        phase = self.point.phase
        if phase is Phase.READY:
            return self._next()
        if phase is Phase.OUT:
            return self._way_on(now, peers)
        action = action_at(self._program, self.point)
        if action is not None and action.is_a(NOTIFY):
            return self._next()
        return self._activity(action, now)

    def _detained(self, now: float) -> Fault | None:
        """Return what goes wrong while nothing else may be begun."""
        if (found := self._unborne(now)) is not None:
            return found
        if self.recovering and self.backend.finished(now):
            self.recovering = False
        return None

    def _next(self) -> Step:
        return steps(self._program, self.point, frozenset())[0]

    def _activity(self, action: Action | None, now: float) -> Step | Fault | None:
        """Begin the action, or the movement where there is none, and look whether it has finished."""
        if not self._begun:
            self._begun = True
            if action is not None:
                self.backend.act(action, now)
            else:
                self.backend.begin(self.move, now, through=self._may_pass())
        trouble = self.backend.fault(now)
        if (found := self._unborne(now)) is not None:
            return found
        skipped = action is not None and trouble is not None and trouble.which == "DEVICE_SILENT"
        return self._next() if skipped or self.backend.finished(now) else None

    def _way_on(self, now: float, peers: Peers) -> Step | Fault | None:
        active = {slot for slot in self.awaited() if self._bus.state(slot).active}
        possible = steps(self._program, self.point, active)
        if not possible:
            return self._wait(now, active, peers)
        if len(possible) == 1:
            return possible[0]
        condition = self._program.transitions[self.point.move].condition or ""
        holds = self._choosing.decision(condition, self.wait, now)
        if holds is None:
            return self._wait(now, active, peers)
        if isinstance(holds, Fault):
            return holds
        return possible[0] if holds else possible[1]

    def _wait(self, now: float, active: set[SlotId], peers: Peers) -> Fault | None:
        self.wait.lacking = tuple(name for owner, name in self.awaited() if (owner, name) not in active)
        if self.wait.begin(now):
            self.backend.wait(now)
        return self._unborne(now) or self.wait.overdue(now, self._answers(), peers)

    def _may_pass(self) -> bool:
        """Return whether nothing as yet keeps it from going into the next move without a stop."""
        if self.point.move == self._program.stop:
            return False
        transition = self._program.transitions[self.point.move]
        if not transition.fluid or transition.condition is not None:
            return False
        following = self._program.moves[transition.to]
        blocking = (action for action in (*self.move.after, *following.before) if not action.is_a(NOTIFY))
        slots = ((self.id, name) for name in transition.waits)
        return next(blocking, None) is None and all(self._bus.state(slot).active for slot in slots)

    def _answers(self) -> Answers:
        """Return what it does about faults here, a wait's own policies first."""
        declared = self._policies
        if self.point.phase is Phase.OUT:
            declared = (*self._program.transitions[self.point.move].policies, *declared)
        return Answers(declared, live=self._rules.live)
