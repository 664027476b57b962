"""Whether a vehicle keeps to the legs of its run: the space beside them is not verified.

Another ground station may give a vehicle another mission at any moment, and what it flies then is
known only from where it flies.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mmrs_runtime.controllers.geodesy import distance_to_leg
from mmrs_runtime.faults import NO_PROGRESS, FaultError

from ..links.link import Link
from ..program import Place
from ..services import parameters

OUTSIDE = 2
"""How many positions in a row lie outside before it is believed."""

NEXT = 3
"""How many legs beyond the last one are looked at first."""


class Corridor:
    """Watches that a vehicle is near one of its legs, whichever."""

    def __init__(self, corners: Sequence[Place], width: float) -> None:
        """Watch legs from each corner to the next, `width` metres to all sides."""
        self._legs = list(pairwise(corners))
        self._width = width
        self._last = 0
        self._outside = 0

    def check(self, here: Place) -> None:
        """Take note of a position.

        Raises:
            FaultError: the vehicle has left its legs.
        """
        if not self._legs or self._is_inside(here):
            self._outside = 0
            return
        self._outside += 1
        if self._outside >= OUTSIDE:
            off = min(distance_to_leg(here, *leg) for leg in self._legs)
            raise FaultError(
                NO_PROGRESS,
                f"the vehicle is {off:.0f} m off all legs of its run: it may have got another mission",
            )

    def _is_inside(self, here: Place) -> bool:
        near = range(self._last, min(self._last + NEXT, len(self._legs)))
        for index in (*near, *range(len(self._legs))):
            if distance_to_leg(here, *self._legs[index]) <= self._width:
                self._last = index
                return True
        return False


def width_for(link: Link) -> float | None:
    """Return how far a vehicle may be beside its legs, metres; None: it goes its own ways round obstacles.

    Whether it does is its owner's business.
    """
    name = link.profile.autopilot.avoids
    if name and parameters.read(link, [name]).get(name, 0.0):
        return None
    return link.profile.corridor
