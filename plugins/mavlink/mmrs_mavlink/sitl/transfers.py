"""Mission protocol of a simulated vehicle: what both firmwares share, and ArduPilot's side of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import FENCE, MISSION, RALLY, StoredItem, fault_of, kept
from mmrs_mavlink.sitl.settings import ARDUPILOT

Message = Any
Address = tuple[int, int]
"""MAVLink system and component."""

Stores = dict[int, list[StoredItem]]
"""Items by mission type."""

Send = Callable[[Message], None]
Say = Callable[[int, str], None]
"""Sends a STATUSTEXT of a severity."""

RETRY_SECONDS = 1.0
TIMEOUT_SECONDS = 8.0
NAMES = {MISSION: "Mission", FENCE: "Fence", RALLY: "Rally"}


class Transfers:
    """A vehicle's side of the mission protocol.

    Attributes:
        stores: items by mission type.
        busy: whether uploads are refused for lack of space, as just after a boot.
        finished: called with the type of each upload and each cleared list.
        home: returns item 0 of a mission, which is ArduPilot's home; None: it is returned as uploaded.
    """

    def __init__(self, stores: Stores, send: Send, say: Say) -> None:
        self.stores = stores
        self.busy = False
        self.finished: Callable[[int], None] = lambda kind: None
        self.home: Callable[[], StoredItem] | None = None
        self._send, self._say = send, say

    def take(self, message: Message) -> None:
        """Answer a message of the protocol, and ignore others."""
        kind, peer = message.get_type(), (message.get_srcSystem(), message.get_srcComponent())
        if kind == "MISSION_COUNT":
            self._start(message, peer)
        elif kind in ("MISSION_ITEM_INT", "MISSION_ITEM"):
            self._receive(message, peer)
        elif kind == "MISSION_CLEAR_ALL":
            self._clear(message, peer)
        elif kind == "MISSION_ACK":
            self._end(message, peer)
        elif kind == "MISSION_REQUEST_LIST":
            self._list(message, peer)
        elif kind in ("MISSION_REQUEST_INT", "MISSION_REQUEST"):
            self._request(message, peer)

    def advance(self, now: float, timeout: float) -> None:
        """Repeat unanswered requests, and abort a transfer that times out, after `timeout` s at least."""
        raise NotImplementedError

    def _start(self, message: Message, peer: Address) -> None:
        raise NotImplementedError

    def _receive(self, message: Message, peer: Address) -> None:
        raise NotImplementedError

    def _clear(self, message: Message, peer: Address) -> None:
        raise NotImplementedError

    def _end(self, message: Message, peer: Address) -> None:
        """Accept that a transfer has ended."""

    def _list(self, message: Message, peer: Address) -> None:
        raise NotImplementedError

    def _request(self, message: Message, peer: Address) -> None:
        raise NotImplementedError

    def _acknowledge(self, peer: Address, result: int, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_ack_message(*peer, int(result), kind))

    def _ask(self, peer: Address, seq: int, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_request_int_message(*peer, seq, kind))

    def _count(self, peer: Address, kind: int) -> None:
        number = len(self.stores.get(kind, ()))
        self._send(mavlink.MAVLink_mission_count_message(*peer, number, kind))

    def _give(self, peer: Address, asked: Message) -> None:
        """Send a requested item, as MISSION_ITEM if it was requested so."""
        kind, seq = asked.mission_type, int(asked.seq)
        items = self.stores.get(kind, [])
        if not 0 <= seq < len(items):
            self._acknowledge(peer, mavlink.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        item = self.home() if seq == 0 and kind == MISSION and self.home is not None else items[seq]
        head = (*peer, seq, item.frame, item.command, 0, 1, *item.params)
        if asked.get_type() == "MISSION_REQUEST":
            self._send(
                mavlink.MAVLink_mission_item_message(*head, item.x * 1e-7, item.y * 1e-7, item.z, kind)
            )
        else:
            self._send(mavlink.MAVLink_mission_item_int_message(*head, item.x, item.y, item.z, kind))

    def _clear_stores(self, peer: Address, kind: int) -> None:
        for each in list(self.stores) if kind == mavlink.MAV_MISSION_TYPE_ALL else [kind]:
            self.stores[each] = []
            self.finished(each)
        self._acknowledge(peer, mavlink.MAV_MISSION_ACCEPTED, kind)


def item_of(message: Message) -> StoredItem:
    """Return the item in a MISSION_ITEM or MISSION_ITEM_INT."""
    old = message.get_type() == "MISSION_ITEM"
    x, y = (round(message.x * 1e7), round(message.y * 1e7)) if old else (message.x, message.y)
    params = (message.param1, message.param2, message.param3, message.param4)
    return StoredItem(message.frame, message.command, params, x, y, message.z)


@dataclass
class _Upload:
    """An upload: its number of items, its sender, and when an item was last requested and received."""

    expected: int
    peer: Address
    items: list[StoredItem] = field(default_factory=list)
    asked: float = -1.0
    since: float = -1.0


class ArduPilotTransfers(Transfers):
    """ArduPilot's side of the mission protocol, as its ``MissionItemProtocol.cpp`` has it.

    Each mission type has a transfer of its own. Missions and rally points are written item by item, so that
    an aborted upload leaves a mixture of old and new; fences are replaced as a whole. An item out of sequence
    is rejected, and the upload continues; its sender can restart it. Nothing is cleared or sent during an
    upload.
    """

    def __init__(self, stores: Stores, send: Send, say: Say, *, old: bool = False) -> None:
        """Create without a transfer; `old`: on a MAVLink 1 port, which accepts missions only."""
        super().__init__(stores, send, say)
        self._old = old
        self._uploads: dict[int, _Upload] = {}

    def take(self, message: Message) -> None:
        """Answer a message of the protocol, and ignore others."""
        ends = message.get_type() == "MISSION_ACK"
        if self._old and not ends and getattr(message, "mission_type", MISSION) != MISSION:
            self._say(mavlink.MAV_SEVERITY_WARNING, "Need mavlink2 for item transfer")
            peer = (message.get_srcSystem(), message.get_srcComponent())
            self._acknowledge(peer, mavlink.MAV_MISSION_UNSUPPORTED, message.mission_type)
        else:
            super().take(message)

    def advance(self, now: float, timeout: float) -> None:
        """Repeat unanswered requests, and abort a transfer that times out, after `timeout` s at least."""
        for kind, upload in list(self._uploads.items()):
            if upload.asked < 0.0:
                upload.asked = now
                upload.since = now if upload.since < 0.0 else upload.since
            if now - upload.since > max(TIMEOUT_SECONDS, 2.0 * timeout):
                del self._uploads[kind]
                self._say(mavlink.MAV_SEVERITY_WARNING, f"{NAMES[kind]} upload timeout")
                self._acknowledge(upload.peer, mavlink.MAV_MISSION_OPERATION_CANCELLED, kind)
            elif now - upload.asked > max(RETRY_SECONDS, timeout / 2.0):
                upload.asked = now
                self._ask(upload.peer, len(upload.items), kind)

    def _start(self, message: Message, peer: Address) -> None:
        kind = message.mission_type
        upload = self._uploads.get(kind)
        if self.busy:
            self._acknowledge(peer, mavlink.MAV_MISSION_NO_SPACE, kind)
        elif kind not in self.stores:
            self._acknowledge(peer, mavlink.MAV_MISSION_UNSUPPORTED, kind)
        elif upload is not None and upload.peer != peer:
            self._acknowledge(peer, mavlink.MAV_MISSION_DENIED, kind)
        else:
            self._uploads[kind] = upload = _Upload(message.count, peer)
            if kind != FENCE:
                self.stores[kind] = self.stores[kind][: upload.expected]
            self._continue(kind, upload)

    def _continue(self, kind: int, upload: _Upload) -> None:
        """Request the next item, or end the upload after the last."""
        if len(upload.items) < upload.expected:
            upload.asked = -1.0
            self._ask(upload.peer, len(upload.items), kind)
            return
        del self._uploads[kind]
        self.stores[kind] = list(upload.items)
        self._acknowledge(upload.peer, mavlink.MAV_MISSION_ACCEPTED, kind)
        self.finished(kind)

    def _receive(self, message: Message, peer: Address) -> None:
        kind, item = message.mission_type, item_of(message)
        upload = self._uploads.get(kind)
        if upload is None:
            self._acknowledge(peer, mavlink.MAV_MISSION_ERROR, kind)
        elif message.seq != len(upload.items):
            self._acknowledge(peer, mavlink.MAV_MISSION_INVALID_SEQUENCE, kind)
        elif peer != upload.peer:
            self._acknowledge(peer, mavlink.MAV_MISSION_DENIED, kind)
        elif fault := fault_of(item, kind):
            del self._uploads[kind]
            self._acknowledge(peer, fault, kind)
        else:
            stored = kept(item, kind, ARDUPILOT)
            if kind != FENCE:
                self.stores[kind][message.seq : message.seq + 1] = [stored]
            upload.items.append(stored)
            upload.since = -1.0
            self._continue(kind, upload)

    def _clear(self, message: Message, peer: Address) -> None:
        kind = message.mission_type
        receives = self._uploads if kind == mavlink.MAV_MISSION_TYPE_ALL else kind in self._uploads
        if self.busy:
            self._acknowledge(peer, mavlink.MAV_MISSION_NO_SPACE, kind)
        elif receives:
            self._acknowledge(peer, mavlink.MAV_MISSION_ERROR, kind)
        else:
            self._clear_stores(peer, kind)

    def _list(self, message: Message, peer: Address) -> None:
        if message.mission_type in self._uploads:
            self._acknowledge(peer, mavlink.MAV_MISSION_DENIED, message.mission_type)
        else:
            self._count(peer, message.mission_type)

    def _request(self, message: Message, peer: Address) -> None:
        if message.mission_type in self._uploads and message.get_type() == "MISSION_REQUEST_INT":
            self._acknowledge(peer, mavlink.MAV_MISSION_DENIED, message.mission_type)
        else:
            self._give(peer, message)
