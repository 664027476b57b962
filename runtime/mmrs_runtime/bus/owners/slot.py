"""One slot as its owner keeps it: its value, for whom it is kept, and what may have happened to it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from ..words import CommandId, SlotState

Stamp = tuple[int, str]
"""Logical time and sender of a command: their order is that of the logs."""


@dataclass(frozen=True, slots=True)
class Kept:
    """For whom a slot is kept.

    Attributes:
        most: the latest logical time that the notify may have.
        heard: when the sender was heard of last, seconds of any clock that never goes back.
    """

    id: CommandId
    round: int
    active: bool
    most: int
    heard: float


@dataclass(slots=True)
class Slot:
    """A slot.

    Attributes:
        stamp: of the last command applied.
        kept: None while it is kept for nobody.
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
        """Return whether it is kept for nobody, for this command, or for one that this one is the heir of."""
        return self.kept is None or id == self.kept.id or is_older(self.kept.id, id)

    def may_be_reset_by(self, id: CommandId) -> bool:
        """Return whether that command is to reset it, or may have done so."""
        return id in self.doubts or (self.kept is not None and self.kept.id == id and not self.kept.active)

    def pass_time(self, lamport: int) -> None:
        """Have all that happens now be later than that logical time."""
        self.state = replace(self.state, lamport=max(self.state.lamport, lamport))

    def keep(self, kept: Kept) -> None:
        """Keep it for a command; another one that it was kept for is lost."""
        if self.kept is not None and self.kept.id != kept.id:
            self.lose_sender()
        self.kept = kept

    def lose_sender(self) -> None:
        """Stop keeping it for a sender of which nobody knows what it has recorded."""
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
