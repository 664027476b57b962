"""A robot that cannot leave its move yet: since when, for what, until when, and who could still end that."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from math import inf

from ..faults import PEER_LOST, WAIT_TOO_LONG
from ..program import Program, SlotId
from ..slots import Slots
from ..vehicle import Fault
from .decisions import Asking
from .responses import Responses


class Peers:
    """The robots that have a notify on each slot, and which of them make no further step.

    A robot that waits for a slot that only failed robots could have set has lost its peer. Of robots in
    other processes the bus knows whether they are still there.
    """

    def __init__(self, program: Program, here: Collection[str], slots: Slots) -> None:
        """Create for the robots of this process, with the bus for the others."""
        self._here, self._slots = frozenset(here), slots
        self._setters: dict[SlotId, set[str]] = {}
        self._owners: dict[str, set[str]] = {}
        self._retired: dict[str, bool] = {}
        for robot in program.robots:
            for notify in robot.notifies:
                for slot in notify.slots if notify.active else ():
                    self._setters.setdefault(slot, set()).add(robot.id)
                    self._owners.setdefault(robot.id, set()).add(slot[0])

    def retire(self, robot: str, *, failed: bool) -> Iterable[str]:
        """Note that a robot of this process makes no further step; return who may have waited for it."""
        self._retired[robot] = failed
        return self._owners.get(robot, ())

    def lost(self, slot: SlotId) -> tuple[str, ...]:
        """Return the failed robots whose loss means that the slot is never set; empty otherwise."""
        setters = self._setters.get(slot, set()) - {slot[0]}
        gone = {robot for robot in setters & self._here if robot in self._retired}
        away = set(self._slots.lost(sorted(setters - self._here)))
        if gone | away != setters:
            return ()
        return tuple(sorted(away | {robot for robot in gone if self._retired[robot]}))

    def are_away(self, robots: Iterable[str]) -> bool:
        """Return whether some of these robots are of other processes."""
        return not self._here.issuperset(robots)


class Wait:
    """What keeps a robot at a move that it has done.

    Attributes:
        since: when it began to wait; None: it does not.
        lacking: names of the slots that it waited for at the last look.
        question: identifier of the undecided condition that it waits for; empty: none.
        asking: that condition while a function of the user is asked; None: none is.
        ask_at: when that function may be asked again, if it could not answer yet; its answer wakes the robot.
        is_told: whether it was reported that it waits for a decision.
        deadline: when the wait ends by a fault; inf: never.
    """

    def __init__(self, robot: str) -> None:
        """Wait for nothing; `robot`: whose slots are waited for."""
        self.since: float | None = None
        self.lacking: tuple[str, ...] = ()
        self.question = ""
        self.asking: Asking | None = None
        self.ask_at = -inf
        self.is_told = False
        self.deadline = inf
        self._robot = robot
        self._peer_lost_at: float | None = None

    def begin(self, now: float) -> bool:
        """Take note that the robot waits; return whether it did not before."""
        if self.since is not None:
            return False
        self.since = now
        return True

    def extend(self, seconds: float) -> None:
        """Extend the wait's deadline by the seconds that the robot was held."""
        self.since = None if self.since is None else self.since + seconds
        self._peer_lost_at = None if self._peer_lost_at is None else self._peer_lost_at + seconds
        self.deadline += seconds

    def overdue(self, now: float, answers: Responses, peers: Peers) -> Fault | None:
        """Return the fault by which the wait ends now, if it does."""
        ends = (self._too_long(answers), self._peer_lost(now, answers, peers))
        self.deadline = min(end for end, _ in ends)
        return next((reason for end, reason in ends if end <= now), None)

    def _too_long(self, answers: Responses) -> tuple[float, Fault]:
        found = Fault(WAIT_TOO_LONG, f"waits for {', '.join(self.lacking) or self.question}")
        return (self.since or 0.0) + answers.patience(found), found

    def _peer_lost(self, now: float, answers: Responses, peers: Peers) -> tuple[float, Fault]:
        lost = sorted({robot for name in self.lacking for robot in peers.lost((self._robot, name))})
        found = Fault(PEER_LOST, f"waits for {', '.join(self.lacking)} of {', '.join(lost)}")
        if not lost:
            self._peer_lost_at = None
            return inf, found
        if self._peer_lost_at is None:
            self._peer_lost_at = now
        return self._peer_lost_at + answers.patience(found, away=peers.are_away(lost)), found


class NotifyWait:
    """A robot's notify in progress, and how long its owners have been silent."""

    def __init__(self) -> None:
        """Start with no silent owner."""
        self._silent_since: float | None = None

    def silence(self, now: float) -> float:
        """Return for how many seconds owners have not answered."""
        if self._silent_since is None:
            self._silent_since = now
        return now - self._silent_since

    def extend(self, seconds: float) -> None:
        """Leave out the seconds that the robot was held."""
        self._silent_since = None if self._silent_since is None else self._silent_since + seconds


def silent(owners: Collection[str], slots: Slots) -> str:
    """Return the owners that do not answer a notify, as printed."""
    words = f"no answer from {', '.join(owners)}"
    if unseen := slots.unseen(owners):
        words += f"; {', '.join(unseen)} never came while this robot was there, or had ended before"
    return words


def noted(wait: Wait, names: Collection[str], now: float) -> Mapping[str, object]:
    """Return the black box's entry of a wait that is over."""
    return {"slots": list(names), "seconds": now - (wait.since or 0.0)}
