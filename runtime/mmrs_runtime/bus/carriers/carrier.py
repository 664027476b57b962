"""What carries messages between processes that keep slots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

Answered = Callable[[str], None]


class Station(Protocol):
    """One process's end of the bus, as carriers see it; may be called from any thread."""

    def serve(self, owner: str, sender: str, request: str) -> str:
        """Return the answer of one of this process's robots to a request.

        Args:
            owner: robot of this process.
            sender: sender of the request, as far as the carrier vouches for it.
            request: as written by the sender; anything.
        """
        ...

    def noticed(self, robot: str, here: bool) -> None:
        """Take note that a robot of another process can be reached, or no longer."""
        ...

    def stranger(self, robot: str, here: bool) -> None:
        """Take note that a robot is there by another plan of the mission, or no longer."""
        ...

    def shown(self, robot: str) -> str:
        """Return the state of the slots of one of this process's robots, for observers."""
        ...


class Carrier(Protocol):
    """Carries requests and answers, as well as it can: each may be lost, late, or come twice."""

    def open(self, station: Station) -> None:
        """Begin to serve, and to notice who is there.

        Raises:
            OSError: it cannot.
        """
        ...

    def ask(self, sender: str, owner: str, request: str, answered: Answered) -> None:
        """Send a request to a robot of another process; returns at once.

        `answered` is called with the answer, from any thread, or never.
        """
        ...

    def appear(self, robot: str) -> None:
        """Announce that a robot of this process is reachable."""
        ...

    def vanish(self, robot: str) -> None:
        """Announce that a robot of this process is unreachable."""
        ...

    def publish(self, robot: str) -> None:
        """Publish to observers that the state of a robot's slots has changed."""
        ...

    def close(self) -> None:
        """Stop; no request is served after this returns."""
        ...


class NoCarrier:
    """Carries nothing: all robots are in this process."""

    def open(self, station: Station) -> None:
        """Ignore a call: all robots are in this process."""

    def ask(self, sender: str, owner: str, request: str, answered: Answered) -> None:
        """Ignore a call: all robots are in this process."""

    def appear(self, robot: str) -> None:
        """Ignore a call: all robots are in this process."""

    def vanish(self, robot: str) -> None:
        """Ignore a call: all robots are in this process."""

    def publish(self, robot: str) -> None:
        """Ignore a call: all robots are in this process."""

    def close(self) -> None:
        """Ignore a call: all robots are in this process."""
