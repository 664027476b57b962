"""A notify in progress to the owners of its slots: a state machine without clock, thread or transport."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum

from .messages import Abort, Answer, CommandId, Commit, Find, Prepare, Request

ROUND_SECONDS, LONGEST_ROUND = 0.6, 5.0
"""Seconds that owners have to answer before all are asked again, growing with each round: radios are slow."""

SHORTEST_PAUSE, LONGEST_PAUSE = 0.005, 1.0
"""Seconds before a sender tries again, growing with each try."""

MOST_TRIES = 10
"""After so many, pauses and rounds are as long as they get."""


class TransactionPhase(Enum):
    """How far a notify is."""

    ASKING = "asking"
    PAUSING = "pausing"
    GRANTED = "granted"
    SENDING = "sending"
    DONE = "done"
    ABORTED = "aborted"


@dataclass(frozen=True, slots=True)
class Message:
    """A request in transit: its sender and its owner."""

    sender: str
    owner: str
    request: Request


class Transaction:
    """The steps that bring a notify to its owners. Not thread-safe: its holder guards it.

    All owners are asked in rounds. A round in which one of them keeps the slot for another sender,
    or does not answer, frees the others again, so that an absent owner holds up no robot.

    No owner is asked where all slots are latched, that is, never reset. Then the order of the notify and of
    other events on them does not matter: the owner gives a wait that the notify lets pass a later logical
    time, and it undoes no wait that has passed before.

    Attributes:
        phase: how far it is.
        due: when `tick` has something to do; inf: never.
        lamport: the least logical time that the notify may have, once all have granted it.
        refusals: by owner, why it will never apply it.
    """

    def __init__(
        self,
        id: CommandId,
        parts: Mapping[str, tuple[str, ...]],
        active: bool,
        clock: Callable[[], int],
        chance: random.Random,
        reach: int,
        finds: tuple[Find, ...] = (),
        *,
        latched: bool = False,
    ) -> None:
        """Create without requests.

        Args:
            id: of the command.
            parts: by owner, its slots.
            active: the value.
            clock: the least logical time that the sender can use now.
            chance: for pauses.
            reach: how far beyond the time granted the notify may be recorded.
            finds: detections known to the sender.
            latched: whether no robot ever resets any of these slots, so that it is granted at once.
        """
        self.id, self.active = id, active
        self.phase, self.due, self.lamport = TransactionPhase.PAUSING, 0.0, 0
        self.refusals: dict[str, str] = {}
        self._parts, self._clock, self._chance = dict(parts), clock, chance
        self._reach, self._finds = reach, finds
        self._most = 0
        self._round = self._tries = 0
        self._busy, self._floor = False, 0
        self._granted: dict[str, int] = {}
        self._open = set(parts)
        if latched:
            self._grant(least := clock(), least + reach)

    @property
    def is_granted(self) -> bool:
        """Return whether its logical time is known, so that it can be recorded."""
        return self.phase in (TransactionPhase.GRANTED, TransactionPhase.SENDING, TransactionPhase.DONE)

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or to acknowledge."""
        if self.phase in (TransactionPhase.GRANTED, TransactionPhase.DONE, TransactionPhase.ABORTED):
            return ()
        return tuple(sorted(self._open - set(self._granted if self.phase is TransactionPhase.ASKING else ())))

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to do."""
        return self.phase in (TransactionPhase.DONE, TransactionPhase.ABORTED)

    def tick(self, now: float) -> Iterable[Message]:
        """Return what is to be sent now, if it is due."""
        if now < self.due or self.is_over or self.phase is TransactionPhase.GRANTED:
            return ()
        if self.phase is TransactionPhase.SENDING:
            return self._commits(now)
        freed = self._free() if self.phase is TransactionPhase.ASKING and len(self._parts) > 1 else []
        if self._busy:
            self.phase, self._busy, self.due = TransactionPhase.PAUSING, False, now + self._pause()
            return freed
        return [*freed, *self._ask(now)]

    def answered(self, owner: str, round: int, answer: Answer, now: float) -> None:
        """Take an answer to the request of a round; round 0: to what was sent."""
        if answer.what == "refused":
            self.refusals[owner] = answer.why
        elif self.phase is TransactionPhase.SENDING and answer.what == "applied":
            self._close(owner)
        elif self.phase is TransactionPhase.ASKING and round == self._round:
            if answer.what == "granted":
                self._granted[owner] = answer.lamport
                self._settle()
            elif answer.what in ("busy", "stale"):
                self._busy, self.due = True, now

    def gone(self, owner: str) -> None:
        """Count an owner that has ended as one that has answered."""
        if owner in self._open:
            self._close(owner)

    def back(self, owner: str, now: float) -> None:
        """Try again at once: an owner has appeared."""
        if owner in self._open and not self.is_over:
            self.due, self._tries = now, 0

    def send(self, lamport: int, now: float) -> None:
        """Begin to send it, with the logical time that was recorded.

        Raises:
            ValueError: that time was not granted.
        """
        if self.phase is not TransactionPhase.GRANTED:
            raise ValueError(f"{self.id}: is {self.phase.value}, not granted")
        if not self.lamport <= lamport <= self._most:
            raise ValueError(f"logical time {lamport}: not from {self.lamport} to {self._most}")
        self.lamport, self.due, self._tries = lamport, now, 0
        self.phase = TransactionPhase.SENDING if self._open else TransactionPhase.DONE

    def abort(self) -> Notice | None:
        """Abort it; return what its owners must receive. None: it was sent already, and continues."""
        if self.phase in (TransactionPhase.SENDING, TransactionPhase.DONE, TransactionPhase.ABORTED):
            return None
        freed = {message.owner: message for message in self._free()} if self._round else {}
        self.phase, self.due = TransactionPhase.ABORTED, float("inf")
        return Notice(freed)

    def _ask(self, now: float) -> list[Message]:
        self._round += 1
        self._granted = {}
        self.phase = TransactionPhase.ASKING
        self.due = now + min(LONGEST_ROUND, ROUND_SECONDS * 1.3**self._tries) + self._pause()
        self._settle()
        floor = max(self._clock(), self._floor)
        return [
            self._to(owner, Prepare(self.id, self._round, self._parts[owner], self.active, floor))
            for owner in sorted(self._open)
        ]

    def _commits(self, now: float) -> list[Message]:
        self.due = now + self._pause() + 0.05
        return [
            self._to(owner, Commit(self.id, self._parts[owner], self.active, self.lamport, self._finds))
            for owner in sorted(self._open)
        ]

    def _free(self) -> list[Message]:
        return [self._to(owner, Abort(self.id, self._round)) for owner in sorted(self._open)]

    def _settle(self) -> None:
        """Become granted when all have answered with times that one logical time can satisfy."""
        if self.phase is not TransactionPhase.ASKING or self._open - set(self._granted):
            return
        least = max((self._clock(), *self._granted.values()))
        most = min((time + self._reach for time in self._granted.values()), default=least + self._reach)
        if least > most:
            self._floor, self.due = least, 0.0
            return
        self._grant(least, most)

    def _grant(self, least: int, most: int) -> None:
        self.lamport, self._most, self.phase, self.due = least, most, TransactionPhase.GRANTED, float("inf")

    def _close(self, owner: str) -> None:
        self._open.discard(owner)
        self._granted.pop(owner, None)
        if self.phase is TransactionPhase.SENDING and not self._open:
            self.phase, self.due = TransactionPhase.DONE, float("inf")
        self._settle()

    def _pause(self) -> float:
        self._tries = min(self._tries + 1, MOST_TRIES)
        longest = min(LONGEST_PAUSE, SHORTEST_PAUSE * 2.0**self._tries)
        return self._chance.uniform(longest / 2, longest)

    def _to(self, owner: str, request: Request) -> Message:
        return Message(self.id.sender, owner, request)


class Notice:
    """Messages repeated until each is answered, or until a deadline; not thread-safe.

    Attributes:
        due: when `tick` has something to do. until: when answers are no longer awaited.
    """

    def __init__(self, requests: Mapping[str, Message], until: float = float("inf")) -> None:
        """Create without sending; `requests` by receiver."""
        self.due, self.until = 0.0, until
        self.refusals: dict[str, str] = {}
        self._open = dict(requests)
        self._pause = SHORTEST_PAUSE * 4

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return who has still to answer."""
        return tuple(self._open)

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to do."""
        return not self._open

    def tick(self, now: float) -> Iterable[Message]:
        """Return what is to be sent now, if it is due."""
        if now >= self.until:
            self._open.clear()
        if now < self.due or self.is_over:
            return ()
        self._pause = min(LONGEST_PAUSE, self._pause * 2)
        self.due = min(now + self._pause, self.until)
        return list(self._open.values())

    def answered(self, owner: str, round: int, answer: Answer, now: float) -> None:
        """Take an answer, also one that refuses: telling it again would change nothing."""
        if answer.what == "refused":
            self.refusals[owner] = answer.why
        self._open.pop(owner, None)

    def gone(self, owner: str) -> None:
        """Send no more to a receiver that has ended."""
        self._open.pop(owner, None)

    def back(self, owner: str, now: float) -> None:
        """Send at once to a receiver that has appeared."""
        if owner in self._open:
            self.due, self._pause = now, SHORTEST_PAUSE * 4
