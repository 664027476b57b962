"""Reads what a vehicle has of a plan, item by item.

ArduPilot denies that while it receives a plan, which may be one that a doubled count has begun late, and
gives that up after eight seconds. PX4 gives items in their order only, and breaks off when an old request
comes late: then it is asked for all of them again. So that requests do not come late, what is not answered
is asked for again after a longer and longer while, the first of which follows what the link takes.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link, Message
from .exchanges import concerns, first, lacks_kinds, old_port, words_of
from .items import MISSION, NAMES, Item

ANSWERS = ("MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK")
BUSY_SECONDS, LEAST_BUSY_SECONDS = 12.0, 2.0
"""For how long, of the run and real at least, a vehicle is asked again that says that it is receiving."""

MARGIN = 1.5
"""An answer is waited for that much longer than the last took: a slow radio must not be asked twice."""

MOST = 2.0
"""An item is waited for that much longer than any other answer at most: PX4 gives up after five seconds."""

BREAKING_OFF = {
    "MISSION_COUNT": frozenset({mavlink.MAV_MISSION_DENIED}),
    "MISSION_ITEM_INT": frozenset({mavlink.MAV_MISSION_DENIED, mavlink.MAV_MISSION_ERROR}),
}
"""Results that end the reading, by what was asked for; others may be late answers to something else."""


def download(link: Link, kind: int = MISSION) -> tuple[Item, ...]:
    """Return what the vehicle has of that kind.

    Raises:
        RefusedError: the vehicle does not answer, or does not let it be read.
    """
    with link.inbox(*ANSWERS) as inbox:
        reading = _Reading(link, kind, inbox)
        for attempt in range(link.retries.tries):
            count = reading.count()
            try:
                items = tuple(reading.item(seq) for seq in range(count))
                break
            except RefusedError:
                if attempt + 1 == link.retries.tries:
                    raise
                link.wait(lambda: None, link.retries.answer)
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return items


def count_of(link: Link, kind: int) -> int:
    """Return how many items of that kind the vehicle has.

    Raises:
        RefusedError: the vehicle does not answer.
    """
    with link.inbox(*ANSWERS) as inbox:
        count = _Reading(link, kind, inbox).count()
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return count


@dataclass
class _Reading:
    """Asks a vehicle for what it has.

    Attributes:
        took: seconds from the first request to the answer, the last time that one came.
        refusal: what the vehicle has last answered instead, in words; empty if it has not.
    """

    link: Link
    kind: int
    inbox: deque[Message]
    took: float = 0.0
    refusal: str = ""

    def count(self) -> int:
        """Return how many items there are; a vehicle that is receiving is asked again."""
        ask = mavlink.MAVLink_mission_request_list_message(self.link.system, self.link.component, self.kind)
        until = self.link.clock.now() + self.link.clock.patience(BUSY_SECONDS, LEAST_BUSY_SECONDS)
        while True:
            try:
                return int(self._asked(ask, "MISSION_COUNT", self.link.retries.answer).count)
            except RefusedError:
                if not self.refusal or self.link.clock.now() > until:
                    raise
                self.link.wait(lambda: None, self.link.retries.answer)

    def item(self, seq: int) -> Item:
        """Return an item."""
        ask = mavlink.MAVLink_mission_request_int_message(
            self.link.system, self.link.component, seq, self.kind
        )
        found = self._asked(ask, "MISSION_ITEM_INT", self.link.retries.item, seq)
        params = (found.param1, found.param2, found.param3, found.param4)
        return Item(found.command, params, found.x, found.y, found.z, found.frame)

    def _asked(self, ask: Message, answer: str, seconds: float, seq: int | None = None) -> Message:
        """Ask until the answer comes.

        Raises:
            RefusedError: it does not come.
        """
        begun, self.refusal = self.link.clock.now(), ""
        least = self.link.clock.patience(seconds, seconds)
        longest = max(least, MOST * self.link.patience)
        usual = min(max(least, MARGIN * self.took), longest)
        for sent in self.link.attempts():
            self.link.send(ask)
            wait = min(usual * 2.0**sent, max(usual, self.link.patience))
            found = self.link.wait(lambda: first(self.inbox, lambda m: self._fits(m, answer, seq)), wait)
            if found is not None and found.get_type() == answer:
                self.took = self.link.clock.now() - begun
                return found
            if found is not None:
                break
        does = f"answers '{self.refusal}'" if self.refusal else "does not answer"
        raise RefusedError(f"{NAMES[self.kind]}: the vehicle {does} when it is read back ({ask.get_type()})")

    def _fits(self, message: Message, answer: str, seq: int | None) -> bool:
        """Return whether a message is the answer, or ends the reading.

        Raises:
            RefusedError: the vehicle's port is too old for that kind of plan.
        """
        if not concerns(message, self.kind):
            return False
        if message.get_type() != "MISSION_ACK":
            return bool(message.get_type() == answer and seq in (None, getattr(message, "seq", None)))
        if lacks_kinds(message, self.kind):
            raise old_port(self.kind)
        if message.type != mavlink.MAV_MISSION_ACCEPTED:
            self.refusal = words_of(message.type)
        return message.type in BREAKING_OFF[answer]
