"""Detections of a vehicle: a text ``detected NAME``, or a named value above 0.

A text may have a position: ``detected NAME at LATITUDE,LONGITUDE``. Otherwise, or where the vehicle has no
geographic position, it is the vehicle's position at that time.
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
    """All detections since the link was opened; an observer of the link.

    Attributes:
        names: of the detections.
        places: their last reported positions, by name.
    """

    def __init__(self, here: Callable[[], Place | None] = lambda: None) -> None:
        """Create without detections; `here`: the vehicle's position, None where unknown."""
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
