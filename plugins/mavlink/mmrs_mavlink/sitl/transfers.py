"""ArduPilot's side of the mission protocol, as its ``MissionItemProtocol.cpp`` has it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import FENCE, MISSION, RALLY, Item, fault_of, kept
from mmrs_mavlink.sitl.settings import ARDUPILOT
from mmrs_mavlink.sitl.stored import Address, Message, Say, Stored, item_of, sender_of

ASK_AGAIN_SECONDS = 1.0
GIVE_UP_SECONDS = 8.0
NAMES = {MISSION: "Mission", FENCE: "Fence", RALLY: "Rally"}


@dataclass
class _Incoming:
    """A plan on its way: how many items it has, from whom it comes, when it was last asked for or came."""

    expected: int
    peer: Address
    items: list[Item] = field(default_factory=list)
    asked: float = -1.0
    since: float = -1.0


class MissionProtocol:
    """Answers the messages of the mission protocol; each kind of plan has transfers of its own.

    Missions and rally points are written item by item, so that a transfer that breaks off leaves some of
    the old and some of the new; fences are replaced as a whole. An item out of turn is answered, and the
    transfer goes on; whoever has begun it may begin it anew. While it lasts, nothing is cleared or given.

    Attributes:
        busy: whether uploads are refused for want of space, as just after a boot.
        finished: called with the type of what was uploaded or cleared.
        home: gives item 0 of the mission, which ArduPilot makes of its own home; None: as uploaded.
    """

    def __init__(
        self,
        stores: dict[int, list[Item]],
        send: Callable[[Message], None],
        say: Say,
        *,
        old: bool = False,
    ) -> None:
        """Keep what is uploaded in `stores`, by mission type, answer by `send`, and complain by `say`.

        Args:
            stores: items by mission type.
            send: sends a message.
            say: tells the ground something.
            old: whether the port speaks MAVLink 1, by which nothing but missions is taken.
        """
        self.busy = False
        self.finished: Callable[[int], None] = lambda kind: None
        self.home: Callable[[], Item] | None = None
        self._stored = Stored(stores, send)
        self._say, self._old = say, old
        self._incoming: dict[int, _Incoming] = {}

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        handler = _HANDLERS.get(message.get_type())
        if handler is None:
            return
        if self._old and message.mission_type != MISSION:
            self._say(mavlink.MAV_SEVERITY_WARNING, "Need mavlink2 for item transfer")
            self._answer(message, mavlink.MAV_MISSION_UNSUPPORTED)
        else:
            handler(self, message)

    def go_on(self, now: float, patience: float) -> None:
        """Ask again for what does not come, and give it up in the end.

        Args:
            now: seconds.
            patience: least seconds to wait.
        """
        for kind, coming in list(self._incoming.items()):
            if coming.asked < 0.0:
                coming.asked = now
                coming.since = now if coming.since < 0.0 else coming.since
            if now - coming.since > max(GIVE_UP_SECONDS, 2.0 * patience):
                del self._incoming[kind]
                self._say(mavlink.MAV_SEVERITY_WARNING, f"{NAMES[kind]} upload timeout")
                self._stored.acknowledge(coming.peer, mavlink.MAV_MISSION_OPERATION_CANCELLED, kind)
            elif now - coming.asked > max(ASK_AGAIN_SECONDS, patience / 2.0):
                coming.asked = now
                self._stored.ask(coming.peer, len(coming.items), kind)

    def _count(self, message: Message) -> None:
        kind, peer = message.mission_type, sender_of(message)
        coming = self._incoming.get(kind)
        if self.busy:
            self._answer(message, mavlink.MAV_MISSION_NO_SPACE)
        elif kind not in self._stored.stores:
            self._answer(message, mavlink.MAV_MISSION_UNSUPPORTED)
        elif coming is not None and coming.peer != peer:
            self._answer(message, mavlink.MAV_MISSION_DENIED)
        else:
            self._begin(kind, _Incoming(message.count, peer))

    def _begin(self, kind: int, coming: _Incoming) -> None:
        self._incoming[kind] = coming
        if kind != FENCE:
            self._stored.stores[kind] = self._stored.stores[kind][: coming.expected]
        self._go_on_with(kind, coming)

    def _go_on_with(self, kind: int, coming: _Incoming) -> None:
        """Ask for the next item, or end the transfer when there is none."""
        if len(coming.items) < coming.expected:
            coming.asked = -1.0
            self._stored.ask(coming.peer, len(coming.items), kind)
            return
        del self._incoming[kind]
        self._stored.stores[kind] = list(coming.items)
        self._stored.acknowledge(coming.peer, mavlink.MAV_MISSION_ACCEPTED, kind)
        self.finished(kind)

    def _item(self, message: Message) -> None:
        kind = message.mission_type
        coming = self._incoming.get(kind)
        if coming is None:
            self._answer(message, mavlink.MAV_MISSION_ERROR)
        elif message.seq != len(coming.items):
            self._answer(message, mavlink.MAV_MISSION_INVALID_SEQUENCE)
        elif sender_of(message) != coming.peer:
            self._answer(message, mavlink.MAV_MISSION_DENIED)
        elif fault := fault_of(item_of(message), kind):
            del self._incoming[kind]
            self._answer(message, fault)
        else:
            self._keep(kind, coming, kept(item_of(message), kind, ARDUPILOT))

    def _keep(self, kind: int, coming: _Incoming, item: Item) -> None:
        seq = len(coming.items)
        coming.items.append(item)
        coming.since = -1.0
        if kind != FENCE:
            self._stored.stores[kind][seq : seq + 1] = [item]
        self._go_on_with(kind, coming)

    def _clear(self, message: Message) -> None:
        everything = message.mission_type == mavlink.MAV_MISSION_TYPE_ALL
        kinds = list(self._stored.stores) if everything else [message.mission_type]
        if self.busy:
            self._answer(message, mavlink.MAV_MISSION_NO_SPACE)
        elif any(kind in self._incoming for kind in kinds):
            self._answer(message, mavlink.MAV_MISSION_ERROR)
        else:
            for kind in kinds:
                self._stored.stores[kind] = []
                self.finished(kind)
            self._answer(message, mavlink.MAV_MISSION_ACCEPTED)

    def _list(self, message: Message) -> None:
        if message.mission_type in self._incoming:
            self._answer(message, mavlink.MAV_MISSION_DENIED)
        else:
            self._stored.count(sender_of(message), message.mission_type)

    def _wanted(self, message: Message) -> None:
        if message.mission_type in self._incoming and message.get_type() == "MISSION_REQUEST_INT":
            self._answer(message, mavlink.MAV_MISSION_DENIED)
        else:
            self._stored.give(sender_of(message), message, self.home)

    def _answer(self, message: Message, result: int) -> None:
        self._stored.acknowledge(sender_of(message), result, message.mission_type)


_HANDLERS: Mapping[str, Callable[[MissionProtocol, Message], None]] = {
    "MISSION_COUNT": MissionProtocol._count,
    "MISSION_ITEM_INT": MissionProtocol._item,
    "MISSION_ITEM": MissionProtocol._item,
    "MISSION_CLEAR_ALL": MissionProtocol._clear,
    "MISSION_REQUEST_LIST": MissionProtocol._list,
    "MISSION_REQUEST_INT": MissionProtocol._wanted,
    "MISSION_REQUEST": MissionProtocol._wanted,
}
