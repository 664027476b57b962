"""Missions, fences and rally points: upload, and reading back what the vehicle has kept."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .faults import Refused
from .link import Link, Message

MISSION = mavlink.MAV_MISSION_TYPE_MISSION
FENCE = mavlink.MAV_MISSION_TYPE_FENCE
RALLY = mavlink.MAV_MISSION_TYPE_RALLY
NAMES = {MISSION: "mission", FENCE: "fence", RALLY: "rally points"}

RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
NO_FRAME = mavlink.MAV_FRAME_MISSION
ANSWER_SECONDS = 1.5
HEIGHTS_ABOVE = {
    mavlink.MAV_FRAME_GLOBAL: "sea level",
    mavlink.MAV_FRAME_GLOBAL_INT: "sea level",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT: "home",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: "home",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT: "the terrain",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: "the terrain",
}
"""What heights count from in a frame: ArduPilot gives back another number of the same frame."""

HEIGHT_STEP = {MISSION: 0.02, RALLY: 1.0}
"""Metres that heights may lose: ArduPilot keeps centimetres, of rally points whole metres only."""


@dataclass(frozen=True, slots=True)
class Item:
    """An item: a MAV_CMD, four parameters, degrees times ten million, metres above home."""

    command: int
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    x: int = 0
    y: int = 0
    z: float = 0.0
    frame: int = RELATIVE


def upload(link: Link, items: Sequence[Item], kind: int = MISSION) -> None:
    """Replace what the vehicle has of that kind; an empty list clears it.

    A vehicle that has just started, or is busy, refuses; it is asked again after a second.

    Raises:
        Refused: the vehicle does not accept it, or does not answer.
    """
    result: int | None = None
    for attempt in range(link.tries):
        result = _clear(link, kind) if not items else _transfer(link, items, kind)
        if result == mavlink.MAV_MISSION_ACCEPTED:
            return
        if attempt + 1 < link.tries:
            link.wait(lambda: None, 1.0)
    answer = "nothing" if result is None else f"'{_result(result)}'"
    raise Refused(f"{NAMES[kind]}: the vehicle answers {answer} to the upload")


def download(link: Link, kind: int = MISSION) -> tuple[Item, ...]:
    """Return what the vehicle has of that kind.

    Raises:
        Refused: the vehicle does not answer.
    """
    with link.inbox("MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK") as inbox:
        ask = mavlink.MAVLink_mission_request_list_message(link.system, link.component, kind)
        count = _asked(link, ask, inbox, lambda m: m.get_type() == "MISSION_COUNT" and _of(m, kind))
        items = tuple(_fetch(link, inbox, seq, kind) for seq in range(count.count))
    link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, kind))
    return items


def verify(link: Link, items: Sequence[Item], kind: int = MISSION) -> None:
    """Read back what was uploaded; the home item of a mission is the vehicle's own and is not compared.

    Heights of fences are not compared either: they have none, and ArduPilot gives them back as 0
    above sea level.

    Raises:
        Refused: the vehicle has kept something else.
    """
    kept = download(link, kind)
    if len(kept) != len(items) and (items or len(kept) > 1):
        raise Refused(f"{NAMES[kind]}: the vehicle has {len(kept)} items instead of {len(items)}")
    for seq, (wanted, found) in enumerate(zip(items, kept, strict=False)):
        if not (seq == 0 and kind == MISSION) and not _alike(wanted, found, kind):
            raise Refused(f"{NAMES[kind]}: item {seq} is {found} on the vehicle instead of {wanted}")


def _transfer(link: Link, items: Sequence[Item], kind: int) -> int | None:
    count = mavlink.MAVLink_mission_count_message(link.system, link.component, len(items), kind)
    kinds = ("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK")
    with link.inbox(*kinds) as inbox:
        last: Message = count
        tries = 0
        while tries < link.tries:
            link.send(last)
            message = link.wait(
                lambda: _first(inbox, lambda m: _of(m, kind)), link.clock.patience(ANSWER_SECONDS)
            )
            if message is None:
                tries += 1
                continue
            if message.get_type() == "MISSION_ACK":
                return int(message.type)
            if not 0 <= message.seq < len(items):
                return int(mavlink.MAV_MISSION_INVALID_SEQUENCE)
            last, tries = _message(link, message.seq, items[message.seq], kind), 0
    return None


def _clear(link: Link, kind: int) -> int:
    with link.inbox("MISSION_ACK") as inbox:
        ask = mavlink.MAVLink_mission_clear_all_message(link.system, link.component, kind)
        return int(_asked(link, ask, inbox, lambda m: _of(m, kind)).type)


def _fetch(link: Link, inbox: deque[Message], seq: int, kind: int) -> Item:
    ask = mavlink.MAVLink_mission_request_int_message(link.system, link.component, seq, kind)
    wanted = _asked(
        link, ask, inbox, lambda m: m.get_type() == "MISSION_ITEM_INT" and m.seq == seq and _of(m, kind)
    )
    params = (wanted.param1, wanted.param2, wanted.param3, wanted.param4)
    return Item(wanted.command, params, wanted.x, wanted.y, wanted.z, wanted.frame)


def _asked(link: Link, ask: Message, inbox: deque[Message], fits: Callable[[Message], bool]) -> Message:
    for _ in range(link.tries):
        link.send(ask)
        answer = link.wait(lambda: _first(inbox, fits), link.clock.patience(ANSWER_SECONDS))
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


def _alike(wanted: Item, found: Item, kind: int) -> bool:
    close = all(
        abs(a - b) <= 1e-3 * max(1.0, abs(a)) for a, b in zip(wanted.params, found.params, strict=True)
    )
    here = abs(wanted.x - found.x) <= 1 and abs(wanted.y - found.y) <= 1
    return wanted.command == found.command and close and here and _as_high(wanted, found, kind)


def _as_high(wanted: Item, found: Item, kind: int) -> bool:
    """Return whether two heights are the same; items without a place have none in any frame."""
    if kind == FENCE:
        return True
    if abs(wanted.z - found.z) > HEIGHT_STEP[kind]:
        return False
    return wanted.frame == NO_FRAME or HEIGHTS_ABOVE[wanted.frame] == HEIGHTS_ABOVE.get(found.frame)


def _result(number: int) -> str:
    name = str(mavlink.enums["MAV_MISSION_RESULT"][number].name)
    return name.removeprefix("MAV_MISSION_").lower().replace("_", " ")
