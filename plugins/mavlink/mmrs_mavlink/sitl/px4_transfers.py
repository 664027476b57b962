"""PX4's side of the mission protocol, as its ``mavlink_mission.cpp`` has it."""

from __future__ import annotations

from enum import Enum, auto

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import MISSION, StoredItem, fault_of, kept
from mmrs_mavlink.sitl.settings import PX4
from mmrs_mavlink.sitl.transfers import Address, Message, Say, Send, Stores, Transfers, item_of

RETRY_SECONDS = 0.25
TIMEOUT_SECONDS = 5.0
BUSY = "WPM: REJ. CMD: Busy"


class _State(Enum):
    IDLE = auto()
    RECEIVING = auto()
    SENDING = auto()


class Px4Transfers(Transfers):
    """One transfer at a time, of whatever mission type.

    A list is replaced as a whole when its last item has arrived. Items out of sequence are ignored; the last
    one is accepted again if it arrives again after the end. Items are sent in sequence, each at most twice;
    any other request aborts the transfer.
    """

    def __init__(self, stores: Stores, send: Send, say: Say) -> None:
        super().__init__(stores, send, say)
        self._state = _State.IDLE
        self._kind, self._peer = MISSION, (0, 0)
        self._items: list[StoredItem] = []
        self._seq = self._expected = 0
        self._asked = self._received = -1.0

    def advance(self, now: float, timeout: float) -> None:
        """Repeat unanswered requests, and abort a transfer that times out, after `timeout` s at least."""
        if self._state is _State.IDLE:
            return
        self._asked = now if self._asked < 0.0 else self._asked
        self._received = now if self._received < 0.0 else self._received
        if self._state is _State.RECEIVING and now - self._asked > max(RETRY_SECONDS, timeout / 2.0):
            self._ask_next()
        if now - self._received > max(TIMEOUT_SECONDS, 2.0 * timeout):
            self._complain("Operation timeout")
            self._state = _State.IDLE

    def _start(self, message: Message, peer: Address) -> None:
        if self.busy:
            self._acknowledge(peer, mavlink.MAV_MISSION_NO_SPACE, message.mission_type)
        elif self._state is _State.IDLE:
            self._begin(message, peer)
        elif self._state is _State.RECEIVING and peer == self._peer and self._seq == 0:
            self._received = -1.0
            self._ask_next()
        else:
            self._received = -1.0 if self._state is _State.RECEIVING else self._received
            self._complain(BUSY)
            self._acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)

    def _begin(self, message: Message, peer: Address) -> None:
        self._kind, self._peer = message.mission_type, peer
        if self._kind not in self.stores:
            self._acknowledge(peer, mavlink.MAV_MISSION_INVALID, self._kind)
        elif message.count == 0:
            self._replace([])
        else:
            self._state, self._seq, self._expected = _State.RECEIVING, 0, message.count
            self._items, self._received = [], -1.0
            self._ask_next()

    def _receive(self, message: Message, peer: Address) -> None:
        if peer != self._peer:
            self._complain("REJ. MIS ITEM: partner id mismatch")
        elif message.mission_type != self._kind or self._state is _State.SENDING:
            self._acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)
        elif self._state is _State.IDLE:
            again = self._seq == message.seq + 1
            result = mavlink.MAV_MISSION_ACCEPTED if again else mavlink.MAV_MISSION_ERROR
            self._acknowledge(peer, result, self._kind)
        else:
            self._received = -1.0
            if message.seq == self._seq:
                self._keep(item_of(message))

    def _keep(self, item: StoredItem) -> None:
        if fault := fault_of(item, self._kind, PX4):
            self._state = _State.IDLE
            self._acknowledge(self._peer, fault, self._kind)
            return
        self._items.append(kept(item, self._kind, PX4))
        self._seq += 1
        if self._seq == self._expected:
            self._state = _State.IDLE
            self._replace(self._items)
        else:
            self._ask_next()

    def _replace(self, items: list[StoredItem]) -> None:
        self.stores[self._kind] = list(items)
        self._acknowledge(self._peer, mavlink.MAV_MISSION_ACCEPTED, self._kind)
        self.finished(self._kind)

    def _clear(self, message: Message, peer: Address) -> None:
        if self._state is not _State.IDLE:
            self._complain("WPM: IGN CLEAR CMD: Busy")
            return
        self._kind = message.mission_type
        self._clear_stores(peer, self._kind)

    def _end(self, message: Message, peer: Address) -> None:
        cancelled = message.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
        sent = self._state is _State.SENDING and message.mission_type == self._kind
        if peer == self._peer and (sent or (self._state is _State.RECEIVING and cancelled)):
            self._state = _State.IDLE

    def _list(self, message: Message, peer: Address) -> None:
        if self._seq == len(self.stores.get(self._kind, ())):
            self._state = _State.IDLE
        same = (message.mission_type, peer) == (self._kind, self._peer)
        if self._state is _State.IDLE or (self._state is _State.SENDING and same):
            self._state, self._seq, self._received = _State.SENDING, 0, -1.0
            self._kind, self._peer = message.mission_type, peer
            self._count(peer, self._kind)
        else:
            self._complain("Mission download request ignored, already active")

    def _request(self, message: Message, peer: Address) -> None:
        if peer != self._peer or self._state is _State.RECEIVING:
            self._complain(BUSY)
        elif self._state is _State.SENDING and message.mission_type == self._kind:
            self._received = -1.0
            number = len(self.stores.get(self._kind, ()))
            if message.seq not in (self._seq, self._seq - 1) or message.seq >= number:
                self._state = _State.IDLE
                self._acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)
                return
            self._seq = message.seq + 1
            self._give(peer, message)

    def _ask_next(self) -> None:
        self._asked = -1.0
        self._ask(self._peer, self._seq, self._kind)

    def _complain(self, text: str) -> None:
        self._say(mavlink.MAV_SEVERITY_CRITICAL, text)
