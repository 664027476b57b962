"""Modes that the program itself has requested lately: not a pilot's, however late they come.

Also all modes that the vehicle has shown since the last look: a pilot's may last no longer than a request
takes.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link, Message

SHOWN_SECONDS = 5.0
"""Seconds in which a vehicle shows a mode after it has received the request, its next heartbeats being lost.
"""


MOST_SHOWN = 16


@dataclass(slots=True)
class Request:
    """A mode that was asked for: when it was last, and whether a later one has been shown since."""

    asked: float
    overtaken: bool = False


class Requests:
    """Remembers requests until they cannot arrive any more; an observer of the vehicle's link.

    A request may have been broken off by an order or a fault before the vehicle showed it. Until a
    later one is shown it may come as late as an answer over the link, and the heartbeat after that;
    then only a copy of it may still be in transit. Every copy that is sent counts, also of a command
    that was sent again since its answer was late.
    """

    def __init__(self, link: Link) -> None:
        """Create without requests."""
        self._link = link
        self._of: dict[int, Request] = {}
        self._late: tuple[int, float] | None = None
        self._shown: deque[int] = deque(maxlen=MOST_SHOWN)
        link.observe(self)

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Remember that a mode is asked for now, or shown."""
        if not outgoing and message.get_type() == "HEARTBEAT":
            if message.get_srcComponent() == self._link.component:
                self._shown.append(int(message.custom_mode))
            return
        command = message.command if outgoing and message.get_type() == "COMMAND_LONG" else None
        if command == mavlink.MAV_CMD_DO_SET_MODE:
            given = (message.param1, message.param2, message.param3)
            for mode in self._link.profile.modes.values():
                if given[: len(mode.params)] == mode.params:
                    self._of[mode.number] = Request(self._link.clock.now())

    def shown(self) -> tuple[int, ...]:
        """Return the modes that heartbeats have shown since this was asked last."""
        return tuple(self._shown.popleft() for _ in range(len(self._shown)))

    def shows(self, number: int) -> None:
        """Record that the vehicle has entered the mode that was requested last."""
        for other, request in self._of.items():
            request.overtaken = request.overtaken or other != number

    def own(self, number: int) -> bool:
        """Return whether a mode that the vehicle shows now may come from a request of the program.

        One that came in time stays the program's as long as it may take to put it right.
        """
        now, request = self._link.clock.now(), self._of.get(number)
        if self._late is None or self._late[0] != number:
            self._late = (number, now)
        if request is None:
            return False
        begun, usual = self._late[1], self._link.patience
        long = usual + self._link.clock.patience(SHOWN_SECONDS, 2.0)
        return begun - request.asked <= (usual if request.overtaken else long) and now - begun <= long

    def is_back(self) -> None:
        """Record that the vehicle is in a mode that it should be in."""
        self._late = None
