"""PX4's side of the mission protocol, as its ``mavlink_mission.cpp`` has it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import MISSION, Item, fault_of, kept
from mmrs_mavlink.sitl.settings import PX4
from mmrs_mavlink.sitl.stored import Address, Message, Say, Stored, item_of, sender_of

ASK_AGAIN_SECONDS = 0.25
GIVE_UP_SECONDS = 5.0
BUSY = "WPM: REJ. CMD: Busy"


class _State(Enum):
    IDLE = 0
    RECEIVING = 1
    GIVING = 2


class Px4MissionProtocol:
    """Answers the messages of the mission protocol: one transfer at a time, of whatever kind.

    Plans are replaced as a whole, when their last item has come. Items out of turn are passed over, and
    one that comes again after the end is taken for a doubled last one and accepted once more. Items are
    given in their order, each at most twice; any other request ends that.

    Attributes:
        busy: whether uploads are refused for want of space, as just after a boot.
        finished: called with the type of what was uploaded or cleared.
        home: is not used, PX4 gives missions as they were uploaded.
    """

    def __init__(self, stores: dict[int, list[Item]], send: Callable[[Message], None], say: Say) -> None:
        """Keep what is uploaded in `stores`, by mission type, answer by `send`, and complain by `say`."""
        self.busy = False
        self.finished: Callable[[int], None] = lambda kind: None
        self.home: Callable[[], Item] | None = None
        self._stored = Stored(stores, send)
        self._say = say
        self._state = _State.IDLE
        self._kind, self._peer = MISSION, (0, 0)
        self._items: list[Item] = []
        self._seq = self._expected = 0
        self._sent = self._heard = -1.0

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        handler = _HANDLERS.get(message.get_type())
        if handler is not None:
            handler(self, message, sender_of(message))

    def go_on(self, now: float, patience: float) -> None:
        """Ask again for what does not come, and give it up in the end.

        Args:
            now: seconds.
            patience: least seconds to wait.
        """
        if self._state is _State.IDLE:
            return
        self._sent = now if self._sent < 0.0 else self._sent
        self._heard = now if self._heard < 0.0 else self._heard
        if self._state is _State.RECEIVING and now - self._sent > max(ASK_AGAIN_SECONDS, patience / 2.0):
            self._ask()
        if now - self._heard > max(GIVE_UP_SECONDS, 2.0 * patience):
            self._complain("Operation timeout")
            self._state = _State.IDLE

    def _count(self, message: Message, peer: Address) -> None:
        kind = message.mission_type
        if self.busy:
            self._stored.acknowledge(peer, mavlink.MAV_MISSION_NO_SPACE, kind)
        elif self._state is _State.IDLE:
            self._begin(message, peer)
        elif self._state is _State.RECEIVING and peer == self._peer and self._seq == 0:
            self._heard = -1.0
            self._ask()
        else:
            self._heard = -1.0 if self._state is _State.RECEIVING else self._heard
            self._complain(BUSY)
            self._stored.acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)

    def _begin(self, message: Message, peer: Address) -> None:
        self._kind, self._peer = message.mission_type, peer
        if self._kind not in self._stored.stores:
            self._stored.acknowledge(peer, mavlink.MAV_MISSION_INVALID, self._kind)
        elif message.count == 0:
            self._replace([])
        else:
            self._state, self._seq, self._expected = _State.RECEIVING, 0, message.count
            self._items, self._heard = [], -1.0
            self._ask()

    def _item(self, message: Message, peer: Address) -> None:
        if peer != self._peer:
            self._complain("REJ. MIS ITEM: partner id mismatch")
        elif message.mission_type != self._kind or self._state is _State.GIVING:
            self._stored.acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)
        elif self._state is _State.IDLE:
            again = self._seq == message.seq + 1
            result = mavlink.MAV_MISSION_ACCEPTED if again else mavlink.MAV_MISSION_ERROR
            self._stored.acknowledge(peer, result, self._kind)
        else:
            self._heard = -1.0
            if message.seq == self._seq:
                self._keep(item_of(message))

    def _keep(self, item: Item) -> None:
        if fault := fault_of(item, self._kind, PX4):
            self._state = _State.IDLE
            self._stored.acknowledge(self._peer, fault, self._kind)
            return
        self._items.append(kept(item, self._kind, PX4))
        self._seq += 1
        if self._seq == self._expected:
            self._state = _State.IDLE
            self._replace(self._items)
        else:
            self._ask()

    def _replace(self, items: list[Item]) -> None:
        self._stored.stores[self._kind] = list(items)
        self._stored.acknowledge(self._peer, mavlink.MAV_MISSION_ACCEPTED, self._kind)
        self.finished(self._kind)

    def _clear(self, message: Message, peer: Address) -> None:
        if self._state is not _State.IDLE:
            self._complain("WPM: IGN CLEAR CMD: Busy")
            return
        self._kind = message.mission_type
        everything = self._kind == mavlink.MAV_MISSION_TYPE_ALL
        for kind in list(self._stored.stores) if everything else [self._kind]:
            self._stored.stores[kind] = []
            self.finished(kind)
        self._stored.acknowledge(peer, mavlink.MAV_MISSION_ACCEPTED, self._kind)

    def _end(self, message: Message, peer: Address) -> None:
        """Take the other's word that it is over."""
        cancelled = message.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
        given = self._state is _State.GIVING and message.mission_type == self._kind
        if peer == self._peer and (given or (self._state is _State.RECEIVING and cancelled)):
            self._state = _State.IDLE

    def _list(self, message: Message, peer: Address) -> None:
        if self._seq == len(self._stored.stores.get(self._kind, ())):
            self._state = _State.IDLE
        same = (message.mission_type, peer) == (self._kind, self._peer)
        if self._state is _State.IDLE or (self._state is _State.GIVING and same):
            self._state, self._seq, self._heard = _State.GIVING, 0, -1.0
            self._kind, self._peer = message.mission_type, peer
            self._stored.count(peer, self._kind)
        else:
            self._complain("Mission download request ignored, already active")

    def _wanted(self, message: Message, peer: Address) -> None:
        if peer != self._peer or self._state is _State.RECEIVING:
            self._complain(BUSY)
        elif self._state is _State.GIVING and message.mission_type == self._kind:
            self._heard = -1.0
            number = len(self._stored.stores.get(self._kind, ()))
            if message.seq not in (self._seq, self._seq - 1) or message.seq >= number:
                self._state = _State.IDLE
                self._stored.acknowledge(peer, mavlink.MAV_MISSION_ERROR, self._kind)
                return
            self._seq = message.seq + 1
            self._stored.give(peer, message, None)

    def _ask(self) -> None:
        self._sent = -1.0
        self._stored.ask(self._peer, self._seq, self._kind)

    def _complain(self, text: str) -> None:
        self._say(mavlink.MAV_SEVERITY_CRITICAL, text)


_HANDLERS: Mapping[str, Callable[[Px4MissionProtocol, Message, Address], None]] = {
    "MISSION_COUNT": Px4MissionProtocol._count,
    "MISSION_ITEM_INT": Px4MissionProtocol._item,
    "MISSION_ITEM": Px4MissionProtocol._item,
    "MISSION_CLEAR_ALL": Px4MissionProtocol._clear,
    "MISSION_ACK": Px4MissionProtocol._end,
    "MISSION_REQUEST_LIST": Px4MissionProtocol._list,
    "MISSION_REQUEST_INT": Px4MissionProtocol._wanted,
    "MISSION_REQUEST": Px4MissionProtocol._wanted,
}
