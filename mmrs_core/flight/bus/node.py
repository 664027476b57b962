"""One process's end of the bus: its robots' slots, notifies on their way, and who is there."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

from .carrier import Carrier, NoCarrier
from .delivery import Delivery
from .errands import Errand, Message, Notice
from .journal import Journal, NoJournal
from .meeting import Meeting
from .members import Member, Recorded
from .owners import Owners
from .reading import Unreadable, answer_in, request_in, written
from .troubles import Keeping, Net, Tell, tell_people
from .watching import DOUBLE_SECONDS, Watching
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
    Withdraw,
)

LEASE_SECONDS = 1.5
"""How long a robot may be out of reach before slots are no longer kept for it."""

FAREWELL_SECONDS = 2.0
"""How long a robot that ends tries to tell those who are there."""

LONGEST_SLEEP = 3600.0

SORE_SECONDS = 0.5
"""How long something that fails is left alone."""


class Doubled(OSError):  # noqa: N818  # what is the matter with a robot
    """A robot that another process runs, too."""


class Node:
    """Keeps the slots of this process's robots and commands the owners of all others.

    Attributes:
        lock: guards everything here; signalled when something may have changed.
        now: seconds of a clock that never goes back.
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
        chance: random.Random | None = None,
        tell: Tell = tell_people,
        settle: float = 0.0,
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
            chance: for pauses between tries.
            tell: tells people what goes wrong here, from any thread.
            settle: seconds to look whether other processes run the same robots; 0: nobody looks.

        Raises:
            Doubled: another process runs one of the robots.
            OSError: a journal cannot be read or written, or the carrier cannot begin.
            ValueError: a journal is damaged, or holds another run or an earlier start of a robot that
                is not started again.
        """
        self.lock = threading.Condition(threading.RLock())
        self.now = now
        self._run, self._carrier, self._threaded = run, carrier or NoCarrier(), threaded
        self._alone = carrier is None
        self._watching = Watching(lease)
        self._members = {member.owned.robot: member for member in members}
        given = recorded or {}
        self._net = Net(tell)
        self._keeping = keeping = Keeping(self._net, now)
        self._owners = Owners(
            members,
            run,
            lambda robot: keeping.watched(robot, journals(robot)),
            given,
            self._watching,
            trusting=self._alone,
        )
        self._meeting = Meeting(now)
        self._errands: list[Errand | Notice] = []
        self._farewells: dict[str, Notice] = {}
        self._callbacks: list[Callable[[], None]] = []
        self._chance = chance or random.Random()
        self._thread: threading.Thread | None = None
        self._closed = False
        self._begin(settle)
        for robot in self._members:
            if robot in given:
                self._tell_recorded(robot, given[robot])
            self._carrier.appear(robot)
        self.pump()

    def _begin(self, settle: float) -> None:
        """Open the carrier, and begin if nobody else runs these robots."""
        self._carrier.open(self)
        try:
            self._refuse_doubles(settle)
            self._owners.begin()
        except BaseException:
            self._closed = True
            self._carrier.close()
            raise

    def _refuse_doubles(self, settle: float) -> None:
        begun = self.now()
        while (left := begun + settle - self.now()) > 0:
            time.sleep(min(left, 0.05))
        while settle and (there := self._watching.doubles()):
            if self.now() - begun > settle + DOUBLE_SECONDS:
                raise Doubled(f"{', '.join(map(ascii, there))}: another process runs it on this bus already")
            time.sleep(0.05)

    @property
    def robots(self) -> tuple[str, ...]:
        """Return the robots of this process."""
        return tuple(self._members)

    @property
    def incarnation(self) -> str:
        """Return what differs, and grows, each time that the robots of this process are started."""
        return self._owners.incarnation

    def slots_of(self, robot: str) -> tuple[str, ...]:
        """Return the names of the slots of a robot of this process."""
        return self._members[robot].owned.slots

    def targets_of(self, robot: str) -> frozenset[str]:
        """Return the robots whose slots a robot of this process sets or resets."""
        return self._members[robot].targets

    def prepare(self, id: CommandId, slots: tuple[SlotId, ...], active: bool) -> Delivery:
        """Ask the owners of slots for setting them; returns at once.

        Where there are robots of other processes, the incarnation is this node's, which grows.
        """
        parts: dict[str, tuple[str, ...]] = {}
        for owner, slot in slots:
            parts[owner] = (*parts.get(owner, ()), slot)
        if not self._alone:
            id = replace(id, incarnation=self.incarnation)
            self._take_part(id.sender)
        errand = Errand(id, parts, active, self._least, self._chance, LARGEST if self._alone else REACH)
        with self.lock:
            for owner in parts:
                if owner in self._watching.left and owner not in self._owners:
                    errand.gone(owner)
            self._errands.append(errand)
        self.pump()
        return Delivery(self, errand)

    def _take_part(self, robot: str) -> None:
        with self.lock:
            try:
                self._owners.take_part(robot)
            except OSError:
                return  # whoever watches the journal has told; a robot that cannot keep this says so

    def withdraw(self, errand: Errand) -> None:
        """Give a notify up; its owners are told until they have answered."""
        with self.lock:
            if (notice := errand.withdraw()) is not None:
                self._errands.append(notice)
        self.pump()

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot of this process's robots.

        Raises:
            KeyError: it is none of theirs.
        """
        with self.lock:
            return self._owners.state(slot, self.now())

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for own slots is passed at that time, and if so keep the time.

        Raises:
            KeyError: a slot is none of this process's robots'.
        """
        with self.lock:
            return self._owners.passed(slots, lamport, self.now())

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have ended, or that were there and can no longer be reached."""
        with self.lock:
            return tuple(robot for robot in robots if self._watching.is_gone(robot))

    def missing(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that cannot be reached now, or have never been."""
        with self.lock:
            strangers = (robot for robot in robots if robot not in self._members)
            return tuple(robot for robot in strangers if not self._watching.is_here(robot))

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        with self.lock:
            strangers = (robot for robot in robots if robot not in self._members)
            return tuple(robot for robot in strangers if self._watching.is_unseen(robot))

    def trouble(self, robot: str) -> str:
        """Return why a robot of this process cannot keep what is told to it; empty: it can."""
        with self.lock:
            return self._keeping.why(robot)

    def leave(self, robot: str) -> None:
        """Tell everybody that a robot has ended, whether well or by a fault; it never comes back."""
        with self.lock:
            if robot in self._watching.left or robot not in self._members:
                return
            self._watching.left.add(robot)
            self._farewells[robot] = self._farewell(robot)
            self._errands.append(self._farewells[robot])
        self.pump()
        self._tell_changed()

    @property
    def lamport(self) -> int:
        """Return the latest logical time that this process knows of."""
        with self.lock:
            return self._owners.lamport

    def use(self, lamport: int) -> None:
        """Take note of a logical time that a robot of this process has used."""
        with self.lock:
            self._owners.use(lamport)

    def tick(self, least: int = 0) -> int:
        """Return a new logical time for a step of this process's robots, at least so much."""
        with self.lock:
            self._owners.use(max(self._owners.lamport + 1, least))
            return self._owners.lamport

    def repeat(self, id: CommandId, slots: Iterable[SlotId], active: bool, lamport: int) -> None:
        """Set own slots as a log says they were, whoever may set them."""
        with self.lock:
            self._owners.repeat(id, slots, active, lamport)
        self._tell_changed()

    def restore(self, active: Iterable[SlotId], lamport: int) -> None:
        """Begin with these own slots active and at that logical time; others' slots are left alone."""
        with self.lock:
            self._owners.restore(active, lamport)

    def on_change(self, callback: Callable[[], None]) -> None:
        """Have a function called, from any thread, when something may have changed; it must not block."""
        with self.lock:
            self._callbacks.append(callback)

    def await_change(self, seconds: float) -> None:
        """Wait until something may have changed, but no longer than so many real seconds."""
        with self.lock:
            self.lock.wait(seconds)

    def close(self) -> None:
        """Leave the bus, once; robots that have not ended are lost to the others."""
        with self.lock:
            if self._closed:
                return
            until = self.now() + FAREWELL_SECONDS
            while self._farewells and self._threaded and self.now() < until:
                self.lock.wait(0.05)
            self._closed = True
            self.lock.notify_all()
        self._vanish(self._members)
        self._carrier.close()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def ask_once(self, sender: str, owner: str, request: Meet, taken: Callable[[Answer], None]) -> None:
        """Ask a robot once; `taken` is called with the answer, from any thread, or never."""
        if owner in self._owners:
            if (answer := self._answer(owner, request)) is not None:
                taken(answer)
            return

        def take(text: str) -> None:
            try:
                answer = answer_in(text)
            except Unreadable:
                return  # as good as none
            taken(answer)

        with self._net.under(f"asking {owner!a}"):
            self._carrier.ask(sender, owner, written(request), take)

    def serve(self, owner: str, sender: str, request: str) -> str:
        """Return the answer of one of this process's robots to a request, whatever it is; empty: none now."""
        try:
            found = request_in(request)
        except Unreadable as error:
            return written(Answer("refused", why=f"not a request: {error}"))
        if found.id.sender != sender:
            return written(Answer("refused", why=f"{sender!a} cannot speak for {found.id.sender!a}"))
        if owner not in self._owners or sender in self._owners:
            return written(Answer("refused", why=f"{owner!a} is not to be asked here"))
        answer = self._answer(owner, found)
        with self.lock:
            self._keep_going()
        if not isinstance(found, Meet):
            self._tell_changed()
        if isinstance(found, Commit | Begin):
            self._publish(owner)
        return "" if answer is None else written(answer)

    def noticed(self, robot: str, here: bool) -> None:
        """Take note that a robot of another process can be reached, or no longer."""
        with self.lock:
            now = self.now()
            if robot in self._members:
                self._watching.doubled(robot, here, now)
                self._keep_going()
                return
            self._watching.noticed(robot, here, now)
            if here:
                for errand in self._errands:
                    errand.back(robot, now)
            self._keep_going()
        self._tell_changed()

    def shown(self, robot: str) -> str:
        """Return the state of a robot's slots as a JSON object."""
        with self.lock:
            return self._owners.shown(robot, self.now())

    def pump(self) -> None:
        """Send what is due; called by itself where the bus is threaded."""
        with self.lock:
            now = self.now()
            work = [(errand, message) for errand in self._errands for message in self._due_of(errand, now)]
            for errand, message in work:
                if message.owner in self._owners:
                    answer = self._answer(message.owner, message.request, here=True)
                    if answer is not None:
                        errand.answered(message.owner, _round(message.request), answer, now)
            gone = self._sweep()
            ended = self._owners.end_lost(now)
            silent, back = self._keeping.look()
            self._tell_doubles(now)
            self._keep_going()
        # Carriers may take other locks, or wait: never with ours.
        for errand, message in work:
            if message.owner not in self._owners:
                self._ask(errand, message)
            elif isinstance(message.request, Commit | Begin):
                self._publish(message.owner)
        self._vanish([*gone, *silent])
        self._appear(back)
        if work or ended or silent or back:
            self._tell_changed()

    def _tell_doubles(self, now: float) -> None:
        for robot in self._watching.lasting_doubles(now):
            self._net.forget(words := f"{robot!a} is run by another process, too: end one of them")
            self._net.tell(words)

    def _due_of(self, errand: Errand | Notice, now: float) -> Iterable[Message]:
        """Return what an errand has to send now; one that fails is left alone for a while."""
        with self._net.under("a notify on its way"):
            return errand.tick(now)
        errand.due = now + SORE_SECONDS
        return ()

    def _ask(self, errand: Errand | Notice, message: Message) -> None:
        with self._net.under(f"asking {message.owner!a}"):
            self._carrier.ask(*_addressed(message), self._taker(errand, message))

    def _publish(self, robot: str) -> None:
        with self._net.under(f"showing the slots of {robot!a}"):
            self._carrier.publish(robot)

    def _appear(self, robots: Iterable[str]) -> None:
        for robot in robots:
            with self.lock:
                ended = self._closed or robot in self._watching.left
            if not ended:
                with self._net.under(f"coming back as {robot!a}"):
                    self._carrier.appear(robot)

    def _tell_recorded(self, robot: str, recorded: Recorded) -> None:
        id = CommandId(self._run, robot, self.incarnation, 0)
        requests: dict[str, Message] = {}
        for owner in sorted(self._members[robot].contacts | {robot}):
            known = [(s, *value) for (r, s), value in recorded.notifies.items() if r == owner]
            requests[owner] = Message(robot, owner, Begin(id, tuple(known)))
        with self.lock:
            self._errands.append(Notice(requests))

    def _farewell(self, robot: str) -> Notice:
        id = CommandId(self._run, robot, self.incarnation, 0)
        contacts = self._members[robot].contacts - self._watching.left
        there = {each for each in contacts if each in self._owners or self._watching.is_here(each)}
        requests = {each: Message(robot, each, Leave(id, self._owners.lamport)) for each in sorted(there)}
        return Notice(requests, until=self.now() + FAREWELL_SECONDS)

    def _answer(self, robot: str, request: Request, *, here: bool = False) -> Answer | None:
        """Return what a robot answers; None: nothing as long as it cannot keep it, and it is asked again."""
        with self.lock:
            try:
                return self._answer_of(robot, request, here=here)
            except OSError:
                return None  # whoever watches the journal has told
            except Exception as error:
                self._net.tell(f"{robot!a} cannot answer {request}: {error!r}")
                return Answer("refused", why=f"{robot!a} cannot answer: {error!r}")

    def _answer_of(self, robot: str, request: Request, *, here: bool) -> Answer:
        if isinstance(request, Meet):
            return self._meeting.answer(request, self._watching.is_gone)
        if isinstance(request, Leave):
            return self._see_off(robot, request)
        if isinstance(request, Begin):
            self._watching.left.discard(request.id.sender)
        return self._owners.answer(robot, request, self.now(), here=here)

    def _see_off(self, robot: str, farewell: Leave) -> Answer:
        sender = farewell.id.sender
        # First the time: a notify that needs no answer any more must be later than all the robot did.
        self._owners.use(farewell.lamport)
        # It has ended, also where that cannot be kept: then it is told again as long as it is there.
        self._watching.left.add(sender)
        if sender not in self._owners:
            for errand in self._errands:
                errand.gone(sender)
        return self._owners.see_off(robot, sender, farewell.lamport)

    def _taker(self, errand: Errand | Notice, message: Message) -> Callable[[str], None]:
        def take(text: str) -> None:
            try:
                answer = answer_in(text)
            except Unreadable:
                return  # as good as none: it is asked again
            with self.lock:
                errand.answered(message.owner, _round(message.request), answer, self.now())
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
            with self._net.under(f"leaving as {robot!a}"):
                self._carrier.vanish(robot)

    def _least(self) -> int:
        return 0 if self._alone else self._owners.lamport + 1

    def _tell_changed(self) -> None:
        with self.lock:
            self.lock.notify_all()
            callbacks = tuple(self._callbacks)
        for callback in callbacks:
            with self._net.under("telling of a change"):
                callback()

    def _keep_going(self) -> None:
        """Have a thread do what is due later; there is none as long as nothing is."""
        due = self._next_due() < float("inf")
        if self._threaded and self._thread is None and not self._closed and due:
            self._thread = threading.Thread(target=self._work, name="bus", daemon=True)
            self._thread.start()
        self.lock.notify_all()

    def _work(self) -> None:
        while True:
            with self.lock:
                if self._closed:
                    return
                left = self._next_due() - self.now()
                if left > 0:
                    self.lock.wait(min(left, LONGEST_SLEEP))
                    continue
            with self._net.under("sending what is due"):
                self.pump()
                continue
            time.sleep(SORE_SECONDS)

    def _next_due(self) -> float:
        ends = (self._owners.next_end(), self._keeping.due, self._watching.next_double())
        return min((*ends, *(errand.due for errand in self._errands)))


def _round(request: Request) -> int:
    return request.round if isinstance(request, Prepare | Withdraw) else 0


def _addressed(message: Message) -> tuple[str, str, str]:
    return message.sender, message.owner, written(message.request)
