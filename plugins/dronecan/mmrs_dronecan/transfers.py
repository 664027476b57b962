"""Messages of DroneCAN to frames and back: tail byte, toggle, transfer CRC, by the package ``dronecan``."""

from __future__ import annotations

from collections import Counter
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
