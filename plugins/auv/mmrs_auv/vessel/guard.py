"""Has a node fail safe when a message on its bus has two senders."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .node import Node
from .wire.catalogue import EMERGENCY_ID, REASONS
from .wire.check import check_of
from .wire.frame import Frame
from .wire.senders import Senders, own_of

REASON = "TWO_SENDERS"
PERIOD = 0.1
"""Seconds between two emergency messages, for as long as the node lives."""


class Guard:
    """A node, and what it hears that it should not.

    When another node says what only this one is to say, or two others say the same message, it says so, has
    the dive given up by an emergency message, which it repeats for ever, and lets its node hear that, too.

    Args:
        say: is told once which message it is.
    """

    def __init__(self, node: Node, say: Callable[[str], None] = lambda text: None) -> None:
        self.name, self.period = node.name, node.period
        self._node, self._say = node, say
        self._senders = Senders(own_of(node.name, drives=getattr(node, "has_drives", True)))
        self._told = False
        self._due = 0.0
        self._said = 0

    def hear(self, frame: Frame, now: float) -> None:
        """Let the node hear a frame."""
        self.notice(frame, now)
        self._node.hear(frame, now)

    def notice(self, frame: Frame, now: float) -> None:
        """Look at a frame that the node itself is not to hear."""
        self._senders.hear(frame, now)
        if self._senders.fault and not self._told:
            self._told, self._due = True, now
            self._say(f"{self._senders.fault}: the dive is given up")
            self._node.hear(emergency_frame(REASON, 0), now)

    def tick(self, now: float) -> Sequence[Frame]:
        """Return what the node has to say, after an emergency message where one is due."""
        if not self._told or now + 1e-6 < self._due:
            return self._node.tick(now)
        self._due = now + PERIOD
        self._said += 1
        return (emergency_frame(REASON, self._said), *self._node.tick(now))


def emergency_frame(reason: str, counter: int) -> Frame:
    """Return a message that has a dive given up and the drop weight released, the same on every vehicle."""
    data = bytes((REASONS.index(reason), 1, counter % 256))
    return Frame(EMERGENCY_ID, data + bytes((check_of(EMERGENCY_ID, data),)))
