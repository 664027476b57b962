"""Clears a vehicle's plan, also while it receives one.

ArduPilot clears nothing while it receives, but takes a plan without items instead from the sender of the
plan; PX4 takes neither before it was informed that the transfer is over.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import suppress

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link, Message
from .exchanges import concerns, first, lacks_kinds, old_port
from .items import MISSION, NAMES
from .reading import count_of
from .sending import cancellation


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
    # No answer to this either is told as what it is: nobody knows what is left.
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
