"""Who else is on the bus, as far as it concerns who commands the drives."""

from __future__ import annotations

import logging
from collections import Counter, deque

import dronecan

from auv_vessel.wire.frame import Frame
from mmrs_dronecan.transfers import Incoming

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
        """Know nobody yet; `node` is the own identifier."""
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
