"""One process's end of the bus: its robots' slots, what they notify others of, and who is there."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

from .carriers.carrier import Carrier, NoCarrier
from .journal import Journal, Keeping, NoJournal
from .messages import Answer, Begin, CommandId, Commit, Find, Meet, SlotId, SlotState, written
from .outgoing import FAREWELL_SECONDS, BusDelivery, Outgoing
from .owners import Member, Owners, Recorded
from .threads import Net, Pacing, Tell, tell_people
from .watching import OTHERWISE, TWICE, Unwelcome, Watching, refuse_oddities


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
        plan: str = "",
        team: Collection[str] = (),
        carrier: Carrier | None = None,
        journals: Callable[[str], Journal] = lambda robot: NoJournal(),
        recorded: Mapping[str, Recorded] | None = None,
        now: Callable[[], float] = time.monotonic,
        threaded: bool = True,
        chance: random.Random | None = None,
        tell: Tell = tell_people,
        settle: float = 0.0,
    ) -> None:
        """Join the bus.

        Args:
            members: the robots of this process.
            run: identifier of the run; messages of other runs are ignored.
            plan: tells this plan of the mission from others; robots of others are refused.
            team: all robots of the mission: messages of others are ignored; none: the carrier knows them.
            carrier: to robots of other processes; None: there are none.
            journals: what survives this process, by robot.
            recorded: by robot, the logs of those that are started again.
            now: seconds of a monotonic clock.
            threaded: whether to repeat unanswered messages in a thread; otherwise `pump` must be called.
            chance: for pauses between tries.
            tell: reports problems to the operator, from any thread.
            settle: seconds to check whether these robots can take part; 0 skips the check.

        Raises:
            Unwelcome: another process runs one of the robots, or others are there by another plan of the
                mission, or know of an earlier start that this one does not.
            OSError: a journal cannot be read or written, or the carrier cannot begin.
            ValueError: a journal is damaged, or holds another run or an earlier start of a robot that
                is not started again.
        """
        self.lock = threading.Condition(threading.RLock())
        self.now = now
        self._run, self._alone = f"{run} of plan {plan}" if plan else run, carrier is None
        self._watching = Watching()
        self._members = {member.owned.robot: member for member in members}
        given = recorded or {}
        self._net = Net(tell)
        self._keeping = keeping = Keeping(self._net, now)
        self._owners = Owners(
            members,
            self._run,
            lambda robot: keeping.watched(robot, journals(robot)),
            given,
            self._watching,
            now=now,
            net=self._net,
            team=team,
            ended=lambda robot: self._outgoing.gone(robot),
            trusting=self._alone,
        )
        self._carrier = carrier or NoCarrier()
        self._outgoing = Outgoing(
            self.lock,
            now,
            self._run,
            self._members,
            self._owners,
            self._watching,
            self._carrier,
            self._net,
            chance or random.Random(),
            self.pump,
            self._settle,
            alone=self._alone,
        )
        self._pacing = Pacing(self.lock, now, self._next_due, self.pump, self._net, threaded=threaded)
        self._callbacks: list[Callable[[], None]] = []
        self._begin(given, settle)
        for robot in self._members:
            self._carrier.appear(robot)
        self.pump()

    def _begin(self, recorded: Mapping[str, Recorded], settle: float) -> None:
        """Open the carrier, and begin if these robots can take part."""
        self._carrier.open(self)
        try:
            refuse_oddities(self._watching, settle, self.now)
            self._owners.begin()
            self._introduce(recorded, settle)
        except BaseException:
            self._pacing.is_over = True
            self._carrier.close()
            raise

    def _introduce(self, recorded: Mapping[str, Recorded], settle: float) -> None:
        """Announce the start to all contacts of these robots, and wait for those that are present."""
        with self.lock:
            reported = [
                self._outgoing.introduce(robot, recorded.get(robot, Recorded()))
                for robot in self._members
                if robot in recorded or not self._alone
            ]
        self.pump()
        until = self.now() + settle
        with self.lock:
            while self.now() < until and any(self._watching.are_here(news.waiting) for news in reported):
                self.lock.wait(0.05)
            for news in reported:
                for owner, why in news.refusals.items():
                    raise Unwelcome(f"{owner!r}: {why}")

    @property
    def robots(self) -> tuple[str, ...]:
        """Return the robots of this process."""
        return tuple(self._members)

    @property
    def incarnation(self) -> str:
        """Return what differs, and grows, each time that the robots of this process are started."""
        return self._owners.incarnation

    def id_of(self, robot: str) -> CommandId:
        """Return the identifier of a local robot's messages that are not notifies."""
        return self._outgoing.id_of(robot)

    def slots_of(self, robot: str) -> tuple[str, ...]:
        """Return the names of the slots of a robot of this process."""
        return self._members[robot].owned.slots

    def targets_of(self, robot: str) -> frozenset[str]:
        """Return the robots whose slots a robot of this process sets or resets."""
        return self._members[robot].targets

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...] = ()
    ) -> BusDelivery:
        """Ask the owners of slots for setting them; returns at once.

        Owners are not asked where no robot ever resets the slots: it is granted then. Where there are robots
        of other processes, run and incarnation are those of this node. With the notify go its sender's known
        detections.
        """
        return self._outgoing.prepare(id, slots, active, finds)

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot of this process had detected."""
        with self.lock:
            return self._owners.finds(robot)

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot of this process's robots.

        Raises:
            KeyError: it is none of theirs.
        """
        with self.lock:
            return self._owners.state(slot)

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for own slots is passed at that time, and if so keep the time.

        Raises:
            KeyError: a slot is none of this process's robots'.
        """
        with self.lock:
            return self._owners.passed(slots, lamport)

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
        """Return why a robot of this process cannot keep what it receives; empty where it can."""
        with self.lock:
            return self._keeping.why(robot)

    def leave(self, robot: str) -> None:
        """Announce that a robot has ended, with success or by a fault; it never comes back."""
        with self.lock:
            if robot in self._watching.left or robot not in self._members:
                return
            self._watching.left[robot] = self._owners.lamport
            self._outgoing.bid_farewell(robot)
        self.pump()
        self._tell_changed()

    def hide(self, robot: str) -> None:
        """Make a robot of this process unreachable, as one that is frozen; its slots are kept."""
        self._vanish([robot])

    def show(self, robot: str) -> None:
        """Make a robot of this process reachable again, unless it has ended."""
        self._appear([robot])

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
        """Set own slots to their state in a log, whatever robots may set them."""
        with self.lock:
            self._owners.repeat(id, slots, active, lamport)
        self._tell_changed()

    def restore(self, active: Iterable[SlotId], lamport: int) -> None:
        """Begin with these own slots active and at that logical time; others' slots are left alone."""
        with self.lock:
            self._owners.restore(active, lamport)

    def on_change(self, callback: Callable[[], None]) -> None:
        """Call a function, from any thread, when something may have changed; it must not block."""
        with self.lock:
            self._callbacks.append(callback)

    def await_change(self, seconds: float) -> None:
        """Wait until something may have changed, but no longer than so many real seconds."""
        with self.lock:
            self.lock.wait(seconds)

    def close(self) -> None:
        """Leave the bus, once; robots that have not ended are lost to the others."""
        with self.lock:
            if self._pacing.is_over:
                return
            until = self.now() + FAREWELL_SECONDS
            while self._outgoing.has_farewells and self._pacing.is_threaded and self.now() < until:
                self.lock.wait(0.05)
            self._pacing.is_over = True
            self.lock.notify_all()
        self._vanish(self._members)
        self._carrier.close()
        self._pacing.join()

    def ask_once(self, sender: str, owner: str, request: Meet, taken: Callable[[Answer], None]) -> None:
        """Ask a robot once; `taken` is called with the answer, from any thread, or never."""
        if owner not in self._owners:
            self._outgoing.ask(sender, owner, request, taken)
            return
        with self.lock:
            answer = self._owners.answer(owner, request)
        if answer is not None:
            taken(answer)

    def serve(self, owner: str, sender: str, request: str) -> str:
        """Return the answer of one of this process's robots to a request, whatever it is; empty: none now."""
        found = self._owners.admitted(owner, sender, request)
        if isinstance(found, Answer):
            return written(found)
        with self.lock:
            answer = self._owners.answer(owner, found)
            self._pacing.keep_going()
        if not isinstance(found, Meet):
            self._tell_changed()
        if isinstance(found, Commit | Begin):
            self._outgoing.publish(owner)
        return "" if answer is None else written(answer)

    def noticed(self, robot: str, here: bool) -> None:
        """Take note that a robot of another process can be reached, or no longer."""
        with self.lock:
            now = self.now()
            if robot in self._members:
                self._watching.odd(robot, TWICE, here, now)
                self._pacing.keep_going()
                return
            if here and not self._watching.is_here(robot):
                self._outgoing.inform(robot)
            self._watching.noticed(robot, here, now)
            if here:
                self._outgoing.back(robot, now)
            self._pacing.keep_going()
        self._tell_changed()

    def stranger(self, robot: str, here: bool) -> None:
        """Take note that a robot is there by another plan of the mission, or no longer."""
        with self.lock:
            self._watching.odd(robot, OTHERWISE, here, self.now())
            self._pacing.keep_going()

    def shown(self, robot: str) -> str:
        """Return the state of a robot's slots as a JSON object."""
        with self.lock:
            return self._owners.shown(robot)

    def pump(self) -> None:
        """Send what is due; called by a thread where the bus is threaded."""
        with self.lock:
            now = self.now()
            work = self._outgoing.begin(now)
            gone = self._outgoing.sweep()
            ended = self._owners.end_lost(now)
            silent, back = self._keeping.look()
            self._tell_oddities(now)
            self._pacing.keep_going()
        self._outgoing.finish(work)
        self._vanish([*gone, *silent])
        self._appear(back)
        if work or ended or silent or back:
            self._tell_changed()

    def _settle(self) -> None:
        """Take note that an answer has come."""
        with self.lock:
            gone = self._outgoing.sweep()
        self._vanish(gone)
        self._tell_changed()

    def _tell_changed(self) -> None:
        """Notify all waiters and callbacks. Call without holding the lock."""
        with self.lock:
            self.lock.notify_all()
            callbacks = tuple(self._callbacks)
        for callback in callbacks:
            with self._net.under("telling of a change"):
                callback()

    def _tell_oddities(self, now: float) -> None:
        for what in self._watching.lasting_oddities(now):
            self._net.forget(words := f"{what}: end one of them")
            self._net.tell(words)

    def _appear(self, robots: Iterable[str]) -> None:
        for robot in robots:
            with self.lock:
                ended = self._pacing.is_over or robot in self._watching.left
            if not ended:
                with self._net.under(f"coming back as {robot!r}"):
                    self._carrier.appear(robot)

    def _vanish(self, robots: Iterable[str]) -> None:
        for robot in robots:
            with self._net.under(f"leaving as {robot!r}"):
                self._carrier.vanish(robot)

    def _next_due(self) -> float:
        """Return when there is something to do; inf: never."""
        ends = (self._owners.next_end(), self._keeping.due, self._watching.next_oddity())
        return min((*ends, self._outgoing.due))
