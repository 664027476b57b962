"""What exchanges of the mission protocol have in common: whose an answer is, and what it says."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Message
from .items import MISSION, NAMES

HEADER = 10

OLD_PORT = (
    "speaks MAVLink 1 on this port, which carries nothing but missions: have it speak MAVLink 2"
    " (ArduPilot: SERIALn_PROTOCOL 2, PX4: MAV_PROTO_VER 2)"
)


def is_old(message: Message) -> bool:
    """Return whether a message came as MAVLink 1, which has no kinds of plans: all are missions there."""
    frame = message.get_msgbuf()
    return bool(frame) and int(frame[0]) == mavlink.PROTOCOL_MARKER_V1


def concerns(message: Message, kind: int) -> bool:
    """Return whether a message is about that kind of plan, as far as it can tell."""
    return is_old(message) or bool(message.mission_type == kind)


def lacks_kinds(message: Message, kind: int) -> bool:
    """Return whether an answer says that the port is too old for that kind of plan."""
    unsupported = message.get_type() == "MISSION_ACK" and message.type == mavlink.MAV_MISSION_UNSUPPORTED
    return unsupported and kind != MISSION and is_old(message)


def old_port(kind: int) -> RefusedError:
    """Return the message where the port's protocol is too old for that kind of plan."""
    return RefusedError(f"{NAMES[kind]}: the vehicle {OLD_PORT}; it keeps what it had")


def first(inbox: deque[Message], fits: Callable[[Message], bool]) -> Message | None:
    """Take messages out of an inbox up to the first that fits, and return that."""
    while inbox:
        message = inbox.popleft()
        if fits(message):
            return message
    return None


def mark_of(message: Message, before: int) -> int:
    """Return the id of a plan at the end of a message, which pymavlink does not know; 0 if there is none.

    Args:
        message: as received.
        before: bytes of the fields before it.
    """
    frame = bytes(message.get_msgbuf())
    if len(frame) <= HEADER or frame[0] != mavlink.PROTOCOL_MARKER_V2:
        return 0
    payload = frame[HEADER : HEADER + frame[1]]
    return int.from_bytes(payload[before : before + 4], "little")


def words_of(result: int) -> str:
    """Return a MAV_MISSION_RESULT in words."""
    entry = mavlink.enums["MAV_MISSION_RESULT"].get(result)
    name = str(entry.name) if entry is not None else f"result {result}"
    return name.removeprefix("MAV_MISSION_").lower().replace("_", " ")
