"""The vehicle's side of the mission protocol: receiving and giving back missions, fences, rally points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.sitl.items import FENCE, MISSION, RALLY, Item, fault_of, kept
from mmrs_core.sitl.settings import ARDUPILOT, PX4

Message = Any

ASK_AGAIN_SECONDS = 1.0
GIVE_UP_SECONDS = 8.0
NAMES = {MISSION: "Mission", FENCE: "Fence", RALLY: "Rally"}


class MissionProtocol:
    """Answers the messages of the mission protocol, one transfer at a time.

    ArduPilot writes missions and rally points item by item, so that a transfer that breaks off leaves
    some of the old and some of the new; fences, and everything on PX4, are replaced as a whole.

    Attributes:
        busy: whether uploads are refused for want of space, as just after a boot.
        finished: called with the type of what was uploaded or cleared.
        home: gives item 0 of the mission, which ArduPilot makes of its own home; None: as uploaded.
    """

    def __init__(
        self,
        stores: dict[int, list[Item]],
        send: Callable[[Message], None],
        firmware: str = ARDUPILOT,
        say: Callable[[int, str], None] = lambda severity, text: None,
    ) -> None:
        """Keep what is uploaded in `stores`, by mission type, answer by `send`, and complain by `say`."""
        self.busy = False
        self.finished: Callable[[int], None] = lambda kind: None
        self.home: Callable[[], Item] | None = None
        self._stores = stores
        self._send = send
        self._firmware = firmware
        self._say = say
        self._incoming: list[Item] = []
        self._expected = 0
        self._kind = MISSION
        self._peer = (0, 0)
        self._asked = self._since = 0.0

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        handler = _HANDLERS.get(message.get_type())
        if handler is not None:
            self._peer = (message.get_srcSystem(), message.get_srcComponent())
            handler(self, message)

    def go_on(self, now: float, patience: float) -> None:
        """Ask again for what does not come, and give it up in the end.

        Args:
            now: seconds.
            patience: least seconds to wait.
        """
        if not self._expected or self._asked < 0.0:
            self._asked = self._since = now
        elif now - self._since > max(GIVE_UP_SECONDS, patience):
            self._expected = 0
            self._say(mavlink.MAV_SEVERITY_WARNING, f"{NAMES[self._kind]} upload timeout")
            self._acknowledge(mavlink.MAV_MISSION_OPERATION_CANCELLED, self._kind)
        elif now - self._asked > max(ASK_AGAIN_SECONDS, patience / 2.0):
            self._asked = now
            self._request(len(self._incoming))

    def _count(self, message: Message) -> None:
        if self.busy:
            self._acknowledge(mavlink.MAV_MISSION_NO_SPACE, message.mission_type)
            return
        if message.mission_type not in self._stores:
            self._acknowledge(mavlink.MAV_MISSION_UNSUPPORTED, message.mission_type)
            return
        self._incoming, self._expected, self._kind = [], message.count, message.mission_type
        if self._writes_through():
            self._stores[self._kind] = self._stores[self._kind][: message.count]
        if message.count == 0:
            self._finish()
        else:
            self._ask()

    def _item(self, message: Message) -> None:
        params = (message.param1, message.param2, message.param3, message.param4)
        self._keep(message, Item(message.frame, message.command, params, message.x, message.y, message.z))

    def _old_item(self, message: Message) -> None:
        params = (message.param1, message.param2, message.param3, message.param4)
        x, y = round(message.x * 1e7), round(message.y * 1e7)
        self._keep(message, Item(message.frame, message.command, params, x, y, message.z))

    def _keep(self, message: Message, item: Item) -> None:
        if message.mission_type != self._kind:
            return
        if message.seq != len(self._incoming) or not self._expected:
            self._repeat(message.seq)
            return
        fault = fault_of(item, self._kind, self._firmware)
        if fault:
            self._expected = 0
            self._acknowledge(fault, self._kind)
            return
        self._incoming.append(kept(item, self._kind, self._firmware))
        if self._writes_through():
            self._stores[self._kind][message.seq : message.seq + 1] = [self._incoming[-1]]
        if len(self._incoming) == self._expected:
            self._finish()
        else:
            self._ask()

    def _writes_through(self) -> bool:
        return self._firmware != PX4 and self._kind != FENCE

    def _repeat(self, seq: int) -> None:
        """Answer again what the ground station has missed, when it sends an item for the second time."""
        if seq == len(self._incoming) - 1 and self._expected:
            self._request(len(self._incoming))
        elif seq == len(self._incoming) - 1:
            self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, self._kind)

    def _finish(self) -> None:
        self._stores[self._kind] = list(self._incoming)
        self._expected = 0
        self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, self._kind)
        self.finished(self._kind)

    def _clear(self, message: Message) -> None:
        if self.busy:
            self._acknowledge(mavlink.MAV_MISSION_NO_SPACE, message.mission_type)
            return
        everything = message.mission_type == mavlink.MAV_MISSION_TYPE_ALL
        for kind in list(self._stores) if everything else [message.mission_type]:
            self._stores[kind] = []
            self.finished(kind)
        self._acknowledge(mavlink.MAV_MISSION_ACCEPTED, message.mission_type)

    def _list(self, message: Message) -> None:
        count = len(self._stores.get(message.mission_type, ()))
        self._send(mavlink.MAVLink_mission_count_message(*self._peer, count, message.mission_type))

    def _wanted(self, message: Message) -> None:
        item = self._stored(message)
        if item is not None:
            self._give(mavlink.MAVLink_mission_item_int_message, message, item, item.x, item.y)

    def _wanted_by_old(self, message: Message) -> None:
        item = self._stored(message)
        if item is not None:
            self._give(mavlink.MAVLink_mission_item_message, message, item, item.x * 1e-7, item.y * 1e-7)

    def _stored(self, message: Message) -> Item | None:
        items: list[Item] = self._stores.get(message.mission_type, [])
        seq = int(message.seq)
        if seq == 0 and items and message.mission_type == MISSION and self.home is not None:
            return self.home()
        if 0 <= seq < len(items):
            return items[seq]
        self._acknowledge(mavlink.MAV_MISSION_INVALID_SEQUENCE, message.mission_type)
        return None

    def _give(self, kind: Callable[..., Message], asked: Message, item: Item, x: float, y: float) -> None:
        place = (x, y, item.z, asked.mission_type)
        head = (*self._peer, asked.seq, item.frame, item.command, 0, 1)
        self._send(kind(*head, *item.params, *place))

    def _ask(self) -> None:
        self._asked = -1.0
        self._request(len(self._incoming))

    def _request(self, seq: int) -> None:
        self._send(mavlink.MAVLink_mission_request_int_message(*self._peer, seq, self._kind))

    def _acknowledge(self, result: int, kind: int) -> None:
        self._send(mavlink.MAVLink_mission_ack_message(*self._peer, result, kind))


_HANDLERS: Mapping[str, Callable[[MissionProtocol, Message], None]] = {
    "MISSION_COUNT": MissionProtocol._count,
    "MISSION_ITEM_INT": MissionProtocol._item,
    "MISSION_ITEM": MissionProtocol._old_item,
    "MISSION_CLEAR_ALL": MissionProtocol._clear,
    "MISSION_REQUEST_LIST": MissionProtocol._list,
    "MISSION_REQUEST_INT": MissionProtocol._wanted,
    "MISSION_REQUEST": MissionProtocol._wanted_by_old,
}
