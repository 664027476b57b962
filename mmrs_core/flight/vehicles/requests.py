"""Modes that the program itself has asked for lately: no pilot has chosen them, however late they come."""

from __future__ import annotations

from dataclasses import dataclass

from ..links.link import Link

SHOWN_SECONDS = 5.0
"""In which a vehicle shows a mode after it has heard of it, its next heartbeats being lost."""


@dataclass(slots=True)
class Request:
    """A mode that was asked for: when it was last, and whether a later one has been shown since."""

    asked: float
    overtaken: bool = False


class Requests:
    """Remembers what was asked for until it cannot come any more.

    A request may have been broken off by an order or a fault before the vehicle showed it. Until a
    later one is shown it may come as late as an answer over the link, and the heartbeat after that;
    then only a copy of it may still be on its way.
    """

    def __init__(self, link: Link) -> None:
        """Have asked for nothing."""
        self._link = link
        self._of: dict[int, Request] = {}

    def ask(self, number: int) -> None:
        """Remember that a mode is asked for now."""
        self._of[number] = Request(self._link.clock.now())

    def shows(self, number: int) -> None:
        """Know that the vehicle shows the mode that was asked for last."""
        for other, request in self._of.items():
            request.overtaken = request.overtaken or other != number

    def own(self, number: int) -> bool:
        """Return whether a mode may come from a request of the program."""
        request = self._of.get(number)
        if request is None:
            return False
        seconds = self._link.patience
        if not request.overtaken:
            seconds += self._link.clock.patience(SHOWN_SECONDS, 2.0)
        return self._link.clock.now() - request.asked <= seconds
