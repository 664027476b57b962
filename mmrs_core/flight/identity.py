"""Whether it is still the same vehicle that speaks, by the time since it was switched on."""

from __future__ import annotations

from .ports import Address

LATE_MILLISECONDS = 5_000
"""By how much a message may be older than one that came before it, on a poor link."""

CONFIRMED = 3
"""How many messages from another start there must be before it is believed."""

ROAMING_SECONDS = 3.0
"""Real seconds of silence after which a vehicle may speak from another address."""


class Identity:
    """Tells a vehicle that has started anew, and two vehicles that have the same system id.

    Attributes:
        starts: how often the vehicle has been seen to start anew.
        twin: why there must be two vehicles; empty while there is one.
    """

    def __init__(self, late_milliseconds: float = LATE_MILLISECONDS) -> None:
        """Begin with a vehicle that was not heard yet."""
        self.starts = 0
        self.twin = ""
        self._late = late_milliseconds
        self._sender: Address | None = None
        self._spoke = float("-inf")
        self._strangers: dict[Address, int] = {}
        self._newest = 0.0
        self._other = 0.0
        self._behind = 0
        self._between = 0

    @property
    def sender(self) -> Address | None:
        """Return from where the vehicle speaks."""
        return self._sender

    def speaks_from(self, sender: Address | None, real_time: float, *, heartbeat: bool) -> bool:
        """Return whether a frame with the vehicle's ids is its own, by where it comes from."""
        if sender != self._sender and real_time - self._spoke < ROAMING_SECONDS:
            if heartbeat and sender is not None:
                self._strange(sender)
            return False
        self._sender, self._spoke = sender, real_time
        return True

    def booted(self, milliseconds: float) -> None:
        """Take note of the time since the vehicle's start, as one of its messages says it."""
        if milliseconds >= self._newest - self._late:
            self._newest = max(self._newest, milliseconds)
            self._between += self._behind > 0
            if self._behind >= CONFIRMED and self._between >= CONFIRMED:
                self.twin = "messages from two different starts take turns"
            return
        if self._behind and milliseconds < self._other:
            return
        self._other, self._behind = milliseconds, self._behind + 1
        if self._behind >= CONFIRMED and not self._between:
            self._begin_anew(milliseconds)

    def _begin_anew(self, milliseconds: float) -> None:
        self.starts += 1
        self._newest, self._other, self._behind = milliseconds, 0.0, 0

    def _strange(self, sender: Address) -> None:
        self._strangers[sender] = self._strangers.get(sender, 0) + 1
        if self._strangers[sender] >= CONFIRMED - 1:
            here = "another port" if self._sender is None else f"{self._sender[0]}:{self._sender[1]}"
            self.twin = f"it speaks from {here} and from {sender[0]}:{sender[1]}"
