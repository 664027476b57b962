"""What a vehicle says in words (STATUSTEXT), put together from its pieces."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from mmrs_runtime.clock import Clock

from ..links.link import Message

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

    def refusals(self, beginnings: tuple[str, ...], seconds: float) -> tuple[str, ...]:
        """Return the texts of the last seconds about why the vehicle does not arm, each once.

        Args:
            beginnings: of such texts, in lower case.
            seconds: of the run.
        """
        found = self.since(self._clock.now() - seconds)
        return tuple(dict.fromkeys(text.text for text in found if text.text.lower().startswith(beginnings)))
