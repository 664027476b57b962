"""What is damaged in a log that is read nevertheless."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Damages:
    """Counts the bytes of a log that hold no message.

    Attributes:
        file: name of the log.
        skipped: bytes between messages. first: offset of the first of them.
        cut: offset of a message that the end of the file cuts; -1: none.
    """

    file: str
    skipped: int = 0
    first: int = -1
    cut: int = -1

    def skip(self, offset: int, count: int = 1) -> None:
        """Count bytes that hold no message."""
        self.skipped += count
        if self.first < 0:
            self.first = offset

    def messages(self) -> tuple[str, ...]:
        """Return a message for each sort of damage."""
        found = []
        if self.skipped:
            found.append(f"{self.file}: {self.skipped} bytes hold no message, the first at byte {self.first}")
        if self.cut >= 0:
            found.append(f"{self.file}: ends within the message at byte {self.cut}: read up to there")
        return tuple(found)
