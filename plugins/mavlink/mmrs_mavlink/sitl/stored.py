"""What both firmwares do alike with missions, fences and rally points: check, keep, and give them back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import MISSION, Item

Message = Any
Address = tuple[int, int]
"""MAVLink system and component."""

Say = Callable[[int, str], None]
"""Tells the ground something, with a MAV_SEVERITY."""


class Transfers(Protocol):
    """A firmware's side of the mission protocol.

    Attributes:
        busy: whether uploads are refused for want of space, as just after a boot.
        finished: called with the type of what was uploaded or cleared.
        home: gives item 0 of the mission, which ArduPilot makes of its own home; None: as uploaded.
    """

    busy: bool
    finished: Callable[[int], None]
    home: Callable[[], Item] | None

    def take(self, message: Message) -> None:
        """Answer a message, if it is one of the protocol."""
        ...

    def go_on(self, now: float, patience: float) -> None:
        """Ask again for what does not come, and give it up in the end.

        Args:
            now: seconds.
            patience: least seconds to wait.
        """
        ...


class Stored:
    """Plans by mission type, and the answers about them."""

    def __init__(self, stores: dict[int, list[Item]], send: Callable[[Message], None]) -> None:
        """Keep plans in `stores`, and answer by `send`."""
        self.stores = stores
        self.send = send

    def acknowledge(self, peer: Address, result: int, kind: int) -> None:
        """Tell somebody how it went."""
        self.send(mavlink.MAVLink_mission_ack_message(*peer, int(result), kind))

    def ask(self, peer: Address, seq: int, kind: int) -> None:
        """Ask somebody for an item."""
        self.send(mavlink.MAVLink_mission_request_int_message(*peer, seq, kind))

    def count(self, peer: Address, kind: int) -> None:
        """Tell somebody how many items there are."""
        number = len(self.stores.get(kind, ()))
        self.send(mavlink.MAVLink_mission_count_message(*peer, number, kind))

    def give(self, peer: Address, asked: Message, home: Callable[[], Item] | None) -> None:
        """Give somebody the item that was asked for, in the form in which it was asked for."""
        items, seq = self.stores.get(asked.mission_type, []), int(asked.seq)
        if not 0 <= seq < len(items):
            self.acknowledge(peer, mavlink.MAV_MISSION_INVALID_SEQUENCE, asked.mission_type)
            return
        item = home() if seq == 0 and asked.mission_type == MISSION and home is not None else items[seq]
        head = (*peer, seq, item.frame, item.command, 0, 1, *item.params)
        if asked.get_type() == "MISSION_REQUEST":
            place = (item.x * 1e-7, item.y * 1e-7, item.z, asked.mission_type)
            self.send(mavlink.MAVLink_mission_item_message(*head, *place))
        else:
            self.send(
                mavlink.MAVLink_mission_item_int_message(*head, item.x, item.y, item.z, asked.mission_type)
            )


def item_of(message: Message) -> Item:
    """Return the item that a MISSION_ITEM or a MISSION_ITEM_INT holds."""
    old = message.get_type() == "MISSION_ITEM"
    x, y = (round(message.x * 1e7), round(message.y * 1e7)) if old else (message.x, message.y)
    params = (message.param1, message.param2, message.param3, message.param4)
    return Item(message.frame, message.command, params, x, y, message.z)


def sender_of(message: Message) -> Address:
    """Return who has sent a message."""
    return (message.get_srcSystem(), message.get_srcComponent())
