"""Has a node fail safe when a message on its bus has two senders."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Sequence

from auv_vessel.node import Node
from auv_vessel.refusals import MOST_THRUSTERS
from auv_vessel.wire.catalogue import (
    ACTUATORS,
    BEATS,
    COMMAND_BASE,
    COMMON,
    EMERGENCIES,
    REASONS,
    STATUS_BASE,
    VEHICLE,
)
from auv_vessel.wire.frame import Frame, check_of, is_sound

LATE = 16
"""Frames by which one may come late, as over a network, and still be of the same sender."""

AHEAD = 32
"""Frames that may be lost between two of the same sender."""

STRAYS = 3
"""Frames that another sender has to say before it is believed in."""

FORGOTTEN = 5.0
"""Seconds after which strays, and the counter of a sender that is silent, count no more."""

_NAMES = {each.id: each.name for each in (*COMMON, *BEATS)}


class Senders:
    """Watches the messages that one node sends and receives.

    Two senders of one message are distinguished from one that restarted, and from frames that are lost,
    doubled or late: each counts independently, and both continue.

    Args:
        own: identifiers of messages that only this node sends.

    Attributes:
        fault: which message has two senders, in words; empty: none has.
    """

    def __init__(self, own: Collection[int]) -> None:
        self.fault = ""
        self._own = frozenset(own)
        self._mine: deque[float] = deque(maxlen=STRAYS)
        self._counters: dict[int, _Counter] = {}

    def hear(self, frame: Frame, now: float) -> None:
        """Take a frame that another node said; one whose check is wrong may be any, damaged."""
        if self.fault or frame.extended:
            return
        id, data = frame.id, frame.data
        if len(data) < 2 or not is_sound(id, data):
            return
        counter = self._counters.get(id)
        if counter is not None:
            if counter.is_anothers(data, now):
                self.fault = f"two nodes say {name_of(id)}, which only one is to say"
        elif id not in self._own:
            self._counters[id] = _Counter(data, now)
        else:
            self._mine.append(now)
            if len(self._mine) == STRAYS and now - self._mine[0] <= FORGOTTEN:
                self.fault = f"another node says {name_of(id)}, which only this one is to say"


class _Counter:
    """The counter of one message.

    It follows one sender; frames out of sequence are strays, which form a sequence of their own if they are
    another sender's, or that of the first after a restart.
    """

    def __init__(self, data: bytes, now: float) -> None:
        self._begin(data, now)

    def _begin(self, data: bytes, now: float) -> None:
        self._newest, self._received = data[-2], now
        self._recent = deque([data], maxlen=2 * LATE)
        self._stray, self._strayed, self._strays = 0, now, 0
        self._meanwhile = False

    def is_anothers(self, data: bytes, now: float) -> bool:
        """Take what the next frame says; return whether there is another sender besides the first."""
        number = data[-2]
        if now - self._received > FORGOTTEN:
            self._begin(data, now)
        elif 1 <= (number - self._newest) % 256 <= AHEAD:
            self._newest, self._received, self._meanwhile = number, now, True
            self._recent.append(data)
        elif data in self._recent:
            return False
        elif (self._newest - number) % 256 < LATE and all(each[-2] != number for each in self._recent):
            self._recent.append(data)
        else:
            return self._goes_astray(data, now)
        return False

    def _goes_astray(self, data: bytes, now: float) -> bool:
        follows = (data[-2] - self._stray) % 256 <= AHEAD and now - self._strayed <= FORGOTTEN
        if not self._strays or not follows:
            self._strays, self._meanwhile = 0, False
        self._stray, self._strayed = data[-2], now
        self._strays += 1
        if self._strays < STRAYS:
            return False
        if self._meanwhile:
            return True
        self._begin(data, now)
        return False


def name_of(id: int) -> str:
    """Return the name of a message with an identifier of 11 bits, and that."""
    name = _NAMES.get(id, "a message")
    for base, word in ((COMMAND_BASE, "Command"), (STATUS_BASE, "Status")):
        if base <= id < base + MOST_THRUSTERS:
            name = f"Thruster{id - base}{word}"
    return f"{name} (0x{id:03X})"


def own_of(node: str, *, drives: bool = True) -> frozenset[int]:
    """Return the identifiers of what only one node says.

    Args:
        node: its name. drives: whether those of the thrusters are part of the vehicle's node.
    """
    said = {each.id for each in (*COMMON, *BEATS) if each.sender == node}
    numbers = range(MOST_THRUSTERS)
    if node == ACTUATORS:
        said |= {COMMAND_BASE + number for number in numbers}
    if node == VEHICLE and drives:
        said |= {STATUS_BASE + number for number in numbers}
    return frozenset(said)


REASON = "TWO_SENDERS"
PERIOD = 0.1
"""Seconds between two emergency messages, for as long as the node lives."""


class Guard:
    """A node, and frames of others that only it may send.

    When another node sends a message of this one, or two others send the same message, it reports that,
    aborts the dive by the node's emergency message, which it repeats without end in place of the node, and
    passes one to its node, too. A node that is not in the bus's database has no such message.

    Args:
        say: receives once which message it is.
    """

    def __init__(self, node: Node, say: Callable[[str], None] = lambda text: None) -> None:
        self.name, self.period = node.name, node.period
        self._node, self._say = node, say
        self._senders = Senders(own_of(node.name, drives=getattr(node, "has_drives", True)))
        self._reported = False
        self._due = 0.0
        self._said = 255

    def hear(self, frame: Frame, now: float) -> None:
        """Pass a frame to the node."""
        self.notice(frame, now)
        self._node.hear(frame, now)

    def notice(self, frame: Frame, now: float) -> None:
        """Inspect a frame that the node itself does not receive."""
        if self._reported:
            return
        self._senders.hear(frame, now)
        if self._senders.fault:
            self._reported, self._due = True, now
            self._say(f"{self._senders.fault}: the dive is given up")
            self._node.hear(emergency_frame(VEHICLE, REASON, 0), now)

    def tick(self, now: float) -> Sequence[Frame]:
        """Return what the node has to say, after an emergency message where one is due."""
        said, own = self._node.tick(now), EMERGENCIES.get(f"{self.name}Emergency")
        if own is None:
            return said
        if not self._reported:
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
