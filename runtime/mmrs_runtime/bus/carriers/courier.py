"""A carrier that fails keeps nobody from going on."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..reading import Unreadable, answer_in, written
from ..troubles import Net
from ..words import Answer, Request
from .carrier import Carrier, Station


class Courier:
    """Gives a carrier what is to be carried, tells people of what fails, and reads what comes back.

    To be called without any lock: carriers may take other locks, or wait.
    """

    def __init__(self, carrier: Carrier, net: Net) -> None:
        """Use that carrier; `net` catches what it raises."""
        self._carrier, self._net = carrier, net

    def open(self, station: Station) -> None:
        """Begin to serve.

        Raises:
            OSError: the carrier cannot.
        """
        self._carrier.open(station)

    def ask(self, sender: str, owner: str, request: Request, taken: Callable[[Answer], None]) -> None:
        """Ask a robot of another process; `taken` is called with the answer, from any thread, or never."""

        def take(text: str) -> None:
            try:
                answer = answer_in(text)
            except Unreadable:
                return  # as good as none: whoever needs one asks again
            taken(answer)

        with self._net.under(f"asking {owner!r}"):
            self._carrier.ask(sender, owner, written(request), take)

    def publish(self, robot: str) -> None:
        """Tell whoever looks on that the state of a robot's slots has changed."""
        with self._net.under(f"showing the slots of {robot!r}"):
            self._carrier.publish(robot)

    def appear(self, robot: str) -> None:
        """Tell everybody that a robot can be reached again."""
        with self._net.under(f"coming back as {robot!r}"):
            self._carrier.appear(robot)

    def vanish(self, robots: Iterable[str]) -> None:
        """Tell everybody that robots can no longer be reached."""
        for robot in robots:
            with self._net.under(f"leaving as {robot!r}"):
                self._carrier.vanish(robot)

    def close(self) -> None:
        """Stop."""
        self._carrier.close()
