"""Reads what a vehicle has of a plan, item by item.

ArduPilot denies that while it receives a plan, which may be one that a doubled count has begun late, and
gives that up after eight seconds. PX4 gives items in their order only, and breaks off when an old request
comes late: then it is asked for all of them again.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import inf

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..faults import Refused
from ..links.link import Link, Message
from .exchanges import concerns, first, lacks_kinds, old_port, words_of
from .items import MISSION, Item

ANSWERS = ("MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK")
BUSY_SECONDS, LEAST_BUSY_SECONDS = 12.0, 2.0
"""For how long, of the run and real at least, a vehicle is asked again that says that it is receiving."""

MARGIN = 1.5
"""An answer is waited for that much longer than the quickest took: a slow radio must not ask twice."""


def download(link: Link, kind: int = MISSION) -> tuple[Item, ...]:
    """Return what the vehicle has of that kind.

    Raises:
        Refused: the vehicle does not answer, or does not let it be read.
    """
    with link.inbox(*ANSWERS) as inbox:
        reading = _Reading(link, kind, inbox)
        for attempt in range(link.retries.tries):
            count = reading.count()
            try:
                items = tuple(reading.item(seq) for seq in range(count))
                break
            except Refused:
                if attempt + 1 == link.retries.tries:
                    raise
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return items


def count_of(link: Link, kind: int) -> int:
    """Return how many items of that kind the vehicle has.

    Raises:
        Refused: the vehicle does not answer.
    """
    with link.inbox(*ANSWERS) as inbox:
        count = _Reading(link, kind, inbox).count()
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return count


@dataclass
class _Reading:
    """Asks a vehicle for what it has.

    Attributes:
        quickest: seconds that an answer took at least so far.
        refusal: what the vehicle has last answered instead, in words; empty if it has not.
    """

    link: Link
    kind: int
    inbox: deque[Message]
    quickest: float = inf
    refusal: str = ""

    def count(self) -> int:
        """Return how many items there are; a vehicle that is receiving is asked again."""
        ask = mavlink.MAVLink_mission_request_list_message(self.link.system, self.link.component, self.kind)
        until = self.link.clock.now() + self.link.clock.patience(BUSY_SECONDS, LEAST_BUSY_SECONDS)
        while True:
            try:
                return int(self._asked(ask, "MISSION_COUNT", self.link.retries.answer).count)
            except Refused:
                if not self.refusal or self.link.clock.now() > until:
                    raise

    def item(self, seq: int) -> Item:
        """Return an item."""
        ask = mavlink.MAVLink_mission_request_int_message(
            self.link.system, self.link.component, seq, self.kind
        )
        found = self._asked(ask, "MISSION_ITEM_INT", self.link.retries.item, seq)
        params = (found.param1, found.param2, found.param3, found.param4)
        return Item(found.command, params, found.x, found.y, found.z, found.frame)

    def _asked(self, ask: Message, answer: str, seconds: float, seq: int | None = None) -> Message:
        """Ask until the answer comes; what is refused is asked once more, for it may be an old refusal.

        Raises:
            Refused: it does not come.
        """
        begun, self.refusal = self.link.clock.now(), ""
        for _ in self.link.attempts():
            self.link.send(ask)
            found = self._answer(answer, seconds, seq)
            if found is None:
                continue
            if found.get_type() == answer:
                self.quickest = min(self.quickest, self.link.clock.now() - begun)
                return found
            if self.refusal:
                break
            self.refusal = words_of(found.type)
            self.link.wait(lambda: None, seconds)
        does = f"answers '{self.refusal}'" if self.refusal else "does not answer"
        raise Refused(f"{ask.get_type()}: the vehicle {does}")

    def _answer(self, kind: str, seconds: float, seq: int | None) -> Message | None:
        """Wait for an answer, or for a refusal."""

        def fits(message: Message) -> bool:
            refuses = message.get_type() == "MISSION_ACK" and message.type != mavlink.MAV_MISSION_ACCEPTED
            right = message.get_type() == kind and (seq is None or message.seq == seq)
            return (refuses or right) and concerns(message, self.kind)

        usual = self.link.clock.patience(seconds, seconds)
        longer = MARGIN * self.quickest if self.quickest < inf else 0.0
        found = self.link.wait(lambda: first(self.inbox, fits), max(usual, longer))
        if found is not None and lacks_kinds(found, self.kind):
            raise old_port(self.kind)
        return found
