"""The life of one robot of a run: its program, step by step, and its response when that breaks off.

`Life.go` is a generator. Wherever the robot has to wait, it yields `Until`, and is resumed at that time or
on an event; what ends its program is raised there, whatever its source: the vehicle, the slots, a
condition, or an order.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import replace
from typing import TypeAlias

from ..bus.messages import CommandId, Find
from ..conditions import awaiting, question_of
from ..faults import BATTERY_LOW, DEVICE_SILENT, LINK_LOST, LOG_FAILED, PEER_LOST, reason_of
from ..policies import COMES_DOWN, CONTINUE, NOTHING
from ..program import Choose, Notify, SlotId, Then
from ..records.steps import StepRecord
from ..semantics import Phase, PossibleStep, action_at, awaited, fault, steps
from ..slots import with_own
from ..vehicle import Fault, LinkLost, Progress, VehicleState
from .decisions import Asking, decided
from .event_queue import Until
from .situation import Situation, Stage
from .waits import NotifyWait, silent

DISK_SECONDS = 5.0
"""Real seconds after which a log that is not on the disk yet counts as one that cannot be written."""

PACE = 0.05
"""Seconds between two looks at what cannot say when to look again."""

Waits: TypeAlias = Generator[Until, None, None]


class Broken(Exception):  # noqa: N818  # the word for what happens to a program
    """The program is broken off.

    Attributes:
        found: why.
        response: the response that was ordered; None: its policies decide.
        unkept: the step that could not be recorded, so that it may not be made; None: all could.
    """

    def __init__(
        self, found: Fault, response: str | None = None, *, unkept: StepRecord | None = None
    ) -> None:
        super().__init__(str(found))
        self.found, self.response, self.unkept = found, response, unkept


class Life(Situation):
    """A robot while it runs."""

    # The program.

    def go(self) -> Waits:
        """Get ready, carry the program out, and respond when it breaks off, as often as it does."""
        if self.point.is_final:
            return
        while True:
            try:
                yield from self._get_ready()
                yield from self._run.stopping.stay_with(self)
                yield from self._return_to_work()
                while not self.point.is_final:
                    yield from self._step()
                self._run.dismiss(self, failed=False)
                return
            except Broken as broken:
                self._break_off(broken)
            except LinkLost as lost:
                self._break_off(Broken(Fault(LINK_LOST, str(lost))))
            if self.is_absent or (self.point.is_final and not self._live):
                return

    def _step(self) -> Waits:
        """Do what the point in the program asks for, then make the step."""
        if self.held or self.ordered is not None or self._slots.trouble(self.id):
            yield from self._gate()
        phase = self.point.phase
        if phase is Phase.OUT:
            yield from self._go_on()
            return
        if phase is not Phase.READY:
            action = action_at(self.robot, self.point)
            if isinstance(action, Notify):
                yield from self._notify()
                return
            if action is not None:
                yield from self._carry_out(action)
            else:
                yield from self._carry_out(self.move.order, through=self._may_pass())
        if self._run.is_full:
            yield from self._room()
        self._make(self._next())

    def _next(self) -> PossibleStep:
        return steps(self.robot, self.point, frozenset())[0]

    def _carry_out(self, order: object, *, through: bool = False) -> Waits:
        """Order an action from the vehicle, and wait until it is done; a silent device may be skipped."""
        movement = self.point.phase is Phase.BUSY
        vehicle = self.vehicle
        vehicle.do(order, self.now(), through=through)
        while True:
            silent = self._look()
            if vehicle.done or (silent and not movement):
                return
            yield self._later()
            yield from self._gate()

    def _notify(self) -> Waits:
        """Set slots: ask their owners where needed, record it, and wait for their acknowledgements."""
        step = self._next()
        id = CommandId(self._run.terms.run, self.id, self._run.terms.incarnation, self.number)
        delivery = self._slots.prepare(id, step.sets, step.active, self._finds())
        self.sending = True
        try:
            self._outgoing = NotifyWait()
            while delivery.lamport is None:
                yield from self._await_owners(delivery.waiting)
            yield from self._room()
            self._make(step, delivery.lamport)
            yield from self._kept()
            delivery.send(self.lamport)
            self._run.notified(owner for owner, _ in step.sets)
            self._outgoing = NotifyWait()
            while delivery.waiting:
                yield from self._await_owners(delivery.waiting)
        except BaseException:
            delivery.abort()
            raise
        finally:
            self.sending = False

    def _await_owners(self, owners: tuple[str, ...]) -> Waits:
        self._look()
        if not self.held:
            found, answers = Fault(PEER_LOST, silent(owners, self._slots)), self.answers()
            if self._outgoing.silence(self.now()) >= answers.patience(found, away=True):
                raise Broken(found)
        self._unsure = True
        yield self._later()
        self._unsure = False
        yield from self._gate()

    def _go_on(self) -> Waits:
        """Leave a move: wait for slots, and for what decides a choice."""
        robot, names = self.robot, awaited(self.robot, self.point)
        chosen: bool | None = None
        while True:
            active = {slot for slot in names if self._slots.state(slot).active}
            possible = steps(robot, self.point, active)
            if len(possible) > 1:
                chosen = chosen if chosen is not None else self._decision()
                possible = () if chosen is None else (possible[0 if chosen else 1],)
            lamport = self._after(names)
            if possible and self._passes(names, lamport):
                if self._run.is_full:
                    yield from self._room()
                self._make(possible[0], lamport)
                return
            if not possible:
                self._keep_waiting(tuple(slot[1] for slot in names if slot not in active))
            self._unsure = bool(self.wait.question) or not self._run.whole
            yield self._later()
            self._unsure = False
            yield from self._gate()

    def _passes(self, names: tuple[SlotId, ...], lamport: int) -> bool:
        """Return whether a wait for slots is passed at that time: they are not kept for any sender then."""
        if not names:
            return True
        if not self._slots.passed(names, lamport):
            return False
        self.teach()
        return True

    def _after(self, names: tuple[SlotId, ...]) -> int:
        """Return the logical time of a step after all that has happened to slots."""
        return max((self.lamport + 1, *(self._slots.state(slot).lamport + 1 for slot in names)))

    def _keep_waiting(self, lacking: tuple[str, ...]) -> None:
        now = self.now()
        self.wait.lacking = lacking
        if self.wait.begin(now):
            self.vehicle.wait(now)
            if lacking:
                self._run.say(self, f"waits for {', '.join(map(ascii, lacking))}")
        self._look()
        if (found := self.wait.overdue(now, self.answers(), self._run.peers)) is not None:
            raise Broken(found)

    def _decision(self) -> bool | None:
        """Return the decision of a choice; None while it cannot be known."""
        then = self.move.then
        assert isinstance(then, Choose)
        condition, answers = self._run.conditions[then.condition], self.questions.answers()
        holds: bool | Fault | None
        if condition.instant or not self._live:
            holds = decided(condition, lambda: self._known(answers))
        else:
            if self.wait.asking is None:
                if self.now() < self.wait.ask_at:
                    return None
                self.wait.asking = Asking(condition, self._known(answers), answers, self._wake)
            asking, self.wait.question = self.wait.asking, then.condition
            if not asking.look():
                if asking.is_slow:
                    self._tell_undecided(then.condition)
                return None
            holds, answers, self.wait.asking = asking.answer, asking.answers, None
            self.wait.ask_at = self.now() + PACE
        if isinstance(holds, Fault):
            raise Broken(holds)
        if holds is not None:
            self.questions.use_up(answers)
        else:
            self.wait.question, self.questions.asked = then.condition, question_of(then.condition)
            self._tell_undecided(then.condition)
        return holds

    def _tell_undecided(self, condition: str) -> None:
        """Report once what a choice waits for."""
        if not self.wait.is_told:
            self.wait.is_told = True
            words = awaiting(condition)
            self._run.say(self, words)
            self.decided("CHOICE", condition, words)

    def _wake(self) -> None:
        self.vehicle.post(Progress())

    def _known(self, answers: Mapping[str, bool]) -> VehicleState:
        state = self.vehicle.state(self.now())
        reported = frozenset(name for name, _ in self._slots.finds(self.id))
        return replace(state, answers=answers, found=state.detected | reported)

    def _may_pass(self) -> bool:
        """Return whether nothing as yet keeps the robot from going into its next move without a stop."""
        then = self.move.then
        if not isinstance(then, Then) or not then.fluid:
            return False
        between = (*self.move.after, *self.robot.by_id[then.move].before)
        waits = ((self.id, name) for name in then.waits)
        return all(isinstance(each, Notify) for each in between) and all(
            self._slots.state(slot).active for slot in waits
        )

    # Waiting.

    def _gate(self) -> Waits:
        """Wait while the robot is held; raise what is to end its program."""
        while True:
            if self.ordered is not None:
                raise Broken(*self.ordered)
            if why := self._slots.trouble(self.id):
                self._bear_trouble(why)
            if not self.held:
                return
            self._look()
            yield self._later()

    def _bear_trouble(self, why: str) -> None:
        """Continue, and report it once, although incoming notifies cannot be kept; break off if it must."""
        found = Fault(LOG_FAILED, why)
        if not self.answers().bears(found):
            raise Broken(found)
        if why != self._borne:
            self._borne = why
            self._run.say(self, f"carries on although {why}")
            self.decided(LOG_FAILED, why, CONTINUE)

    def _room(self) -> Waits:
        """Wait without end once the run has made its maximum number of steps."""
        while self._run.is_full:
            yield Until()

    def _look(self) -> bool:
        """Look at the vehicle; return whether a device is silent, and that is tolerated.

        Raises:
            Broken: there is another fault.
        """
        vehicle = self.vehicle
        self._looked = now = self.now()
        self._look_at = vehicle.look(now)
        found = vehicle.trouble
        if found is None:
            return False
        if not self.answers().bears(found) or not vehicle.bear(now):
            raise Broken(found)
        self._look_at = vehicle.look(now)
        return found.which == DEVICE_SILENT

    def _later(self) -> Until:
        """Return when to continue at the latest."""
        now = self._run.clock.now()
        event = min(self._look_at, self.wait.deadline)
        if event <= self._looked:
            event = now + PACE
        return Until(min(event, now + PACE) if self._unsure else event)

    # Steps, and what robots tell each other with them.

    def _make(self, step: PossibleStep, least: int = 0) -> None:
        """Make a step, once it is recorded."""
        lamport = max(self.lamport + 1, least)
        now = self.now()
        reported = (step.label, step.move, step.detail, step.slot)
        record = StepRecord(self._run.terms.run, self.id, self.number, lamport, round(now, 6), *reported)
        try:
            self._run.made(record)
        except OSError as error:
            if not self._live:
                raise
            if step.label != "fault":
                raise Broken(Fault(LOG_FAILED, reason_of(error)), unkept=record) from error
            self._unkept(error)
        if step.label == "fault":
            self._run.sync(self.id, self._unkept)
        self.lamport, self.number, self.last = lamport, self.number + 1, record
        self.follow(step, now)

    def _kept(self) -> Waits:
        """Wait until the steps made are on the disk: a step that may yet be lost is not announced."""
        if self._run.terms.sync is None:
            return
        kept: list[OSError | None] = []

        def answered(error: OSError | None) -> None:
            kept.append(error)
            self._wake()

        self._run.sync(self.id, answered)
        until = self.now() + DISK_SECONDS * self._speedup
        while not kept and self.now() < until:
            yield Until(min(until, self.now() + PACE))
            if self.ordered is not None:
                raise Broken(*self.ordered)
        if error := kept[0] if kept else TimeoutError(f"the disk has not answered for {DISK_SECONDS:g} s"):
            raise Broken(Fault(LOG_FAILED, reason_of(error)))

    def _unkept(self, error: OSError | None) -> None:
        """Report if the log lacks its fault; from any thread."""
        if error is not None:
            self._run.say(self, f"the fault is not in the log: {reason_of(error)}")

    def _finds(self) -> tuple[Find, ...]:
        """Return what it, and those that notified it, have detected; its own only while it is reached."""
        reported = self._slots.finds(self.id)
        try:
            state = self.vehicle.state(self.now())
        except LinkLost:
            return reported
        return with_own(reported, state) if state.detected else reported

    # Getting ready, and back to work.

    def begin(self, *, prepare: bool) -> None:
        """Begin: get ready first, or go back to where the program was broken off, if that is needed."""
        self.teach()
        if self.point.is_final:
            self._run.dismiss(self, failed=self.point.phase is Phase.FAILED)
        elif prepare:
            self.stage = Stage.AWAY if self.number > 0 else Stage.WORKING
            if self.vehicle.prepare(self.now()):
                self.stage = Stage.PREPARING
        elif self.number > 0:
            self.recover()

    def _get_ready(self) -> Waits:
        """Wait until the robot is ready.

        Faults meanwhile are answered as on the return to where its program was broken off, unless
        it is still unknown whether it is the program's robot: then it must not be touched.
        """
        while self.is_preparing:
            if self.ordered is not None:
                raise Broken(*self.ordered)
            self._looked = now = self.now()
            self._look_at = self.vehicle.look(now)
            if (found := self.vehicle.trouble) is not None:
                raise Broken(found)
            if self.vehicle.done:
                self.stage = Stage.AWAY if self.number > 0 else Stage.WORKING
                if self.held:
                    self.hold()
                self._run.obey()  # what was to wait until it is ready goes before anything else
            else:
                yield self._later()

    def _return_to_work(self) -> Waits:
        """Wait until the robot is where its program continues."""
        if self.stage is Stage.AWAY:
            yield from self._gate()
            self.recover()
        while self.stage is Stage.RECOVERING:
            yield from self._gate()
            self._look()
            if self.vehicle.done:
                self.stage = Stage.WORKING
            else:
                yield self._later()

    # When the program breaks off.

    def _break_off(self, broken: Broken) -> None:
        """End the program, or only suspend it, and let the robot respond."""
        found, response = broken.found, broken.response
        preparing = self.is_preparing
        strange = preparing and response is None and self.is_unknown()
        if response is None:
            response = NOTHING if strange else self.answers().response(found)
            low = found.which == BATTERY_LOW and response in COMES_DOWN
            away = preparing or self.stage is Stage.RECOVERING
            if away or (low and self._run.terms.suspends):
                self._suspend(found, response, strange=strange)
                return
        self.forget_hold()
        self.halt.end(found, response)
        self.ordered, self.stage = None, Stage.WORKING
        ended = fault(self.robot, self.point, found.which if self._live else str(found))
        if broken.unkept is not None:
            self._run.keep(broken.unkept._replace(label="fault", detail=LOG_FAILED, slot=""))
            self._run.sync(self.id, self._unkept)
            self.point = ended.leads_to
        else:
            self._make(ended)
        self._run.dismiss(self, failed=True)
        self._run.stopping.answer(self, found)

    def _suspend(self, found: Fault, response: str, *, strange: bool) -> None:
        """Break the program off; its log ends where it can be taken up again."""
        self.forget_hold()
        self.halt.end(found, response)
        self.halt.released = strange
        self.stage = Stage.ABSENT if strange else Stage.SUSPENDED
        if strange:
            self._run.leave_alone(self, found)
        else:
            self._run.stopping.answer(self, found)
