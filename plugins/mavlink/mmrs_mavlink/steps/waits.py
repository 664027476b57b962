"""Waits for other robots and for people: for slots, for owners of slots, for answers to questions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from mmrs_runtime.conditions import awaiting, question_of, truth
from mmrs_runtime.faults import CONDITION_FAILED, FAILURES, LINK_LOST, PEER_LOST, WAIT_TOO_LONG, Fault
from mmrs_runtime.policies import CONTINUE, UNDECLARED_AFTER, seconds_of

from ..desk import Desk
from ..program import Choose, Policy, Robot, Then
from ..vehicles.vehicle import Vehicle
from .journal import Journal
from .responses import BLOCKED, alone, policy_for

GLANCE_SECONDS = 0.1
LEAST_PEER_SECONDS = 2.0
"""Real seconds that other processes have at least, however fast the vehicles run."""


class Waits:
    """Waits, and knows how long a robot bears what goes wrong meanwhile; time in which it is held counts not.

    Attributes:
        policies: of the wait that the robot is in; they go before the robot's own.
    """

    def __init__(
        self,
        robot: Robot,
        vehicle: Vehicle,
        desk: Desk,
        journal: Journal,
        held: Callable[[], float],
    ) -> None:
        """Wait for nothing yet; `held` tells for how many seconds the robot was held so far."""
        self.policies: tuple[Policy, ...] = ()
        self._robot = robot
        self._vehicle = vehicle
        self._desk = desk
        self._journal = journal
        self._held = held
        self._borne: set[str] = set()

    def leave(self, then: Then | Choose) -> str:
        """Return the move that comes next, once the robot may go on to it.

        Raises:
            Fault: it may not, and its policies say that this ends the program.
        """
        self._follow(then.policies)
        if isinstance(then, Choose):
            following = self._choose(then)
        else:
            self._await(then.waits, lambda lamport: self._journal.write("take", then.move, "", lamport))
            following = then.move
        self._follow(())
        return following

    def now(self) -> float:
        """Return the seconds since the run began in which nobody held the robot: others answer for these."""
        return self._desk.clock.now() - self._held()

    def delivery(self) -> Callable[[tuple[str, ...]], None]:
        """Return what is to be called with the robots that have not answered a notification yet."""
        begun = self.now()

        def check(silent: tuple[str, ...]) -> None:
            self._vehicle.rest(0.0)
            if self.now() - begun > self._peer_seconds():
                why = f"no answer from {_listed(silent)}"
                if unseen := self._desk.slots.unseen(silent):
                    why += f"; {_listed(unseen)} never came while this robot was there, or had ended before"
                self.raise_unless_carried_on(Fault(PEER_LOST, why))

        return check

    def raise_unless_carried_on(self, fault: Fault) -> None:
        """Raise a fault, or only say it where a policy has the robot carry on."""
        if policy_for(fault.event, self._robot, self.policies).response != CONTINUE:
            raise fault
        if str(fault) in self._borne:
            return
        self._borne.add(str(fault))
        self._journal.decide(fault.event, str(fault), CONTINUE)
        self._desk.say(f"{self._robot.id!r} carries on although {fault}")

    def patience(self, event: str, usual: Mapping[str, float] = UNDECLARED_AFTER) -> float:
        """Return for how many seconds the robot bears an event; `usual` where policies do not say."""
        return seconds_of(policy_for(event, self._robot, self.policies), usual)

    def tell_vehicle(self) -> None:
        """Tell the vehicle what it must do without us, here."""
        wanted = policy_for(LINK_LOST, self._robot, self.policies)
        policy = alone(wanted, self._robot)
        if policy != wanted:
            self._desk.say(f"{self._robot.id!r}: {BLOCKED}")
        self._vehicle.answer_lost_link(policy.response, policy.after)

    def _follow(self, policies: tuple[Policy, ...]) -> None:
        """Take up the policies of a wait, and tell the vehicle what it must do without us then."""
        before = policy_for(LINK_LOST, self._robot, self.policies)
        after = policy_for(LINK_LOST, self._robot, policies)
        self.policies = policies
        self._borne.clear()
        if after != before:
            self.tell_vehicle()

    def _choose(self, then: Choose) -> str:
        self._await(then.waits, None)
        holds = self._decided(then.condition)
        chosen = "true" if holds else "false"
        self._await(then.waits, lambda lamport: self._journal.write("choose", chosen, "", lamport))
        return then.move if holds else then.otherwise

    def _decided(self, condition: str) -> bool:
        """Return whether a condition holds, once that can be said."""
        begun = self.now()
        told = False
        try:
            while (holds := self._asked(condition)) is None:
                if not told:
                    told = True
                    self._tell_undecided(condition)
                self._check_patience(condition, begun)
                self._vehicle.rest(self._desk.clock.patience(0.0, GLANCE_SECONDS))
        finally:
            self._desk.questions.asked = ""
        return holds

    def _tell_undecided(self, condition: str) -> None:
        words = awaiting(condition)
        self._desk.questions.asked = question_of(condition)
        self._desk.say(f"{self._robot.id!r} {words}")
        self._journal.decide("CHOICE", condition, words)

    def _asked(self, condition: str) -> bool | None:
        heard = self._desk.questions.heard()
        known = self._vehicle.state()
        found = known.detected | self._desk.slots.found(self._robot.id)
        state = replace(known, answers=heard, found=found)
        try:
            said = self._desk.conditions[condition](state)
            holds = None if said is None else truth(said)
        except FAILURES as error:
            raise Fault(CONDITION_FAILED, f"condition {condition!r} fails: {error!r}") from error
        if holds is not None:
            self._desk.questions.use_up(heard)
        return holds

    def _await(self, names: tuple[str, ...], record: Callable[[int], None] | None) -> None:
        slots, clock = self._desk.slots, self._desk.clock
        kept = record if record is not None else (lambda lamport: None)
        since = clock.now()
        begun = alone = self.now()
        told = False
        while not slots.take(self._robot.id, names, kept):
            if not told:
                self._desk.say(f"{self._robot.id!r} waits for {', '.join(map(ascii, names))}")
                told = True
            if not self._orphaned(names):
                alone = self.now()
            self._check(names, begun, alone)
            slots.await_change(GLANCE_SECONDS)
            self._vehicle.rest(0.0)
        if told:
            self._journal.waited(names, clock.now() - since)

    def _check(self, names: tuple[str, ...], begun: float, alone: float) -> None:
        shown = ", ".join(map(ascii, names))
        self._check_patience(shown, begun)
        if self.now() - alone > self._peer_seconds():
            self.raise_unless_carried_on(Fault(PEER_LOST, f"no robot is left that sets {shown}"))

    def _peer_seconds(self) -> float:
        return self._desk.clock.patience(self.patience(PEER_LOST), LEAST_PEER_SECONDS)

    def _check_patience(self, what: str, begun: float) -> None:
        limit = self.patience(WAIT_TOO_LONG)
        if self.now() - begun > limit:
            self.raise_unless_carried_on(Fault(WAIT_TOO_LONG, f"waited more than {limit:.0f} s for {what}"))

    def _orphaned(self, names: tuple[str, ...]) -> bool:
        slots, senders = self._desk.slots, dict(self._robot.senders)
        for name in names:
            alone = all(slots.lost((sender,)) for sender in senders.get(name, ()))
            if alone and not slots.take(self._robot.id, (name,), lambda lamport: None):
                return True
        return False


def _listed(names: Iterable[str]) -> str:
    return ", ".join(map(ascii, names))
