"""What carries bytes to and from vehicles."""

from __future__ import annotations

from typing import NamedTuple, Protocol

Address = tuple[str, int]


class Received(NamedTuple):
    """What has come, and from where; no sender where all that speak share one wire."""

    data: bytes
    sender: Address | None = None


NOTHING = Received(b"")


class Port(Protocol):
    """Carries bytes to and from vehicles."""

    def read(self, seconds: float) -> Received:
        """Return what has come, waiting for so many real seconds at most; empty if nothing has.

        Raises:
            OSError: nothing will ever come again.
        """
        ...

    def write(self, data: bytes, to: Address | None = None) -> object:
        """Send bytes to a sender, or drop them where no receiver is known yet.

        Raises:
            OSError: they are lost; those after them need not be.
        """
        ...

    def close(self) -> None:
        """Release the port."""
        ...
