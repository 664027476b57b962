"""One slot as its owner keeps it: its value, the sender it is kept for, and what may have happened to it.

It also holds what an owner knows of senders: the latest command of each, which separates late requests from
new ones, and its starts.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from .messages import CommandId, SlotState

Stamp = tuple[int, str]
"""Logical time and sender of a command: their order is that of the logs."""


@dataclass(frozen=True, slots=True)
class Kept:
    """The sender that a slot is kept for.

    Attributes:
        most: the latest logical time that the notify may have.
        received: when the sender was last received, seconds of any monotonic clock.
    """

    id: CommandId
    round: int
    active: bool
    most: int
    received: float


@dataclass(slots=True)
class Slot:
    """A slot.

    Attributes:
        stamp: of the last command applied.
        kept: None while it is not kept.
        doubts: resets that may have been recorded, by command, with the latest time that they may have.
    """

    state: SlotState
    stamp: Stamp = (0, "")
    kept: Kept | None = None
    doubts: dict[CommandId, int] = field(default_factory=dict)

    @property
    def is_active(self) -> bool:
        """Return whether it is active, and certainly so."""
        return self.state.active and not self.doubts

    def may_be_kept_for(self, id: CommandId) -> bool:
        """Return whether it is not kept, kept for this command, or for one that this one is the heir of."""
        return self.kept is None or id == self.kept.id or is_older(self.kept.id, id)

    def may_be_reset_by(self, id: CommandId) -> bool:
        """Return whether that command is to reset it, or may have done so."""
        return id in self.doubts or (self.kept is not None and self.kept.id == id and not self.kept.active)

    def pass_time(self, lamport: int) -> None:
        """Advance the Lamport clock to at least `lamport`."""
        self.state = replace(self.state, lamport=max(self.state.lamport, lamport))

    def keep(self, kept: Kept) -> None:
        """Keep it for a command; another one that it was kept for is lost."""
        if self.kept is not None and self.kept.id != kept.id:
            self.lose_sender()
        self.kept = kept

    def lose_sender(self) -> None:
        """Stop keeping it for a sender whose records are unknown."""
        kept = self.kept
        if kept is None:
            return
        self.kept = None
        self.pass_time(kept.most)
        if not kept.active:
            self.doubts[kept.id] = kept.most

    def free(self, id: CommandId, round: int | None = None) -> None:
        """Stop keeping it for a command, up to a round or whatever round it is; what it did is known."""
        if self.kept is not None and self.kept.id == id and (round is None or self.kept.round <= round):
            self.kept = None
        self.doubts.pop(id, None)

    def free_older(self, than: CommandId) -> None:
        """Stop keeping it for the same sender before it was started again; what that did is known."""
        if self.kept is not None and is_older(self.kept.id, than):
            self.kept = None
        self.doubts = {id: most for id, most in self.doubts.items() if not is_older(id, than)}

    def set(self, active: bool, stamp: Stamp) -> None:
        """Set it unless a later command has."""
        lamport = max(self.state.lamport, stamp[0])
        if stamp <= self.stamp:
            self.pass_time(lamport)
            return
        self.stamp = stamp
        self.state = SlotState(active, self.state.version + 1, lamport, stamp[1])
        self.doubts = {id: most for id, most in self.doubts.items() if most >= stamp[0]}


def is_older(id: CommandId, than: CommandId) -> bool:
    """Return whether a command is of the same sender before it was started again."""
    return id.sender == than.sender and id.incarnation < than.incarnation


class Latest:
    """Knows how far each sender is, and whether what it asked for last is settled."""

    def __init__(self) -> None:
        """Create without senders."""
        self._places: dict[str, tuple[str, int, int]] = {}
        self._settled: dict[str, bool] = {}

    def is_stale(self, id: CommandId, round: int) -> bool:
        """Return whether a request comes after a later one, or after it was settled."""
        latest = self._places.get(id.sender)
        if latest is None:
            return False
        place = _place(id, round)
        return place < latest or (place == latest and self._settled[id.sender])

    def open(self, id: CommandId, round: int) -> None:
        """Take note that a request is the sender's latest."""
        self._places[id.sender] = _place(id, round)
        self._settled[id.sender] = False

    def settle(self, id: CommandId, round: int, *, for_good: bool = False) -> None:
        """Treat late requests for what has been settled as stale; `for_good`: in all rounds."""
        place, latest = _place(id, round), self._places.get(id.sender)
        if latest is None or place >= latest:
            self._places[id.sender], self._settled[id.sender] = place, True
        elif latest[:2] == place[:2] and for_good:
            self._settled[id.sender] = True


class Starts:
    """Records the known starts of each sender.

    An unknown start that is not later than those does not know what the sender did before.
    """

    def __init__(self) -> None:
        """Create without starts."""
        self._known: dict[str, set[str]] = {}

    def admits(self, id: CommandId) -> bool:
        """Return whether a start of a sender is known, or later than all that are."""
        known = self._known.get(id.sender, set())
        return id.incarnation in known or all(_number(id.incarnation) > _number(each) for each in known)

    def is_first(self, id: CommandId) -> bool:
        """Return whether no other start of a sender is known."""
        return self._known.get(id.sender, set()) <= {id.incarnation}

    def add(self, id: CommandId) -> None:
        """Take note of a start of a sender."""
        self._known.setdefault(id.sender, set()).add(id.incarnation)


def _number(incarnation: str) -> str:
    return incarnation.partition("-")[0]


def _place(id: CommandId, round: int) -> tuple[str, int, int]:
    return id.incarnation, id.sequence, round
