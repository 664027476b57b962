"""What a vehicle says in words (STATUSTEXT), put together from its pieces, and what it announces by that."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from math import inf

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import LINK_LOST

from ..links.link import Link, Message
from ..links.radio import is_autopilot

KEPT = 200
CHUNK = 50
"""Letters of a piece; a shorter one is the last of its text."""


@dataclass(frozen=True, slots=True)
class Text:
    """A text: when it came (seconds of the run), how grave it is (0 is an emergency, 7 a detail)."""

    time: float
    severity: int
    text: str


class Texts:
    """Collects the texts of one vehicle; an observer of its link."""

    def __init__(self, clock: Clock) -> None:
        """Create an empty STATUSTEXT buffer."""
        self._clock = clock
        self._texts: deque[Text] = deque(maxlen=KEPT)
        self._pieces: dict[int, dict[int, str]] = {}

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Keep the message if it is a text."""
        if outgoing or message.get_type() != "STATUSTEXT":
            return
        piece = str(message.text)
        if not message.id:
            self._texts.append(Text(self._clock.now(), message.severity, piece))
            return
        pieces = self._pieces.setdefault(message.id, {})
        pieces[message.chunk_seq] = piece
        if len(piece) < CHUNK:
            whole = "".join(pieces[seq] for seq in sorted(pieces))
            self._texts.append(Text(self._clock.now(), message.severity, whole))
            del self._pieces[message.id]

    def since(self, time: float) -> tuple[Text, ...]:
        """Return the texts since a second of the run, oldest first."""
        return tuple(text for text in tuple(self._texts) if text.time >= time)

    def starting_with(self, beginnings: tuple[str, ...], seconds: float) -> tuple[str, ...]:
        """Return the texts of the last seconds that start with one of these, each once.

        Args:
            beginnings: in lower case.
            seconds: of the run.
        """
        found = self.since(self._clock.now() - seconds)
        return tuple(dict.fromkeys(text.text for text in found if text.text.lower().startswith(beginnings)))


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
        since = self.since_mode(after)
        return next((t.text for found, t in self.recent() if found == event and t.time > since), "")

    def since_mode(self, after: float) -> float:
        """Return the second of the run from which on, and after which, events may explain its mode."""
        return max(after, self._changed - self._link.clock.patience(TOGETHER_SECONDS, 1.0))

    def _events(self, text: Text) -> Iterable[str]:
        words, known = text.text.lower(), self._link.profile.autopilot.announcements
        found = (event for event, parts in known.items() if any(part in words for part in parts))
        return (event for event in found if event == LINK_LOST or CLEARED not in words)
