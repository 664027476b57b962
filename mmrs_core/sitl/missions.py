"""The vehicle's side of the mission protocol: receiving and giving back missions, fences, rally points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any

POSITIONAL_FRAMES = {0, 3, 5, 6, 10, 11}
_POSITIONAL = {16, 17, 18, 19, 21, 22, 5001, 5002, 5003, 5004, 5100}
_KNOWN = _POSITIONAL | {
    20,
    93,
    112,
    115,
    177,
    178,
    181,
    182,
    183,
    195,
    197,
    203,
    206,
    207,
    211,
    1000,
    2000,
    2001,
    2500,
    2501,
}


@dataclass(frozen=True, slots=True)
class Item:
    """An item as received."""

    frame: int
    command: int
    params: tuple[float, float, float, float]
    x: int
    y: int
    z: float


def fault_of(item: Item) -> int:
    """Return why an item is refused, as a MAV_MISSION_RESULT; 0 if it is not."""
    if item.command not in _KNOWN:
        return int(mavlink.MAV_MISSION_UNSUPPORTED)
    if item.command in _POSITIONAL and item.frame not in POSITIONAL_FRAMES:
        return int(mavlink.MAV_MISSION_UNSUPPORTED_FRAME)
    if any(value != value for value in item.params[:3]):
        return int(mavlink.MAV_MISSION_INVALID_PARAM1)
    return 0


class MissionProtocol:
    """Answers the messages of the mission protocol, one transfer at a time.

    Attributes:
        busy: whether uploads are refused for want of space, as just after a boot.
    """

    def __init__(self, stores: dict[int, list[Item]], send: Callable[[Message], None]) -> None:
        """Keep what is uploaded in `stores`, by mission type, and answer by `send`."""
        self.busy = False
        self._stores = stores
        self._send = send
        self._incoming: list[Item] = []
        self._expected = 0
        self._kind = 0
        self._peer = (0, 0)

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        handler = _HANDLERS.get(message.get_type())
        if handler is not None:
            self._peer = (message.get_srcSystem(), message.get_srcComponent())
            handler(self, message)

    def _count(self, message: Message) -> None:
        if self.busy:
            self._acknowledge(mavlink.MAV_MISSION_NO_SPACE, message.mission_type)
            return
        self._incoming, self._expected, self._kind = [], message.count, message.mission_type
        if message.count == 0:
            self._finish()
        else:
            self._request(0)

    def _item(self, message: Message) -> None:
        if message.mission_type != self._kind:
            return
        if message.seq != len(self._incoming) or not self._expected:
            self._repeat(message.seq)
            return
        params = (message.param1, message.param2, message.param3, message.param4)
        item = Item(message.frame, message.command, params, message.x, message.y, message.z)
        fault = fault_of(item)
        if fault:
            self._expected = 0
            self._acknowledge(fault, self._kind)
            return
        self._incoming.append(item)
        if len(self._incoming) == self._expected:
            self._finish()
        else:
            self._request(len(self._incoming))

    def _repeat(self, seq: int) -> None:
        """Answer again what the ground station has missed, when it sends an item for the second time."""
        if seq == len(self._incoming) - 1 and self._expected:
            self._request(len(self._incoming))
        elif seq == len(self._incoming) - 1:
            self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, self._kind)

    def _finish(self) -> None:
        self._stores[self._kind] = self._incoming
        self._expected = 0
        self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, self._kind)

    def _clear(self, message: Message) -> None:
        if self.busy:
            self._acknowledge(mavlink.MAV_MISSION_NO_SPACE, message.mission_type)
            return
        self._stores[message.mission_type] = []
        self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, message.mission_type)

    def _list(self, message: Message) -> None:
        count = len(self._stores[message.mission_type])
        self._send(mavlink.MAVLink_mission_count_message(*self._peer, count, message.mission_type))

    def _wanted(self, message: Message) -> None:
        items = self._stores[message.mission_type]
        if not 0 <= message.seq < len(items):
            self._acknowledge(mavlink.MAV_MISSION_INVALID_SEQUENCE, message.mission_type)
            return
        item = items[message.seq]
        self._send(
            mavlink.MAVLink_mission_item_int_message(
                *self._peer,
                message.seq,
                item.frame,
                item.command,
                0,
                1,
                *item.params,
                item.x,
                item.y,
                item.z,
                message.mission_type,
            )
        )

    def _request(self, seq: int) -> None:
        self._send(mavlink.MAVLink_mission_request_int_message(*self._peer, seq, self._kind))

    def _acknowledge(self, result: int, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_ack_message(*self._peer, result, kind))


_HANDLERS: dict[str, Callable[[MissionProtocol, Message], None]] = {
    "MISSION_COUNT": MissionProtocol._count,
    "MISSION_ITEM_INT": MissionProtocol._item,
    "MISSION_CLEAR_ALL": MissionProtocol._clear,
    "MISSION_REQUEST_LIST": MissionProtocol._list,
    "MISSION_REQUEST_INT": MissionProtocol._wanted,
}
