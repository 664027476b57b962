"""Commands with acknowledgement."""

from __future__ import annotations

from collections import deque

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .faults import Refused
from .link import Link, Message

ANSWER_SECONDS = 1.5
PROGRESS_SECONDS = 60.0
_RETRIED = {mavlink.MAV_RESULT_TEMPORARILY_REJECTED}


class Unanswered(Refused):
    """The vehicle did not answer a command at all."""


def command(link: Link, number: int, *params: float, tries: int | None = None) -> None:
    """Have the vehicle carry out a command, and return when it says that it does.

    Sends again, with the confirmation counted up, when no answer comes or the vehicle asks for
    patience; waits on while it reports progress.

    Args:
        number: a MAV_CMD.
        params: up to seven; the rest is 0.
        tries: how often to send at most; None: as often as the link says.

    Raises:
        Unanswered: no answer to any of the tries.
        Refused: the vehicle does not do it.
    """
    tries = link.tries if tries is None else tries
    padded = [*params, *[0.0] * (7 - len(params))]
    answer: Message | None = None
    with link.inbox("COMMAND_ACK") as inbox:
        for confirmation in range(tries):
            link.send(
                mavlink.MAVLink_command_long_message(
                    link.system, link.component, number, confirmation, *padded
                )
            )
            answer = link.wait(lambda: _answer(inbox, number), link.clock.patience(ANSWER_SECONDS)) or answer
            while answer is not None and answer.result == mavlink.MAV_RESULT_IN_PROGRESS:
                answer = link.wait(lambda: _answer(inbox, number), PROGRESS_SECONDS)
            if answer is not None and answer.result not in _RETRIED:
                break
            link.wait(lambda: None, ANSWER_SECONDS if answer is not None else 0.0)
    if answer is None:
        raise Unanswered(f"{name_of(number)}: no answer to {tries} tries")
    if answer.result != mavlink.MAV_RESULT_ACCEPTED:
        result = mavlink.enums["MAV_RESULT"][answer.result].name.removeprefix("MAV_RESULT_").lower()
        raise Refused(f"{name_of(number)}: the vehicle answers '{result.replace('_', ' ')}'")


def name_of(number: int) -> str:
    """Return the name of a MAV_CMD for people."""
    entry = mavlink.enums["MAV_CMD"].get(number)
    return entry.name.removeprefix("MAV_CMD_") if entry else f"command {number}"


def _answer(inbox: deque[Message], number: int) -> Message | None:
    while inbox:
        message = inbox.popleft()
        if message.command == number:
            return message
    return None
