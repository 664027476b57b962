"""Messages to ground stations, over the link to a vehicle: as STATUSTEXT.

They are sent in the vehicle's own system, by the component of programs: ground stations show a
vehicle's system, and ignore the texts of other stations. Autopilots forward them to all
stations received. They are not acknowledged; on a link that loses frames they may be lost.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link, Message

CHUNK = 50
"""Bytes of a piece of a text."""

MOST_CHUNKS = 20
MORE = b" ..."
_ids = count(1)


def tell(link: Link, text: str) -> None:
    """Send a text in as many pieces as it needs; without waiting for anything."""
    for piece in pieces_of(text):
        link.speak(piece)


def pieces_of(text: str) -> Iterator[Message]:
    """Yield a text as STATUSTEXT; one that is too long for ground stations ends with dots.

    The last of several pieces is shorter than the others, by which stations recognise the last.
    """
    data = text.encode("ascii", "backslashreplace")
    if len(data) >= MOST_CHUNKS * CHUNK:
        data = data[: MOST_CHUNKS * CHUNK - len(MORE) - 1] + MORE
    if len(data) <= CHUNK:
        yield _piece(data, 0, 0)
        return
    number = next(_ids) % 65_535 + 1
    for seq, begin in enumerate(range(0, len(data) + 1, CHUNK)):
        yield _piece(data[begin : begin + CHUNK], number, seq)


def _piece(data: bytes, number: int, seq: int) -> Message:
    return mavlink.MAVLink_statustext_message(mavlink.MAV_SEVERITY_NOTICE, data, number, seq)
