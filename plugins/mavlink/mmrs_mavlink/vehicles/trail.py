"""A vehicle's track, position by position, also between two looks."""

from __future__ import annotations

from collections import deque

from ..links.link import Link, Message
from ..links.messages import tells_place
from ..program import Geographic, Local, Place


class Trail:
    """Where a vehicle has been since something began.

    Attributes:
        begun: where it was then.
    """

    def __init__(self, link: Link, kind: str, begun: Place, reports: deque[Message]) -> None:
        """Read what is collected.

        Args:
            link: to the vehicle.
            kind: of message with its position.
            begun: its present position.
            reports: gets such messages, in the order in which the vehicle has sent them.
        """
        self.begun = begun
        self._link = link
        self._kind = kind
        self._reports = reports

    def passed(self) -> list[Place]:
        """Return the positions since it was last asked, oldest first."""
        places = []
        while self._reports:
            message = self._reports.popleft()
            if tells_place(message):
                places.append(self._link.profile.level(place_in(message)))
        return places

    def place_order(self) -> int:
        """Return which of the vehicle's frames its last position was, by `Link.order`."""
        return self._link.order(self._kind)

    def item_order(self) -> int:
        """Return which of the vehicle's frames its last word of its item was."""
        return item_of(self._link)[1]


def item_of(link: Link) -> tuple[int, int]:
    """Return the mission item that a vehicle is at, -1 where it does not say, and which frame said so.

    A PX4 that goes to its next item sends MISSION_CURRENT at once over one of its links, and over the others
    within a second; but over each that it has reached the item before (``mavlink_mission.cpp``).
    """
    current, reached = (link.latest(kind) for kind in ("MISSION_CURRENT", "MISSION_ITEM_REACHED"))
    if current is None:
        return -1, -1
    order, newer = (link.order(kind) for kind in ("MISSION_CURRENT", "MISSION_ITEM_REACHED"))
    if reached is not None and reached.seq == current.seq and newer > order:
        return int(current.seq) + 1, newer
    return int(current.seq), order


def place_in(message: Message) -> Place:
    """Return the position in a GLOBAL_POSITION_INT or LOCAL_POSITION_NED."""
    if message.get_type() == "GLOBAL_POSITION_INT":
        return Geographic(message.lat * 1e-7, message.lon * 1e-7, message.relative_alt * 1e-3)
    return Local(message.x, message.y, -message.z)
