"""Missions, fences and rally points: upload, and reading back what the vehicle has kept."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link, Message
from .clearing import break_off, clear, left_of
from .exchanges import words_of
from .items import MISSION, NAMES, Item
from .readback import alike
from .reading import download
from .sending import Transfer, send_all


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
    heard = transfer.outcome != Transfer().outcome
    return "it keeps what it had" if heard else "whether it keeps what it had is not known"


def _texts(said: deque[Message]) -> str:
    """Return what the vehicle has said in words in the meantime, as far as it warns of something."""
    warnings = (str(each.text) for each in said if each.severity <= mavlink.MAV_SEVERITY_WARNING)
    told = dict.fromkeys(text for text in warnings if not text.lower().startswith("prearm"))
    return "".join(f"; it says '{text}'" for text in told)
