"""Messages of a vehicle about its active failsafes, and about the end of these."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import BATTERY_LOW, FENCE_BREACHED, LINK_LOST, POSITION_LOST

from ..links.link import Message
from ..links.radio import is_autopilot
from .texts import Text, Texts

ABOUT_BATTERIES = (
    "battery failsafe",
    *(f"battery {number} is" for number in range(1, 10)),
    "low battery",
    "critical battery",
    "battery level",
)
ABOUT_LINKS = (
    "gcs failsafe",
    "heartbeat lost",
    "gcs connection lost",
    "gcs connection regained",
    "connection to ground station lost",
    "data link lost",
)
WORDS = (
    (POSITION_LOST, ("ekf failsafe", "gps failsafe", "position lost", "no valid position", "no position")),
    (FENCE_BREACHED, ("fence breach", "geofence")),
    (BATTERY_LOW, ABOUT_BATTERIES),
    (LINK_LOST, ABOUT_LINKS),
)
"""Messages of ArduPilot and PX4 when a failsafe acts, in lower case."""

CLEARED = "cleared"
"""Parts of messages when it is over: for a lost link, no more than that can be received."""

RECENT_SECONDS = 5.0
"""For how long what was said counts."""

TOGETHER_SECONDS = 2.5
"""Between what a vehicle says and the mode that it goes into for that, at most."""


class Announcements:
    """Reads what one vehicle says; an observer of its link, for its modes."""

    def __init__(self, clock: Clock, texts: Texts) -> None:
        """Create without messages."""
        self._clock = clock
        self._texts = texts
        self._mode: int | None = None
        self._changed = -inf

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Keep when the mode changes."""
        if not outgoing and message.get_type() == "HEARTBEAT" and is_autopilot(message):
            if self._mode != message.custom_mode:
                self._changed = self._clock.now()
            self._mode = message.custom_mode

    def recent(self) -> tuple[tuple[str, Text], ...]:
        """Return the failsafes that the vehicle has just reported: events and texts, oldest first."""
        said = self._texts.since(self._clock.now() - self._clock.patience(RECENT_SECONDS))
        return tuple((event, text) for text in said for event in _events(text))

    def of_this_mode(self, event: str, after: float) -> str:
        """Return what it said about an event as it went into its mode; empty if nothing.

        Args:
            event: of policies.
            after: second of the run; what was said until then does not count.
        """
        since = max(after, self._changed - self._clock.patience(TOGETHER_SECONDS, 1.0))
        return next((t.text for found, t in self.recent() if found == event and t.time > since), "")


def _events(text: Text) -> Iterable[str]:
    words = text.text.lower()
    found = (event for event, known in WORDS if any(word in words for word in known))
    return (event for event in found if event == LINK_LOST or CLEARED not in words)
