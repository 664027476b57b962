"""Messages of a vehicle about its active failsafes, and about the end of these."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from mmrs_runtime.faults import LINK_LOST

from ..links.link import Link, Message
from ..links.radio import is_autopilot
from .texts import Text, Texts

CLEARED = "cleared"
"""Parts of messages when it is over: for a lost link, no more than that can be received."""

RECENT_SECONDS = 5.0
"""For how long what was said counts."""

TOGETHER_SECONDS = 2.5
"""Between what a vehicle says and the mode that it goes into for that, at most."""


class Announcements:
    """Reads what one vehicle says; an observer of its link, for its modes."""

    def __init__(self, link: Link, texts: Texts) -> None:
        """Create without messages."""
        self._link = link
        self._texts = texts
        self._mode: int | None = None
        self._changed = -inf

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Keep when the mode changes."""
        if not outgoing and message.get_type() == "HEARTBEAT" and is_autopilot(message):
            if self._mode != message.custom_mode:
                self._changed = self._link.clock.now()
            self._mode = message.custom_mode

    def recent(self) -> tuple[tuple[str, Text], ...]:
        """Return the failsafes that the vehicle has just reported: events and texts, oldest first."""
        said = self._texts.since(self._link.clock.now() - self._link.clock.patience(RECENT_SECONDS))
        return tuple((event, text) for text in said for event in self._events(text))

    def of_this_mode(self, event: str, after: float) -> str:
        """Return what it said about an event as it went into its mode; empty if nothing.

        Args:
            event: of policies.
            after: second of the run; what was said until then does not count.
        """
        since = max(after, self._changed - self._link.clock.patience(TOGETHER_SECONDS, 1.0))
        return next((t.text for found, t in self.recent() if found == event and t.time > since), "")

    def _events(self, text: Text) -> Iterable[str]:
        words, known = text.text.lower(), self._link.profile.autopilot.announcements
        found = (event for event, parts in known.items() if any(part in words for part in parts))
        return (event for event in found if event == LINK_LOST or CLEARED not in words)
