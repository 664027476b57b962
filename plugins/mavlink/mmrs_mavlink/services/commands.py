"""Commands with acknowledgement."""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable, Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError, UnansweredError

from ..links.link import Link, Message
from ..links.ourselves import GROUND_COMPONENT, GROUND_SYSTEM
from ..program import Geographic

PROGRESS_SECONDS = 60.0
"""For how long a vehicle that has begun may say nothing more."""

_AGAIN = mavlink.MAV_RESULT_TEMPORARILY_REJECTED
_BEGUN = mavlink.MAV_RESULT_IN_PROGRESS
CANCEL_NUMBER, CANCEL_CHECK = 80, 14
LAST_CONFIRMATION = 255


class CommandCancel(mavlink.MAVLink_message):  # type: ignore[misc]  # pymavlink is not typed
    """COMMAND_CANCEL, which pymavlink's dialect for ArduPilot does not have."""

    def __init__(self, system: int, component: int, command: int) -> None:
        """Cancel a command of a component."""
        super().__init__(CANCEL_NUMBER, "COMMAND_CANCEL")
        self._fieldnames = ["target_system", "target_component", "command"]
        self.target_system, self.target_component, self.command = system, component, command

    def pack(self, mav: mavlink.MAVLink, force_mavlink1: bool = False) -> bytes:
        """Return the frame: the larger field first, as on every wire of MAVLink."""
        payload = struct.pack("<HBB", self.command, self.target_system, self.target_component)
        return bytes(self._pack(mav, CANCEL_CHECK, payload, force_mavlink1=force_mavlink1))


def command(
    link: Link, number: int, *params: float, tries: int | None = None, component: int | None = None
) -> None:
    """Send a command, and return when the vehicle has carried it out.

    Sends again, with the confirmation counted up, when no answer comes or the vehicle asks for
    time; waits on while it reports progress, and cancels what it has begun when the wait is
    broken off.

    Args:
        link: to the vehicle.
        number: a MAV_CMD.
        params: up to seven; the rest is 0.
        tries: how often to send at most; None: the link's default.
        component: that is to carry it out; None: the autopilot.

    Raises:
        UnansweredError: no answer to any of the tries, or no end of what was begun.
        RefusedError: the vehicle does not do it.
    """
    to = component or link.component
    _exchange(link, number, lambda sent: _message(link, number, params, to, sent), tries, to)


def command_at(link: Link, number: int, place: Geographic, frame: int, *params: float) -> None:
    """Send a command with a position, encoded to 1e-7 degrees.

    Args:
        link: to the vehicle.
        number: a MAV_CMD.
        place: its height counts as the frame defines.
        frame: a MAV_FRAME.
        params: the first four at most.

    Raises:
        UnansweredError: no answer to any of the tries.
        RefusedError: the vehicle does not do it.
    """
    four = [*params, *[0.0] * (4 - len(params))]
    at = (round(place.latitude * 1e7), round(place.longitude * 1e7), place.height)
    message = mavlink.MAVLink_command_int_message(
        link.system, link.component, frame, number, 0, 0, *four, *at
    )
    _exchange(link, number, lambda sent: message, None, link.component)


def ask(link: Link, number: int, *params: float) -> None:
    """Send a command to the autopilot once, without waiting for the acknowledgement."""
    link.send(_message(link, number, params, link.component))


def name_of(number: int) -> str:
    """Return the name of a MAV_CMD, as printed."""
    entry = mavlink.enums["MAV_CMD"].get(number)
    return entry.name.removeprefix("MAV_CMD_") if entry else f"command {number}"


def _exchange(
    link: Link, number: int, message: Callable[[int], Message], tries: int | None, component: int
) -> None:
    """Send a command, given how often it was sent before, until the vehicle says that it does it.

    Raises:
        UnansweredError: no answer to any of the tries, or no end of what was begun.
        RefusedError: the vehicle does not do it.
    """
    answer = _answered(link, number, message, tries or link.retries.tries, component)
    if answer.result != mavlink.MAV_RESULT_ACCEPTED:
        raise RefusedError(f"{name_of(number)}: the vehicle answers '{_word(answer.result)}'")


def _answered(
    link: Link, number: int, message: Callable[[int], Message], tries: int, component: int
) -> Message:
    answer: Message | None = None
    with link.inbox("COMMAND_ACK", component=component) as inbox:
        for sent in link.attempts(tries):
            link.send(message(min(sent, LAST_CONFIRMATION)))
            received = link.wait(lambda: _answer(inbox, number), link.patience)
            answer = received or answer
            if received is not None and received.result == _BEGUN:
                return _end(link, inbox, number, component)
            if received is not None and received.result != _AGAIN:
                return received
            link.wait(lambda: None, link.retries.answer if received is not None else 0.0)
    if answer is None:
        raise UnansweredError(f"{name_of(number)}: no answer to {tries} tries")
    return answer


def _message(
    link: Link, number: int, params: Sequence[float], component: int, confirmation: int = 0
) -> Message:
    padded = [*params, *[0.0] * (7 - len(params))]
    return mavlink.MAVLink_command_long_message(link.system, component, number, confirmation, *padded)


def _end(link: Link, inbox: deque[Message], number: int, component: int) -> Message:
    """Return how a long-running command ends.

    Raises:
        UnansweredError: the vehicle was silent about it for too long.
    """
    try:
        while (
            answer := link.wait(lambda: _answer(inbox, number), PROGRESS_SECONDS, while_received=True)
        ) is not None:
            if answer.result != _BEGUN:
                return answer
    except BaseException:
        link.send(CommandCancel(link.system, component, number))
        raise
    link.send(CommandCancel(link.system, component, number))
    raise UnansweredError(
        f"{name_of(number)}: begun, and then no messages about it for {PROGRESS_SECONDS:.0f} s"
    )


def _answer(inbox: deque[Message], number: int) -> Message | None:
    """Return the next acknowledgement of a command that is not for another ground station."""
    while inbox:
        message = inbox.popleft()
        ours = message.target_system in (0, GROUND_SYSTEM) and message.target_component in (
            0,
            GROUND_COMPONENT,
        )
        if message.command == number and ours:
            return message
    return None


def _word(result: int) -> str:
    entry = mavlink.enums["MAV_RESULT"].get(result)
    return entry.name.removeprefix("MAV_RESULT_").lower().replace("_", " ") if entry else f"result {result}"
