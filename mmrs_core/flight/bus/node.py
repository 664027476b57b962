"""One process's end of the bus: owners of its robots' slots, notifies on their way, and who is there."""

from __future__ import annotations

import json
import random
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from .carrier import Carrier, NoCarrier
from .delivery import Errand, Message, Notice, Phase
from .journal import Journal, NoJournal
from .meeting import Meeting
from .owner import Owned, Owner
from .watching import Watching
from .words import (
    LARGEST,
    REACH,
    Answer,
    Begin,
    CommandId,
    Commit,
    Leave,
    Meet,
    Prepare,
    Request,
    SlotId,
    SlotState,
    Unreadable,
    Withdraw,
    answer_in,
    request_in,
    written,
)

LEASE_SECONDS = 1.5
"""How long a robot may be out of reach before slots are no longer kept for it."""

FAREWELL_SECONDS = 2.0
"""How long a robot that ends tries to tell those who are there."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """What the log of a robot says that is started again.

    Attributes:
        lamport: logical time of its last step.
        notifies: by slot, the value and logical time of its last notify of it.
    """

    lamport: int = 0
    notifies: Mapping[SlotId, tuple[bool, int]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Member:
    """A robot of this process.

    Attributes:
        owned: its slots.
        targets: the robots whose slots it sets or resets.
    """

    owned: Owned
    targets: frozenset[str] = frozenset()

    @property
    def contacts(self) -> frozenset[str]:
        """Return the robots that it has to do with."""
        senders = (*self.owned.setters.values(), *self.owned.resetters.values())
        return (self.targets | {robot for each in senders for robot in each}) - {self.owned.robot}


class Node:
    """Keeps the slots of this process's robots and commands the owners of all others.

    Attributes:
        incarnation: of the robots of this process; differs, and grows, each time that they are started.
    """

    def __init__(
        self,
        members: Sequence[Member],
        run: str,
        *,
        carrier: Carrier | None = None,
        journals: Callable[[str], Journal] = lambda robot: NoJournal(),
        recorded: Mapping[str, Recorded] | None = None,
        lease: float = LEASE_SECONDS,
        now: Callable[[], float] = time.monotonic,
        threaded: bool = True,
    ) -> None:
        """Join the bus.

        Args:
            members: the robots of this process.
            run: identifier of the run; nothing of other runs is heard.
            carrier: to robots of other processes; None: there are none.
            journals: what survives this process, by robot.
            recorded: by robot, what the logs say of those that are started again.
            lease: seconds for which a robot may be out of reach.
            now: seconds of a clock that never goes back.
            threaded: whether to repeat by itself what is not answered; else `pump` must be called.

        Raises:
            OSError: a journal cannot be read or written, or the carrier cannot begin.
            ValueError: a journal is damaged, or holds another run or an earlier start of a robot that
                is not started again.
        """
        self._run, self._carrier, self._now, self._threaded = run, carrier or NoCarrier(), now, threaded
        self._alone = carrier is None
        self._changed = threading.Condition(threading.RLock())
        self._watching = Watching(lease)
        self._members = {member.owned.robot: member for member in members}
        given = recorded or {}
        self._owners = {
            id: Owner(
                member.owned,
                run,
                journals(id),
                floor=given.get(id, Recorded()).lamport,
                lost=self._watching.lost_for_long,
                trusting=self._alone,
            )
            for id, member in self._members.items()
        }
        self._watching.left.update(*(owner.left for owner in self._owners.values()))
        self._lamport = max((each.lamport for each in given.values()), default=0)
        self._errands: list[Errand | Notice] = []
        self._farewells: dict[str, Notice] = {}
        self._callbacks: list[Callable[[], None]] = []
        self._chance = random.Random()
        self._thread: threading.Thread | None = None
        self._closed = False
        self.meeting = Meeting(now)
        self.incarnation = self._started(given)
        self._carrier.open(self)
        for robot in self._members:
            if robot in given:
                self._tell_recorded(robot, given[robot])
            self._carrier.appear(robot)
        self.pump()

    @property
    def robots(self) -> tuple[str, ...]:
        """Return the robots of this process."""
        return tuple(self._members)

    def slots_of(self, robot: str) -> tuple[str, ...]:
        """Return the names of the slots of a robot of this process."""
        return self._members[robot].owned.slots

    def prepare(self, id: CommandId, slots: tuple[SlotId, ...], active: bool) -> Delivery:
        """Ask the owners of slots for setting them; returns at once.

        Where there are robots of other processes, the incarnation is this node's, which grows.
        """
        parts: dict[str, tuple[str, ...]] = {}
        for owner, slot in slots:
            parts[owner] = (*parts.get(owner, ()), slot)
        if not self._alone:
            id = replace(id, incarnation=self.incarnation)
        reach = LARGEST if self._alone else REACH
        errand = Errand(id, parts, active, self._least, self._chance, reach)
        with self._changed:
            for owner in parts:
                if owner in self._watching.left and owner not in self._owners:
                    errand.gone(owner)
            self._errands.append(errand)
        self.pump()
        return Delivery(self, errand)

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot of this process's robots.

        Raises:
            KeyError: it is none of theirs.
        """
        with self._changed:
            return self._owners[slot[0]].state(slot[1], self._now())

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for own slots is passed at that time, and if so keep the time.

        Raises:
            KeyError: a slot is none of this process's robots'.
        """
        parts: dict[str, list[str]] = {}
        for owner, slot in slots:
            parts.setdefault(owner, []).append(slot)
        with self._changed:
            now = self._now()
            if not all(self._owners[id].may_pass(names, lamport, now) for id, names in parts.items()):
                return False
            for id, names in parts.items():
                self._owners[id].passed(names, lamport)
            self._lamport = max(self._lamport, lamport)
            return True

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have ended, or that were there and can no longer be reached."""
        with self._changed:
            return tuple(robot for robot in robots if self._watching.is_gone(robot))

    def missing(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that cannot be reached now, or have never been."""
        with self._changed:
            strangers = (robot for robot in robots if robot not in self._members)
            return tuple(robot for robot in strangers if not self._watching.is_here(robot))

    def leave(self, robot: str) -> None:
        """Tell everybody that a robot has ended, whether well or by a fault; it never comes back."""
        with self._changed:
            if robot in self._watching.left or robot not in self._members:
                return
            self._watching.left.add(robot)
            self._farewells[robot] = self._farewell(robot)
            self._errands.append(self._farewells[robot])
        self.pump()
        self._tell_changed()

    def on_change(self, callback: Callable[[], None]) -> None:
        """Have a function called, from any thread, when something may have changed; it must not block."""
        with self._changed:
            self._callbacks.append(callback)

    def withdraw(self, errand: Errand) -> None:
        """Give a notify up; its owners are told until they have answered."""
        with self._changed:
            if (notice := errand.withdraw()) is not None:
                self._errands.append(notice)
        self.pump()

    def await_change(self, seconds: float) -> None:
        """Wait until something may have changed, but no longer than so many real seconds."""
        with self._changed:
            self._changed.wait(seconds)

    def pump(self) -> None:
        """Send what is due; called by itself where the bus is threaded."""
        with self._changed:
            now = self._now()
            work = [(errand, message) for errand in self._errands for message in errand.tick(now)]
            for errand, message in work:
                if message.owner in self._owners:
                    answer = self._answer(message.owner, message.request, here=True)
                    errand.answered(message.owner, _round(message.request), answer, now)
            gone = self._sweep()
            ended = any([owner.end_lost(now) for owner in self._owners.values()])
            self._keep_going()
        for errand, message in work:
            if message.owner not in self._owners:
                self._carrier.ask(*_addressed(message), self._taker(errand, message))
            elif isinstance(message.request, Commit | Begin):
                self._carrier.publish(message.owner)
        self._vanish(gone)
        if work or ended:
            self._tell_changed()

    def close(self) -> None:
        """Leave the bus, once; robots that have not ended are lost to the others."""
        with self._changed:
            if self._closed:
                return
            until = self._now() + FAREWELL_SECONDS
            while self._farewells and self._threaded and self._now() < until:
                self._changed.wait(0.05)
            self._closed = True
            self._changed.notify_all()
        for robot in self._members:
            self._carrier.vanish(robot)
        self._carrier.close()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def ask_once(self, sender: str, owner: str, request: Request, taken: Callable[[Answer], None]) -> None:
        """Send a request once; `taken` is called with the answer, from any thread, or never."""
        if owner in self._owners:
            taken(self._answer(owner, request))
            return
        self._carrier.ask(sender, owner, written(request), lambda text: taken(answer_in(text)))

    def serve(self, owner: str, sender: str, request: str) -> str:
        """Return the answer of one of this process's robots to a request, whatever it is."""
        try:
            found = request_in(request)
        except Unreadable as error:
            return written(Answer("refused", why=f"not a request: {error}"))
        if found.id.sender != sender:
            return written(Answer("refused", why=f"{sender!a} cannot speak for {found.id.sender!a}"))
        if owner not in self._owners or sender in self._owners:
            return written(Answer("refused", why=f"{owner!a} is not to be asked here"))
        answer = self._answer(owner, found)
        with self._changed:
            self._keep_going()
        if not isinstance(found, Meet):
            self._tell_changed()
        if isinstance(found, Commit | Begin):
            self._carrier.publish(owner)
        return written(answer)

    def noticed(self, robot: str, here: bool) -> None:
        """Take note that a robot of another process can be reached, or no longer."""
        with self._changed:
            now = self._now()
            self._watching.noticed(robot, here, now)
            if here:
                for errand in self._errands:
                    errand.back(robot, now)
        self._tell_changed()

    def shown(self, robot: str) -> str:
        """Return the state of a robot's slots as a JSON object."""
        with self._changed:
            return json.dumps(self._owners[robot].shown(self._now()))

    def _started(self, given: Mapping[str, Recorded]) -> str:
        for robot, owner in self._owners.items():
            if owner.start and robot not in given:
                raise ValueError(f"{robot!a}: its slots were kept by an earlier start; resume it")
        number = 1 + max((owner.start for owner in self._owners.values()), default=0)
        if not self._alone:
            for owner in self._owners.values():
                owner.started(number)
        return f"{number:08d}"

    def _tell_recorded(self, robot: str, recorded: Recorded) -> None:
        id = CommandId(self._run, robot, self.incarnation, 0)
        requests: dict[str, Message] = {}
        for owner in sorted(self._members[robot].contacts | {robot}):
            known = [(s, *value) for (r, s), value in recorded.notifies.items() if r == owner]
            requests[owner] = Message(robot, owner, Begin(id, tuple(known)))
        with self._changed:
            self._errands.append(Notice(requests))

    def _farewell(self, robot: str) -> Notice:
        id = CommandId(self._run, robot, self.incarnation, 0)
        contacts = self._members[robot].contacts - self._watching.left
        there = {each for each in contacts if each in self._owners or self._watching.is_here(each)}
        requests = {each: Message(robot, each, Leave(id)) for each in sorted(there)}
        return Notice(requests, until=self._now() + FAREWELL_SECONDS)

    def _answer(self, robot: str, request: Request, *, here: bool = False) -> Answer:
        with self._changed:
            owner, now = self._owners[robot], self._now()
            if isinstance(request, Prepare):
                return owner.prepare(request, now, here=here)
            if isinstance(request, Commit):
                self._lamport = max(self._lamport, request.lamport)
                return owner.commit(request)
            if isinstance(request, Withdraw):
                return owner.withdraw(request)
            if isinstance(request, Begin):
                self._watching.left.discard(request.id.sender)
                return owner.begin(request)
            if isinstance(request, Leave):
                return self._see_off(owner, request.id.sender)
            return self.meeting.answer(request)

    def _see_off(self, owner: Owner, robot: str) -> Answer:
        self._watching.left.add(robot)
        for errand in self._errands:
            if robot not in self._owners:
                errand.gone(robot)
        return owner.leave(robot)

    def _taker(self, errand: Errand | Notice, message: Message) -> Callable[[str], None]:
        def take(text: str) -> None:
            try:
                answer = answer_in(text)
            except Unreadable:
                return  # as good as none: it is asked again
            with self._changed:
                errand.answered(message.owner, _round(message.request), answer, self._now())
                gone = self._sweep()
            self._vanish(gone)
            self._tell_changed()

        return take

    def _sweep(self) -> list[str]:
        """Forget what is over; return the robots that have said farewell to everybody."""
        self._errands = [errand for errand in self._errands if not errand.is_over]
        gone = [robot for robot, notice in self._farewells.items() if notice.is_over]
        for robot in gone:
            del self._farewells[robot]
        return gone

    def _vanish(self, robots: Iterable[str]) -> None:
        for robot in robots:
            self._carrier.vanish(robot)

    def _least(self) -> int:
        return 0 if self._alone else self._lamport + 1

    def _tell_changed(self) -> None:
        with self._changed:
            self._changed.notify_all()
            callbacks = tuple(self._callbacks)
        for callback in callbacks:
            callback()

    def _keep_going(self) -> None:
        """Have a thread do what is due later; there is none as long as nothing is."""
        if self._threaded and self._thread is None and not self._closed and self._next_due() < float("inf"):
            self._thread = threading.Thread(target=self._work, name="bus", daemon=True)
            self._thread.start()
        self._changed.notify_all()

    def _work(self) -> None:
        while True:
            with self._changed:
                if self._closed:
                    return
                left = self._next_due() - self._now()
                if left > 0:
                    self._changed.wait(min(left, 3600.0))
                    continue
            self.pump()

    def _next_due(self) -> float:
        ends = (owner.next_end(self._watching.long_lost_at) for owner in self._owners.values())
        return min(
            (*(errand.due for errand in self._errands), *(end for end in ends if end is not None)),
            default=float("inf"),
        )

    def repeat(self, id: CommandId, slots: Iterable[SlotId], active: bool, lamport: int) -> None:
        """Set own slots as a log says they were, whoever may set them."""
        with self._changed:
            self._lamport = max(self._lamport, lamport)
            for owner, slot in slots:
                self._owners[owner].repeat(Commit(id, (slot,), active, lamport))
        self._tell_changed()

    def restore(self, active: Iterable[SlotId], lamport: int) -> None:
        """Begin with these own slots active and at that logical time; others' slots are left alone."""
        with self._changed:
            self._lamport = max(self._lamport, lamport)
            for robot, owner in self._owners.items():
                owner.restore([slot for owned_by, slot in active if owned_by == robot], lamport)

    def use(self, lamport: int) -> None:
        """Take note of a logical time that a robot of this process has used."""
        with self._changed:
            self._lamport = max(self._lamport, lamport)

    def tick(self, least: int = 0) -> int:
        """Return a new logical time for a step of this process's robots, at least so much."""
        with self._changed:
            self._lamport = max(self._lamport + 1, least)
            return self._lamport


@dataclass(frozen=True, slots=True)
class Delivery:
    """A notify on its way; see `mmrs_core.contributions.execution.Delivery`."""

    node: Node
    errand: Errand

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until all have answered."""
        with self.node._changed:
            granted = self.errand.phase in (Phase.GRANTED, Phase.SENDING, Phase.DONE)
            return self.errand.lamport if granted else None

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        with self.node._changed:
            return self.errand.waiting

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to be done for it."""
        with self.node._changed:
            return self.errand.is_over

    @property
    def refusals(self) -> Mapping[str, str]:
        """Return why owners will never do it; empty where all is well."""
        with self.node._changed:
            return dict(self.errand.refusals)

    def send(self, lamport: int) -> None:
        """Have every owner apply it, after it was recorded with that logical time.

        Raises:
            ValueError: that time was not granted.
        """
        with self.node._changed:
            self.node.use(lamport)
            self.errand.send(lamport, self.node._now())
        self.node.pump()

    def withdraw(self) -> None:
        """Give it up; what was sent goes on until all have acknowledged."""
        self.node.withdraw(self.errand)


def _round(request: Request) -> int:
    return request.round if isinstance(request, Prepare | Withdraw) else 0


def _addressed(message: Message) -> tuple[str, str, str]:
    return message.sender, message.owner, written(message.request)
