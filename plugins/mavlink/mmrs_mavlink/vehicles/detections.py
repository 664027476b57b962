"""What a vehicle has told that it detected: by a text ``detected NAME``, or a named value above 0.

A text may say where: ``detected NAME at LATITUDE,LONGITUDE``. Else, or where the vehicle has no place on
Earth, it is where the vehicle was then.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from ..links.link import Message
from ..program import Geographic, Local, Place

PREFIX = "detected "
VALUES = ("NAMED_VALUE_FLOAT", "NAMED_VALUE_INT")
_PLACED = re.compile(r"(?P<name>.+) at (?P<latitude>-?\d+(\.\d+)?), ?(?P<longitude>-?\d+(\.\d+)?)")


class Detections:
    """All that was detected since the link was opened; an observer of the link.

    Attributes:
        names: of it.
        places: where it is, by name, as was told last.
    """

    def __init__(self, here: Callable[[], Place | None] = lambda: None) -> None:
        """Know of nothing yet; `here`: where the vehicle is, None where nobody knows."""
        self.names: frozenset[str] = frozenset()
        self.places: dict[str, Place] = {}
        self._here = here

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Take a message in."""
        if outgoing:
            return
        kind = message.get_type()
        if kind in VALUES and message.value > 0:
            self._take(message.name, self._here())
        elif kind == "STATUSTEXT" and message.text.lower().startswith(PREFIX):
            self._read(message.text[len(PREFIX) :].strip())

    def _read(self, text: str) -> None:
        found, here = _PLACED.fullmatch(text), self._here()
        place = _placed(float(found["latitude"]), float(found["longitude"])) if found else None
        if found is None or place is None:
            self._take(text, here)
        else:
            self._take(found["name"], here if isinstance(here, Local) else place)

    def _take(self, name: str, place: Place | None) -> None:
        self.names |= {name}
        if place is not None:
            self.places = {**self.places, name: place}


def _placed(latitude: float, longitude: float) -> Place | None:
    """Return a place on the ground; None where there is no such place."""
    known = abs(latitude) <= 90.0 and abs(longitude) <= 180.0
    return Geographic(latitude, longitude, 0.0) if known else None
