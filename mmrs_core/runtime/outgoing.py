"""The notify of a robot that is on its way, and for how long nobody answers."""

from __future__ import annotations

from mmrs_core.contributions.buses import Bus, Delivery


class Outgoing:
    """A robot's notify between being prepared and being acknowledged by all owners of its slots.

    Attributes:
        delivery: None: there is none.
    """

    def __init__(self) -> None:
        """Have none."""
        self.delivery: Delivery | None = None
        self._sent = False
        self._silent_since: float | None = None

    @property
    def is_waiting(self) -> bool:
        """Return whether owners have still to answer or to acknowledge."""
        return self.delivery is not None and bool(self.delivery.waiting)

    def send(self, lamport: int) -> None:
        """Have it applied, if there is one, after it was recorded with that logical time."""
        if self.delivery is not None:
            self._sent = True
            self.delivery.send(lamport)

    def give_up(self) -> None:
        """Withdraw it, if there is one."""
        if self.delivery is not None:
            self.delivery.withdraw()
        self.delivery, self._sent, self._silent_since = None, False, None

    def silence(self, now: float) -> float | None:
        """Return for how many seconds owners have not answered; None: nothing is waited for.

        What was sent and acknowledged is forgotten.
        """
        if not self.is_waiting:
            self._silent_since = None
            if self._sent:
                self.delivery, self._sent = None, False
            return None
        if self._silent_since is None:
            self._silent_since = now
        return now - self._silent_since

    def extend(self, seconds: float) -> None:
        """Count so many seconds less, in which the robot was held."""
        self._silent_since = None if self._silent_since is None else self._silent_since + seconds

    def why(self, bus: Bus) -> str:
        """Return who does not answer, for people."""
        silent = self.delivery.waiting if self.delivery is not None else ()
        words = f"no answer from {', '.join(silent)}"
        if unseen := bus.unseen(silent):
            words += f"; {', '.join(unseen)} never came while this robot was there, or had ended before"
        return words
