"""What a vehicle has told that it detected: by a text ``detected NAME``, or a named value above 0."""

from __future__ import annotations

from ..links.link import Message

PREFIX = "detected "
VALUES = ("NAMED_VALUE_FLOAT", "NAMED_VALUE_INT")


class Detections:
    """The names of all that was detected since the link was opened; an observer of the link."""

    def __init__(self) -> None:
        """Know of nothing yet."""
        self.names: frozenset[str] = frozenset()

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Take a message in."""
        if outgoing:
            return
        kind = message.get_type()
        if kind in VALUES and message.value > 0:
            self.names |= {message.name}
        elif kind == "STATUSTEXT" and message.text.lower().startswith(PREFIX):
            self.names |= {message.text[len(PREFIX) :].strip()}
