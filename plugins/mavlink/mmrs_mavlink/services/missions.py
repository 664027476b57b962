"""Missions, fences and rally points: upload, clearing, and reading back what the vehicle has kept.

ArduPilot clears nothing while it receives, but takes a plan without items instead from the sender of the
plan; PX4 takes neither before it was informed that the transfer is over.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from math import isnan

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import turn
from mmrs_runtime.faults import RefusedError

from ..links.link import Link, Message
from ..profiles.autopilot import Keeping
from .exchanges import concerns, first, lacks_kinds, old_port, words_of
from .items import FENCE, MISSION, NAMES, NO_FRAME, Item
from .reading import count_of, download
from .sending import Transfer, cancellation, send_all


def upload(link: Link, items: Sequence[Item], kind: int = MISSION) -> int:
    """Replace the vehicle's plan of that kind; an empty list clears it.

    A vehicle that has just started, or is busy, refuses; it is asked again after a while. If it
    refuses for good in the middle, what it has by then is cleared, so that it cannot fly half a plan.

    Returns:
        The id that the vehicle gave to the plan; 0 where it gives none.

    Raises:
        RefusedError: the vehicle does not accept it, or does not answer; names what the vehicle has now.
    """
    transfer = Transfer()
    with link.inbox("STATUSTEXT") as said:
        try:
            for attempt in range(link.retries.tries):
                if _replaces(link, items, kind, transfer, attempt):
                    return transfer.mark
                if attempt + 1 < link.retries.tries:
                    link.wait(lambda: None, 1.0)
        except BaseException:
            if transfer.begun:
                break_off(link, kind)
            raise
        left = _left(link, kind, transfer)
        raise RefusedError(
            f"{NAMES[kind]}: the vehicle {transfer.outcome} to the upload; {left}{_texts(said)}"
        )


def verify(link: Link, items: Sequence[Item], kind: int = MISSION) -> None:
    """Read back what was uploaded; home as item 0 of a mission is the vehicle's own and not compared.

    Heights of fences are not compared either: they have none, and ArduPilot gives them back as 0
    above sea level.

    Raises:
        RefusedError: the vehicle has kept something else.
    """
    autopilot = link.profile.autopilot
    own_home = kind == MISSION and autopilot.missions.begins_with_home
    kept = download(link, kind)
    if len(kept) != len(items) and (items or len(kept) > own_home):
        raise RefusedError(f"{NAMES[kind]}: the vehicle has {len(kept)} items instead of {len(items)}")
    for seq, (wanted, found) in enumerate(zip(items, kept, strict=False)):
        if not (seq == 0 and own_home) and not alike(wanted, found, kind, autopilot.keeping):
            raise RefusedError(f"{NAMES[kind]}: item {seq} is {found} on the vehicle instead of {wanted}")


def _replaces(link: Link, items: Sequence[Item], kind: int, transfer: Transfer, attempt: int) -> bool:
    """Try once to replace a plan; return whether the vehicle has the new one.

    A vehicle whose last message is lost may deny the transfer when it is sent the last item
    once more: its plan then shows whether it had accepted it.
    """
    if not items:
        result = clear(link, kind, receiving=attempt % 2 == 1)
        transfer.outcome = f"answers '{words_of(result)}'"
        return bool(result == mavlink.MAV_MISSION_ACCEPTED)
    if send_all(link, items, kind, transfer):
        return True
    return transfer.whole and _has(link, items, kind)


def _has(link: Link, items: Sequence[Item], kind: int) -> bool:
    try:
        verify(link, items, kind)
    except RefusedError:
        return False
    return True


def _left(link: Link, kind: int, transfer: Transfer) -> str:
    """Return what a vehicle has that did not take a plan; of a part of one it is made to have none."""
    if transfer.begun:
        return left_of(link, kind)
    received = transfer.outcome != Transfer().outcome
    return "it keeps what it had" if received else "whether it keeps what it had is not known"


def _texts(said: deque[Message]) -> str:
    """Return what the vehicle has said in words in the meantime, as far as it warns of something."""
    warnings = (str(each.text) for each in said if each.severity <= mavlink.MAV_SEVERITY_WARNING)
    reported = dict.fromkeys(text for text in warnings if not text.lower().startswith("prearm"))
    return "".join(f"; it says '{text}'" for text in reported)


HEIGHTS_ABOVE = {
    mavlink.MAV_FRAME_GLOBAL: "sea level",
    mavlink.MAV_FRAME_GLOBAL_INT: "sea level",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT: "home",
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: "home",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT: "the terrain",
    mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: "the terrain",
}
"""What heights count from in a frame: vehicles give back another number of the same frame."""

ALL = (0, 1, 2, 3)
YAW = 3


def alike(wanted: Item, found: Item, kind: int, keeping: Keeping) -> bool:
    """Return whether an item that was given back is the one that was uploaded, as far as it is kept."""
    if wanted.command != found.command:
        return False
    kept = keeping.params.get(wanted.command, ALL)
    same = all(_close(wanted.params[n], found.params[n], keeping.wraps and n == YAW) for n in kept)
    apart = max(abs(wanted.x - found.x), abs(wanted.y - found.y))
    return same and apart <= keeping.degrees and _as_high(wanted, found, kind, keeping)


def _close(a: float, b: float, heading: bool) -> bool:
    if isnan(a) or isnan(b):
        return isnan(a) and isnan(b)
    apart = abs(turn(a, b)) if heading else abs(a - b)
    return apart <= 1e-3 * max(1.0, abs(a))


def _as_high(wanted: Item, found: Item, kind: int, keeping: Keeping) -> bool:
    """Return whether two heights are the same; fences and items without a place have none."""
    if kind == FENCE:
        return True
    if abs(wanted.z - found.z) > keeping.heights[kind]:
        return False
    return wanted.frame == NO_FRAME or HEIGHTS_ABOVE[wanted.frame] == HEIGHTS_ABOVE.get(found.frame)


def clear(link: Link, kind: int, *, receiving: bool = False) -> int:
    """Clear what the vehicle has of a kind; return its MAV_MISSION_RESULT.

    Args:
        link: to the vehicle.
        kind: of plan.
        receiving: whether it may be in the middle of receiving one, which is ended first.

    Raises:
        RefusedError: the vehicle does not answer, or its port is too old for that kind of plan.
    """
    with link.inbox("MISSION_ACK") as inbox:
        *before, ask = _ending(link, kind) if receiving else (_clearing(link, kind),)
        for message in before:
            link.send(message)
        answer = _answer(link, ask, inbox, kind)
    if answer is None:
        unknown = "whether it keeps what it had is not known"
        raise RefusedError(f"{NAMES[kind]}: the vehicle answers nothing to being told to clear it; {unknown}")
    if lacks_kinds(answer, kind):
        raise old_port(kind)
    return int(answer.type)


def break_off(link: Link, kind: int) -> None:
    """End a transfer and clear the plan, without waiting for an answer."""
    for message in _ending(link, kind):
        link.send(message)


def left_of(link: Link, kind: int) -> str:
    """Clear a plan of which the vehicle took only a part; return what it has now, in words."""
    # Without an answer to this either, what the vehicle has kept is unknown, and reported as such.
    with suppress(RefusedError):
        for _ in range(link.retries.tries):
            break_off(link, kind)
            if count_of(link, kind) <= _least(link, kind):
                return "it has none now"
    return "what it has now is not known"


def _answer(link: Link, ask: Message, inbox: deque[Message], kind: int) -> Message | None:
    """Ask until the vehicle answers; return None where it does not."""
    seconds = link.clock.patience(link.retries.answer, link.retries.answer)
    for _ in link.attempts():
        link.send(ask)
        answer = link.wait(lambda: first(inbox, lambda found: concerns(found, kind)), seconds)
        if answer is not None:
            return answer
    return None


def _ending(link: Link, kind: int) -> Iterator[Message]:
    """Yield what has any vehicle end a transfer and forget the plan, in this order."""
    yield cancellation(link, kind)
    yield _clearing(link, kind)
    yield mavlink.MAVLink_mission_count_message(link.system, link.component, 0, kind)


def _clearing(link: Link, kind: int) -> Message:
    return mavlink.MAVLink_mission_clear_all_message(link.system, link.component, kind)


def _least(link: Link, kind: int) -> int:
    """Return how many items an empty plan has at most: a mission may begin with home."""
    return int(kind == MISSION and link.profile.autopilot.missions.begins_with_home)
