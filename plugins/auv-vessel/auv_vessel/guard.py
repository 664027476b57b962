"""Has a node fail safe when a message on its bus has two senders."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from auv_vessel.node import Node
from auv_vessel.wire.catalogue import EMERGENCIES, REASONS, VEHICLE
from auv_vessel.wire.check import check_of
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.senders import Senders, own_of

REASON = "TWO_SENDERS"
PERIOD = 0.1
"""Seconds between two emergency messages, for as long as the node lives."""


class Guard:
    """A node, and what it hears that it should not.

    When another node says what only this one is to say, or two others say the same message, it says so, has
    the dive given up by the node's emergency message, which it repeats for ever in place of the node, and
    lets its node hear one, too. A node that is not in the bus's database has no such message.

    Args:
        say: is told once which message it is.
    """

    def __init__(self, node: Node, say: Callable[[str], None] = lambda text: None) -> None:
        self.name, self.period = node.name, node.period
        self._node, self._say = node, say
        self._senders = Senders(own_of(node.name, drives=getattr(node, "has_drives", True)))
        self._told = False
        self._due = 0.0
        self._said = 255

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
            self._node.hear(emergency_frame(VEHICLE, REASON, 0), now)

    def tick(self, now: float) -> Sequence[Frame]:
        """Return what the node has to say, after an emergency message where one is due."""
        said, own = self._node.tick(now), EMERGENCIES.get(f"{self.name}Emergency")
        if own is None:
            return said
        if not self._told:
            self._said = next((frame.data[-2] for frame in said if frame.id == own), self._said)
            return said
        others = tuple(frame for frame in said if frame.id != own)
        if now + 1e-6 < self._due:
            return others
        self._due = now + PERIOD
        self._said += 1
        return (emergency_frame(self.name, REASON, self._said), *others)


def emergency_frame(node: str, reason: str, counter: int) -> Frame:
    """Return a node's message that has a dive given up and the drop weight released, on any vehicle.

    Raises:
        KeyError: the bus's database has no such node.
    """
    id, data = EMERGENCIES[f"{node}Emergency"], bytes((REASONS.index(reason), 1, counter % 256))
    return Frame(id, data + bytes((check_of(id, data),)))
