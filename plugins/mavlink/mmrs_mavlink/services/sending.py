"""One transfer of a plan to a vehicle, by its rules: it asks for items, and acknowledges at the end.

Links lose, double and delay, and autopilots differ in their replies then; the following was read in their
sources (ArduPilot's ``MissionItemProtocol.cpp``, PX4's ``mavlink_mission.cpp``):

- An item that comes twice is not an error: ArduPilot answers INVALID_SEQUENCE and continues receiving, PX4
   does not answer. It comes twice as soon as a round trip takes longer than the vehicle waits before
   it asks again (a second, and a quarter of one).
- PX4 answers ERROR to a count that comes twice, and continues receiving, too. So a refusal is final only
   where the vehicle asks for nothing more.
- PX4 accepts once more what it took to be a doubled last item, even of a transfer that it had aborted. So
   no acceptance counts before the last item was sent.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link, Message
from .exchanges import concerns, first, lacks_kinds, mark_of, old_port, words_of
from .items import Item

ANSWERS = ("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK")
BEFORE_MARK = 4
"""Bytes of a MISSION_ACK before the id of the plan."""

REPEATS = 50
"""How often an item is sent to a vehicle: one that asks for it more often does not receive it."""


@dataclass
class Transfer:
    """How transfers of one plan have gone so far.

    Attributes:
        begun: whether the vehicle has asked for an item.
        whole: whether it was sent the last item in the latest of them.
        mark: the id that it gave to the plan; 0 where it gave none.
        outcome: in words, what it did instead of accepting it; empty if it has accepted it.
    """

    begun: bool = False
    whole: bool = False
    mark: int = 0
    outcome: str = "answers nothing"


def send_all(link: Link, items: Sequence[Item], kind: int, transfer: Transfer) -> bool:
    """Offer a plan of at least one item, and give what is asked for; return whether it was accepted.

    Raises:
        RefusedError: the vehicle's port is too old for that kind of plan.
    """
    transfer.whole, transfer.outcome = False, "answers nothing"
    with link.inbox(*ANSWERS) as inbox:
        sending = _Sending(link, items, kind, transfer)
        attempts = link.attempts()
        while not sending.over and next(attempts, None) is not None:
            link.send(sending.latest)
            if sending.listen(inbox):
                attempts = link.attempts()
    return not transfer.outcome


@dataclass
class _Sending:
    """What is sent next.

    Attributes:
        latest: what was sent last, or is next: the count, or an item.
        refused: whether the vehicle has refused something, and has asked for nothing since.
        over: whether nothing more is to be sent.
    """

    link: Link
    items: Sequence[Item]
    kind: int
    transfer: Transfer
    refused: bool = False
    over: bool = False
    given: Counter[int] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        link = self.link
        self.latest: Message = mavlink.MAVLink_mission_count_message(
            link.system, link.component, len(self.items), self.kind
        )

    def listen(self, inbox: deque[Message]) -> bool:
        """Wait until an item is asked for, or nothing comes any more; return whether one is.

        Raises:
            RefusedError: the vehicle will never take it.
        """
        for _ in range(REPEATS):
            message = self.link.wait(lambda: first(inbox, self._concerns), self.link.patience)
            if message is None:
                self.over = self.refused
                return False
            if not concerns(message, self.kind):
                self.link.send(cancellation(self.link, message.mission_type))
            elif message.get_type() == "MISSION_ACK":
                self._take(message)
            else:
                self._give(int(message.seq))
                return True
            if self.over:
                return False
        return False

    def _concerns(self, message: Message) -> bool:
        """Return whether a message concerns this transfer.

        A PX4 that still wants or gives items of another kind, since a doubled count has reached it late or
        our last message has not, begins nothing else until it is informed that this is over.
        """
        answers = message.get_type() == "MISSION_ACK"
        if not concerns(message, self.kind):
            busy = not answers or message.type == mavlink.MAV_MISSION_ERROR
            return busy and not self.transfer.begun
        if not answers:
            return bool(0 <= message.seq < len(self.items))
        if message.type == mavlink.MAV_MISSION_ACCEPTED:
            return self.transfer.whole
        if message.type == mavlink.MAV_MISSION_INVALID_SEQUENCE:
            self._note(message)
            return False
        return True

    def _take(self, answer: Message) -> None:
        """Take a refusal, which is the end unless the vehicle asks for something more, or what ends it."""
        if answer.type == mavlink.MAV_MISSION_ACCEPTED:
            self.transfer.mark, self.transfer.outcome = mark_of(answer, BEFORE_MARK), ""
            self.over = True
        elif lacks_kinds(answer, self.kind):
            raise old_port(self.kind)
        else:
            self._note(answer)
            self.refused = True

    def _give(self, seq: int) -> None:
        """Send the item that was asked for, unless the vehicle never receives it."""
        self.given[seq] += 1
        self.refused, self.transfer.begun, self.transfer.outcome = False, True, "answers nothing more"
        self.transfer.whole = self.transfer.whole or seq == len(self.items) - 1
        self.latest = _message(self.link, seq, self.items[seq], self.kind)
        if self.given[seq] > REPEATS:
            self.transfer.outcome, self.over = f"asks for item {seq} again and again", True

    def _note(self, message: Message) -> None:
        self.transfer.outcome = f"answers '{words_of(message.type)}'"


def cancellation(link: Link, kind: int) -> Message:
    """Return the message that makes a vehicle end a transfer of that kind; ArduPilot ignores it."""
    cancelled = mavlink.MAV_MISSION_OPERATION_CANCELLED
    return mavlink.MAVLink_mission_ack_message(link.system, link.component, cancelled, kind)


def _message(link: Link, seq: int, item: Item, kind: int) -> Message:
    return mavlink.MAVLink_mission_item_int_message(
        link.system,
        link.component,
        seq,
        item.frame,
        item.command,
        0,
        1,
        *item.params,
        item.x,
        item.y,
        item.z,
        kind,
    )
