"""Messages of DroneCAN to frames and back: tail byte, toggle, transfer CRC, by the package ``dronecan``."""

from __future__ import annotations

import logging
from collections import Counter, deque
from typing import Any

import dronecan
from dronecan.transport import Frame as Part
from dronecan.transport import Transfer

from auv_vessel.wire.frame import Frame

_LONGEST = 64
"""Frames of a message at most; ours have up to six."""


class Outgoing:
    """Says messages as one node, with a transfer identifier of its own for each type."""

    def __init__(self, node: int, priority: int = 8) -> None:
        self._node = node
        self._priority = priority
        self._next: Counter[str] = Counter()

    def frames(self, message: Any) -> list[Frame]:
        """Return a message as frames, in the order in which they are to be sent."""
        name = dronecan.get_dronecan_data_type(message).full_name
        transfer = Transfer(
            transfer_id=self._next[name] % 32,
            source_node_id=self._node,
            payload=message,
            transfer_priority=self._priority,
        )
        self._next[name] += 1
        return [Frame(part.message_id, bytes(part.bytes), extended=True) for part in transfer.to_frames()]


class Incoming:
    """Puts frames of one message type together, for each node that says it.

    Attributes:
        faults: frames and messages that cannot be believed.
    """

    def __init__(self, type_id: int) -> None:
        self.faults = 0
        self._type_id = type_id
        self._parts: dict[int, list[Part]] = {}

    def message(self, frame: Frame) -> Any | None:
        """Return the message that a frame completes, or None."""
        if (
            not frame.extended
            or frame.id >> 8 & 0xFFFF != self._type_id
            or frame.id & 0x80
            or not frame.id & 0x7F
        ):
            return None
        if not frame.data:
            self.faults += 1
            return None
        part = Part(frame.id, frame.data)
        parts = self._parts.setdefault(frame.id & 0x7F, [])
        if part.start_of_transfer:
            self.faults += bool(parts)
            parts.clear()
        if not self._follows(parts, part):
            self.faults += 1
            parts.clear()
            return None
        parts.append(part)
        if not part.end_of_transfer:
            return None
        found = self._put_together(parts)
        parts.clear()
        return found

    def _follows(self, parts: list[Part], part: Part) -> bool:
        """Return whether a frame is the next of a message, or begins one."""
        if part.start_of_transfer:
            return not part.toggle
        if not parts or len(parts) >= _LONGEST:
            return False
        last = parts[-1]
        return part.transfer_key == last.transfer_key and part.toggle != last.toggle and len(last.bytes) == 8

    def _put_together(self, parts: list[Part]) -> Any | None:
        transfer = Transfer()
        try:
            transfer.from_frames(parts)
        except Exception:
            self.faults += 1
            return None
        return transfer.payload


COMMANDS = (1030, 1031)
"""Types of messages that command drives: RawCommand and RPMCommand."""

NODE_STATUS = 341
BELIEVED = 3
"""Frames that make another commander believed, and turns of two nodes that say one drive's status."""

_ILL = dronecan.uavcan.protocol.NodeStatus().HEALTH_CRITICAL
_OFFLINE = dronecan.uavcan.protocol.NodeStatus().MODE_OFFLINE
_SAID = logging.getLogger("mmrs_dronecan")


class Company:
    """The other nodes.

    Attributes:
        rival: whether another node has the own one's identifier, or commands drives as well.
        ill: identifiers of nodes that say that they cannot work.
    """

    def __init__(self, node: int) -> None:
        """Start with no other node known; `node` is the own identifier."""
        self.rival = False
        self.ill: set[int] = set()
        self._node = node
        self._strange: Counter[str] = Counter()
        self._health = Incoming(NODE_STATUS)
        self._by_drive: dict[int, deque[int]] = {}
        self._shared: set[int] = set()

    def notice(self, frame: Frame) -> None:
        """Look at a frame of another node."""
        if not frame.extended or not frame.id & 0x7F:
            return
        node, service = frame.id & 0x7F, bool(frame.id & 0x80)
        if node == self._node:
            self._note(f"another node has the identifier {node} of this one")
        elif not service and frame.id >> 8 & 0xFFFF in COMMANDS:
            self._note(f"node {node} commands the drives, too")
        elif (said := self._health.message(frame)) is not None:
            well = said.health != _ILL and said.mode != _OFFLINE
            (self.ill.discard if well else self.ill.add)(node)

    def shares(self, drive: int, node: int) -> bool:
        """Take that a node said a drive's status; return whether another one does, too."""
        nodes = self._by_drive.setdefault(drive, deque(maxlen=BELIEVED + 1))
        nodes.append(node)
        turns = sum(one != other for one, other in zip(nodes, list(nodes)[1:], strict=False))
        if turns >= BELIEVED and drive not in self._shared:
            self._shared.add(drive)
            _SAID.warning("drive %d is said by nodes %s: it is not used", drive, sorted(set(nodes)))
        return drive in self._shared

    def _note(self, what: str) -> None:
        self._strange[what] += 1
        if self._strange[what] >= BELIEVED and not self.rival:
            self.rival = True
            _SAID.warning("%s: no thrust any more", what)
