"""A simulated vehicle's side of the mission protocol: missions, fences and rally points by one mechanism."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import Autopilot
from mmrs_mavlink.sitl.items import FENCE, MISSION, RALLY, StoredItem, fault_of, kept

Message = Any
Address = tuple[int, int]
"""MAVLink system and component."""

ACCEPTED, ERROR = int(mavlink.MAV_MISSION_ACCEPTED), int(mavlink.MAV_MISSION_ERROR)
NO_SPACE, UNSUPPORTED = int(mavlink.MAV_MISSION_NO_SPACE), int(mavlink.MAV_MISSION_UNSUPPORTED)
INVALID_SEQUENCE, DENIED = int(mavlink.MAV_MISSION_INVALID_SEQUENCE), int(mavlink.MAV_MISSION_DENIED)
CANCELLED = int(mavlink.MAV_MISSION_OPERATION_CANCELLED)
NAMES = {MISSION: "Mission", FENCE: "Fence", RALLY: "Rally"}


@dataclass
class _Upload:
    """An upload: its number of items, its sender, and when an item was last requested and received."""

    expected: int
    peer: Address
    items: list[StoredItem] = field(default_factory=list)
    asked: float = -1.0
    since: float = -1.0


class Transfers:
    """A vehicle's side of the mission protocol.

    ArduPilot (``MissionItemProtocol.cpp``) has a transfer of each mission type. It writes missions and rally
    points item by item, so that an aborted upload leaves a mixture of old and new, and rejects an item out of
    sequence. PX4 (``mavlink_mission.cpp``) has one transfer at a time, replaces lists as a whole, and ignores
    items out of sequence.

    Attributes:
        stores: items by mission type.
        busy: whether uploads are refused for lack of space, as just after a boot.
        home: returns item 0 of a mission, which is ArduPilot's home; None: it is returned as uploaded.
    """

    def __init__(
        self,
        stores: dict[int, list[StoredItem]],
        send: Callable[[Message], None],
        say: Callable[[int, str], None],
        autopilot: Autopilot,
    ) -> None:
        self.stores = stores
        self.busy = False
        self.home: Callable[[], StoredItem] | None = None
        self._send, self._say, self._autopilot = send, say, autopilot
        self._px4 = autopilot.copies_bytes
        self._retry, self._timeout = (0.25, 5.0) if self._px4 else (1.0, 8.0)
        self._uploads: dict[int, _Upload] = {}
        self._last = (-1, -1)
        """Mission type and number of the last item of the last upload."""

    def take(self, message: Message) -> None:
        """Answer a message of the protocol, and ignore others."""
        handler = _HANDLERS.get(message.get_type())
        if handler is not None:
            peer, kind = (message.get_srcSystem(), message.get_srcComponent()), message.mission_type
            result = handler(self, message, peer, kind)
            if result is not None:
                self._acknowledge(peer, result, kind)

    def advance(self, now: float, timeout: float) -> None:
        """Repeat unanswered requests, and abort a transfer that times out, after `timeout` s at least."""
        for kind, upload in list(self._uploads.items()):
            upload.asked = now if upload.asked < 0.0 else upload.asked
            upload.since = now if upload.since < 0.0 else upload.since
            if now - upload.since > max(self._timeout, 2.0 * timeout):
                del self._uploads[kind]
                self._say(mavlink.MAV_SEVERITY_WARNING, f"{NAMES[kind]} upload timeout")
                if not self._px4:
                    self._acknowledge(upload.peer, CANCELLED, kind)
            elif now - upload.asked > max(self._retry, timeout / 2.0):
                upload.asked = now
                self._ask(upload, kind)

    def _start(self, message: Message, peer: Address, kind: int) -> int | None:
        begun = next(iter(self._uploads.values()), None) if self._px4 else self._uploads.get(kind)
        if self.busy:
            return NO_SPACE
        if kind not in self.stores:
            return UNSUPPORTED
        if begun is not None and (begun.peer != peer or (self._px4 and begun.items)):
            begun.since = -1.0
            return ERROR if self._px4 else DENIED
        self._uploads[kind] = upload = _Upload(message.count, peer)
        if not self._replaces_whole(kind):
            self.stores[kind] = self.stores[kind][: upload.expected]
        return self._continue(kind, upload)

    def _receive(self, message: Message, peer: Address, kind: int) -> int | None:
        upload = self._uploads.get(kind)
        if upload is None:
            return ACCEPTED if self._px4 and self._last == (kind, message.seq) else ERROR
        if message.seq != len(upload.items) or peer != upload.peer:
            if not self._px4:
                return INVALID_SEQUENCE
            upload.since = -1.0
            return None
        params = (message.param1, message.param2, message.param3, message.param4)
        item = StoredItem(message.frame, message.command, params, message.x, message.y, message.z)
        if fault := fault_of(item, kind, self._autopilot):
            del self._uploads[kind]
            return fault
        upload.items.append(kept(item, kind, self._autopilot))
        if not self._replaces_whole(kind):
            self.stores[kind][message.seq : message.seq + 1] = upload.items[-1:]
        upload.since = -1.0
        return self._continue(kind, upload)

    def _replaces_whole(self, kind: int) -> bool:
        return self._px4 or kind == FENCE

    def _continue(self, kind: int, upload: _Upload) -> int | None:
        """Request the next item, or end the upload after the last."""
        if len(upload.items) < upload.expected:
            upload.asked = -1.0
            self._ask(upload, kind)
            return None
        del self._uploads[kind]
        self._last = (kind, upload.expected - 1)
        self.stores[kind] = list(upload.items)
        return ACCEPTED

    def _clear(self, message: Message, peer: Address, kind: int) -> int:
        kinds = list(self.stores) if kind == mavlink.MAV_MISSION_TYPE_ALL else [kind]
        if self.busy:
            return NO_SPACE
        if any(each in self._uploads for each in kinds):
            return ERROR
        self.stores.update({each: [] for each in kinds})
        return ACCEPTED

    def _end(self, message: Message, peer: Address, kind: int) -> None:
        """Abort an upload that its sender cancels."""
        upload = self._uploads.get(kind)
        if self._px4 and message.type == CANCELLED and upload is not None and upload.peer == peer:
            del self._uploads[kind]

    def _list(self, message: Message, peer: Address, kind: int) -> None:
        number = len(self.stores.get(kind, ()))
        self._send(mavlink.MAVLink_mission_count_message(*peer, number, kind))

    def _give(self, message: Message, peer: Address, kind: int) -> int | None:
        """Send a requested item."""
        seq, items = int(message.seq), self.stores.get(kind, [])
        if not 0 <= seq < len(items):
            return INVALID_SEQUENCE
        item = self.home() if seq == 0 and kind == MISSION and self.home is not None else items[seq]
        head = (*peer, seq, item.frame, item.command, 0, 1, *item.params)
        self._send(mavlink.MAVLink_mission_item_int_message(*head, item.x, item.y, item.z, kind))
        return None

    def _ask(self, upload: _Upload, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_request_int_message(*upload.peer, len(upload.items), kind))

    def _acknowledge(self, peer: Address, result: int, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_ack_message(*peer, result, kind))


_HANDLERS: Mapping[str, Callable[[Transfers, Message, Address, int], int | None]] = {
    "MISSION_COUNT": Transfers._start,
    "MISSION_ITEM_INT": Transfers._receive,
    "MISSION_CLEAR_ALL": Transfers._clear,
    "MISSION_ACK": Transfers._end,
    "MISSION_REQUEST_LIST": Transfers._list,
    "MISSION_REQUEST_INT": Transfers._give,
}
"""Handlers of messages; they return the MAV_MISSION_RESULT with which these are acknowledged, if they are."""
