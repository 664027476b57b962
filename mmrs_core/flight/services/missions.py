"""Missions, fences and rally points: upload, and reading back what the vehicle has kept."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..faults import Refused
from ..links.link import Link, Message
from .items import FENCE, MISSION, NAMES, NO_FRAME, RALLY, RELATIVE, Item
from .readback import alike

HEADER = 10


@dataclass
class _Transfer:
    """How an upload went: the vehicle's answer, whether it had begun to ask, and the id that it gave."""

    result: int | None = None
    begun: bool = False
    mark: int = 0


def upload(link: Link, items: Sequence[Item], kind: int = MISSION) -> int:
    """Replace what the vehicle has of that kind; an empty list clears it.

    A vehicle that has just started, or is busy, refuses; it is asked again after a second. When it
    refuses for good in the middle, what it has by then is cleared: nobody should fly half of it.

    Returns:
        The id that the vehicle gave to what it has now; 0 where it gives none.

    Raises:
        Refused: the vehicle does not accept it, or does not answer; it says what the vehicle has now.
    """
    transfer = _Transfer()
    try:
        for attempt in range(link.retries.tries):
            transfer.result = _clear(link, kind) if not items else _transfer(link, items, kind, transfer)
            if transfer.result == mavlink.MAV_MISSION_ACCEPTED:
                return transfer.mark
            if attempt + 1 < link.retries.tries:
                link.wait(lambda: None, 1.0)
    except BaseException:
        _break_off(link, kind, transfer)
        raise
    answer = "nothing" if transfer.result is None else f"'{_result(transfer.result)}'"
    left = _clean_up(link, kind, transfer)
    raise Refused(f"{NAMES[kind]}: the vehicle answers {answer} to the upload; {left}")


def download(link: Link, kind: int = MISSION) -> tuple[Item, ...]:
    """Return what the vehicle has of that kind.

    Raises:
        Refused: the vehicle does not answer.
    """
    with link.inbox("MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK") as inbox:
        ask = mavlink.MAVLink_mission_request_list_message(link.system, link.component, kind)
        count = _asked(
            link,
            ask,
            inbox,
            lambda m: m.get_type() == "MISSION_COUNT" and _of(m, kind),
            link.retries.answer,
        )
        items = tuple(_fetch(link, inbox, seq, kind) for seq in range(count.count))
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return items


def verify(link: Link, items: Sequence[Item], kind: int = MISSION) -> None:
    """Read back what was uploaded; the home item of an ArduPilot's mission is its own and not compared.

    Heights of fences are not compared either: they have none, and ArduPilot gives them back as 0
    above sea level.

    Raises:
        Refused: the vehicle has kept something else.
    """
    beat = link.latest("HEARTBEAT")
    autopilot = beat.autopilot if beat is not None else mavlink.MAV_AUTOPILOT_GENERIC
    own_home = kind == MISSION and autopilot != mavlink.MAV_AUTOPILOT_PX4
    kept = download(link, kind)
    if len(kept) != len(items) and (items or len(kept) > own_home):
        raise Refused(f"{NAMES[kind]}: the vehicle has {len(kept)} items instead of {len(items)}")
    for seq, (wanted, found) in enumerate(zip(items, kept, strict=False)):
        if not (seq == 0 and own_home) and not alike(wanted, found, kind, autopilot):
            raise Refused(f"{NAMES[kind]}: item {seq} is {found} on the vehicle instead of {wanted}")


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


def _transfer(link: Link, items: Sequence[Item], kind: int, transfer: _Transfer) -> int | None:
    count = mavlink.MAVLink_mission_count_message(link.system, link.component, len(items), kind)
    kinds = ("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK")
    with link.inbox(*kinds) as inbox:
        last: Message = count
        attempts = link.attempts()
        while (tries := next(attempts, None)) is not None:
            link.send(last)
            message = link.wait(lambda: _first(inbox, lambda m: _of(m, kind)), link.patience)
            while message is not None and tries and _repeated(message):
                # The vehicle had the item already and was only waiting for the next.
                message = link.wait(lambda: _first(inbox, lambda m: _of(m, kind)), link.patience)
            if message is None:
                continue
            if message.get_type() == "MISSION_ACK":
                transfer.mark = mark_of(message, 4)
                return int(message.type)
            if not 0 <= message.seq < len(items):
                return int(mavlink.MAV_MISSION_INVALID_SEQUENCE)
            transfer.begun = True
            last, attempts = _message(link, message.seq, items[message.seq], kind), link.attempts()
    return None


def _repeated(message: Message) -> bool:
    return bool(message.get_type() == "MISSION_ACK" and message.type == mavlink.MAV_MISSION_INVALID_SEQUENCE)


def _clean_up(link: Link, kind: int, transfer: _Transfer) -> str:
    """Clear what a vehicle has of a plan of which it took only a part; return what it has now."""
    if not transfer.begun:
        return "it keeps what it had"
    # No answer to this either is told as what it is: nobody knows what is left.
    with suppress(Refused):
        if _clear(link, kind) == mavlink.MAV_MISSION_ACCEPTED:
            return "it has none now"
    return "what it has now is not known"


def _break_off(link: Link, kind: int, transfer: _Transfer) -> None:
    """Have the vehicle end a transfer, without waiting for an answer: something else is wrong."""
    if transfer.begun:
        cancelled = mavlink.MAV_MISSION_OPERATION_CANCELLED
        link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, cancelled, kind))
        link.send(mavlink.MAVLink_mission_clear_all_message(link.system, link.component, kind))


def _clear(link: Link, kind: int) -> int:
    with link.inbox("MISSION_ACK") as inbox:
        ask = mavlink.MAVLink_mission_clear_all_message(link.system, link.component, kind)
        return int(_asked(link, ask, inbox, lambda m: _of(m, kind), link.retries.answer).type)


def _fetch(link: Link, inbox: deque[Message], seq: int, kind: int) -> Item:
    ask = mavlink.MAVLink_mission_request_int_message(link.system, link.component, seq, kind)
    wanted = _asked(
        link,
        ask,
        inbox,
        lambda m: m.get_type() == "MISSION_ITEM_INT" and m.seq == seq and _of(m, kind),
        link.retries.item,
    )
    params = (wanted.param1, wanted.param2, wanted.param3, wanted.param4)
    return Item(wanted.command, params, wanted.x, wanted.y, wanted.z, wanted.frame)


def _asked(
    link: Link, ask: Message, inbox: deque[Message], fits: Callable[[Message], bool], seconds: float
) -> Message:
    for _ in link.attempts():
        link.send(ask)
        answer = link.wait(lambda: _first(inbox, fits), link.clock.patience(seconds, seconds))
        if answer is not None:
            return answer
    raise Refused(f"{ask.get_type()}: the vehicle does not answer")


def _first(inbox: deque[Message], fits: Callable[[Message], bool]) -> Message | None:
    while inbox:
        message = inbox.popleft()
        if fits(message):
            return message
    return None


def _of(message: Message, kind: int) -> bool:
    return bool(message.mission_type == kind)


def _message(link: Link, seq: int, item: Item, kind: int) -> Message:
    return mavlink.MAVLink_mission_item_int_message(
        link.system,
        link.component,
        seq,
        item.frame,
        item.command,
        0,
        1,
        *item.params,
        item.x,
        item.y,
        item.z,
        kind,
    )


def _result(number: int) -> str:
    entry = mavlink.enums["MAV_MISSION_RESULT"].get(number)
    name = str(entry.name) if entry is not None else f"result {number}"
    return name.removeprefix("MAV_MISSION_").lower().replace("_", " ")


__all__ = [
    "FENCE",
    "MISSION",
    "NAMES",
    "NO_FRAME",
    "RALLY",
    "RELATIVE",
    "Item",
    "download",
    "mark_of",
    "upload",
    "verify",
]
