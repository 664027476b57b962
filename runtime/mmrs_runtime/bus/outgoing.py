"""What one process has to tell others until all have answered: notifies, and news of its robots."""

from __future__ import annotations

import json
import random
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite

from .carriers.carrier import Carrier
from .messages import (
    LARGEST,
    LONGEST_NAME,
    MOST_FINDS,
    REACH,
    Abort,
    Answer,
    Begin,
    CommandId,
    Commit,
    Ended,
    Find,
    Leave,
    Prepare,
    Request,
    SlotId,
    Unreadable,
    answer_in,
    written,
)
from .owners import Member, Owners, Recorded
from .threads import SORE_SECONDS, Net
from .transactions import Message, Notice, Transaction
from .watching import Watching

FINDS_BYTES = 16_384
"""Detections in one message."""

FAREWELL_SECONDS = 2.0
"""How long a robot that ends tries to tell those who are there."""

TIDINGS_SECONDS = 10.0
"""How long a newcomer is sent the robots that have ended before, until it answers."""

Work = Sequence[tuple[Transaction | Notice, Message]]
"""What is to be sent, each with what its answer is for."""


@dataclass(frozen=True, slots=True)
class BusDelivery:
    """A notify in progress, as its sender sees it; see `mmrs_runtime.slots.Delivery`."""

    _transaction: Transaction
    _outgoing: Outgoing

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until all who are asked answered."""
        with self._outgoing.lock:
            return self._transaction.lamport if self._transaction.is_granted else None

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        with self._outgoing.lock:
            return self._transaction.waiting

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to be done for it."""
        with self._outgoing.lock:
            return self._transaction.is_over

    @property
    def refusals(self) -> Mapping[str, str]:
        """Return why owners will never do it; empty where all is well."""
        with self._outgoing.lock:
            return dict(self._transaction.refusals)

    def send(self, lamport: int) -> None:
        """Let every owner apply it, after it was recorded with that logical time.

        Raises:
            ValueError: that time was not granted.
        """
        self._outgoing.send(self._transaction, lamport)

    def abort(self) -> None:
        """Abort it; what was sent continues until all have acknowledged."""
        self._outgoing.abort(self._transaction)


class Outgoing:
    """Holds notifies and notices until they are over, and sends what is due of them.

    Not thread-safe, apart from what takes the lock or is called without it: its holder guards it.

    Attributes:
        lock: guards it, and what it uses.
    """

    def __init__(
        self,
        lock: threading.Condition,
        now: Callable[[], float],
        run: str,
        members: Mapping[str, Member],
        owners: Owners,
        watching: Watching,
        carrier: Carrier,
        net: Net,
        chance: random.Random,
        pump: Callable[[], None],
        settled: Callable[[], None],
        *,
        alone: bool,
    ) -> None:
        """Create with nothing to send.

        Args:
            lock: guards owners and watching, too.
            now: seconds of a monotonic clock.
            run: identifier of the run, as robots of other processes know it.
            members: the robots of this process, by name.
            owners: of their slots.
            watching: robots present, and robots that have ended.
            carrier: to the robots of other processes.
            net: catches what fails, and reports refusals to the operator.
            chance: for pauses between tries.
            pump: sends what is due; called without the lock.
            settled: called without the lock when an answer was taken.
            alone: whether there are no robots of other processes.
        """
        self.lock, self._now, self._run, self._members = lock, now, run, members
        self._owners, self._watching, self._carrier, self._net = owners, watching, carrier, net
        self._chance, self._pump, self._settled, self._alone = chance, pump, settled, alone
        self._latched = frozenset[SlotId]().union(*(member.latched for member in members.values()))
        self._transactions: list[Transaction | Notice] = []
        self._farewells: dict[str, Notice] = {}

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...]
    ) -> BusDelivery:
        """Ask the owners of slots for setting them; returns at once.

        Where there are robots of other processes, run and incarnation are those of this process. Of the
        finds, the last go with it, as many as a message can hold.
        """
        parts: dict[str, tuple[str, ...]] = {}
        for owner, slot in slots:
            parts[owner] = (*parts.get(owner, ()), slot)
        latched = active and self._latched.issuperset(slots)
        least = partial(self._least, slots if latched else ())
        reach = LARGEST if self._alone else REACH
        with self.lock:
            if not self._alone:
                id = replace(id, run=self._run, incarnation=self._owners.incarnation)
                self._take_part(id.sender)
            transaction = Transaction(
                id, parts, active, least, self._chance, reach, fitting(finds), latched=latched
            )
            for owner in parts:
                if self._watching.has_ended(owner) and owner not in self._owners:
                    transaction.gone(owner)
            self._transactions.append(transaction)
        if not latched:
            self._pump()
        return BusDelivery(transaction, self)

    def send(self, transaction: Transaction, lamport: int) -> None:
        """Send a notify to its owners until all have acknowledged.

        Raises:
            ValueError: that logical time was not granted.
        """
        with self.lock:
            transaction.send(lamport, self._now())
            self._owners.use(lamport)
        self._pump()

    def abort(self, transaction: Transaction) -> None:
        """Abort a notify; its owners are informed until they have answered."""
        with self.lock:
            if (notice := transaction.abort()) is not None:
                self._transactions.append(notice)
        self._pump()

    def introduce(self, robot: str, recorded: Recorded) -> Notice:
        """Announce the start of a robot, with its log's notifies, to itself and all its contacts."""
        id, requests = self.id_of(robot), dict[str, Request]()
        for owner in sorted(self._members[robot].contacts | {robot}):
            known = [(slot, *value) for (r, slot), value in recorded.notifies.items() if r == owner]
            requests[owner] = Begin(id, tuple(known))
        return self._add(robot, requests)

    def bid_farewell(self, robot: str) -> None:
        """Announce for a while that a robot has ended."""
        contacts = self._members[robot].contacts - self._watching.left.keys()
        there = {each for each in contacts if each in self._owners or self._watching.is_here(each)}
        if there != contacts:
            # Who comes later must be told by others, since this robot will be gone by then.
            there |= self._watching.here
        farewell = Leave(self.id_of(robot), self._owners.lamport)
        self._farewells[robot] = self._add(robot, dict.fromkeys(there, farewell), FAREWELL_SECONDS)

    def inform(self, robot: str) -> None:
        """Inform a newly present robot for a while of those that have ended before."""
        ended = {each: at for each, at in self._watching.ended().items() if each != robot}
        if ended:
            teller = next(iter(self._members))
            tidings = Ended(self.id_of(teller), tuple(sorted(ended.items())))
            self._add(teller, {robot: tidings}, TIDINGS_SECONDS)

    def id_of(self, robot: str) -> CommandId:
        """Return the identifier of a robot's messages that are not notifies."""
        return CommandId(self._run, robot, self._owners.incarnation, 0)

    @property
    def has_farewells(self) -> bool:
        """Return whether a robot that has ended is still telling others so."""
        return bool(self._farewells)

    @property
    def due(self) -> float:
        """Return when there is something to send; inf: never."""
        return min((transaction.due for transaction in self._transactions), default=float("inf"))

    def gone(self, robot: str) -> None:
        """Take note that a robot has ended: it need not answer any more."""
        for transaction in self._transactions:
            transaction.gone(robot)

    def back(self, robot: str, now: float) -> None:
        """Take note that a robot can be reached: it is asked at once."""
        for transaction in self._transactions:
            transaction.back(robot, now)

    def begin(self, now: float) -> Work:
        """Return what is due now, having sent what is for this process."""
        due = [transaction for transaction in self._transactions if transaction.due <= now]
        work = [(transaction, message) for transaction in due for message in self._due_of(transaction, now)]
        for transaction, message in work:
            if message.owner in self._owners:
                answer = self._owners.answer(message.owner, message.request, here=True)
                if answer is not None:
                    transaction.answered(message.owner, _round(message.request), answer, now)
        return work

    def finish(self, work: Work) -> None:
        """Send the rest; to be called without the lock: carriers may take other locks, or wait."""
        for transaction, message in work:
            if message.owner not in self._owners:
                taken = partial(self._take, transaction, message)
                self.ask(message.sender, message.owner, message.request, taken)
            elif isinstance(message.request, Commit | Begin):
                self.publish(message.owner)

    def publish(self, robot: str) -> None:
        """Publish to observers that the state of a robot's slots has changed."""
        with self._net.under(f"showing the slots of {robot!r}"):
            self._carrier.publish(robot)

    def ask(self, sender: str, owner: str, request: Request, taken: Callable[[Answer], None]) -> None:
        """Ask a robot of another process; `taken` is called with the answer, from any thread, or never."""

        def take(text: str) -> None:
            try:
                answer = answer_in(text)
            except Unreadable:
                return  # as good as none: whoever needs one asks again
            taken(answer)

        with self._net.under(f"asking {owner!r}"):
            self._carrier.ask(sender, owner, written(request), take)

    def sweep(self) -> list[str]:
        """Forget what is over; return the robots whose farewells are all acknowledged."""
        self._transactions = [transaction for transaction in self._transactions if not transaction.is_over]
        gone = [robot for robot, notice in self._farewells.items() if notice.is_over]
        for robot in gone:
            del self._farewells[robot]
        return gone

    def _take(self, transaction: Transaction | Notice, message: Message, answer: Answer) -> None:
        with self.lock:
            if not self._owners.admission.believes(message.owner, answer):
                return  # as good as none
            transaction.answered(message.owner, _round(message.request), answer, self._now())
            if answer.what == "refused" and isinstance(message.request, Begin):
                self._net.tell(f"{message.owner!r} refuses {message.sender!r}: {answer.why}")
        self._settled()

    def _take_part(self, robot: str) -> None:
        try:
            self._owners.take_part(robot)
        except OSError:
            return  # whoever watches the journal has told; a robot that cannot keep this says so

    def _add(self, sender: str, requests: Mapping[str, Request], seconds: float = float("inf")) -> Notice:
        messages = {to: Message(sender, to, requests[to]) for to in sorted(requests)}
        self._transactions.append(notice := Notice(messages, until=self._now() + seconds))
        return notice

    def _due_of(self, transaction: Transaction | Notice, now: float) -> Iterable[Message]:
        """Return what a transaction has to send now; one that fails is left alone for a while."""
        with self._net.under("a notify in progress"):
            return transaction.tick(now)
        transaction.due = now + SORE_SECONDS
        return ()

    def _least(self, slots: Iterable[SlotId]) -> int:
        return self._owners.latest(slots) + 1 if self._alone else self._owners.lamport + 1


def fitting(finds: Sequence[Find]) -> tuple[Find, ...]:
    """Return the last of what was detected, as much as a message can hold beside names of slots.

    Names that no reader would take, and places that are nowhere, are left out.
    """
    found: list[Find] = []
    size = 0
    for name, place in reversed(finds):
        where = place if place is not None and all(map(isfinite, place)) else None
        size += len(json.dumps([name, where]))
        if len(found) == MOST_FINDS or size > FINDS_BYTES:
            break
        if len(name) <= LONGEST_NAME:
            found.append((name, where))
    return tuple(reversed(found))


def _round(request: Request) -> int:
    return request.round if isinstance(request, Prepare | Abort) else 0
