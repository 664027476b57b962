"""Whether a vehicle really flies the items of its mission that it reports as passed.

MISSION_CURRENT alone proves nothing: another ground station may set the mission ahead, or replace it,
and the vehicle then goes straight to an item along a path that is not verified.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mmrs_runtime.controllers.geodesy import distance, distance_to_leg
from mmrs_runtime.faults import NO_PROGRESS, FaultError

from ..program import Place
from .corridor import Corridor
from .trail import Trail

NEAR_METRES = 4.0
"""How near a vehicle comes to every place of its mission, however it cuts its corners."""


JUDGED_AFTER = 2
"""How many positions that were sent after it said that it has left an item behind must have come."""

SET_BACK_AFTER = 3
"""How many must have come since it reported an earlier item: one that restarts reports that, too, and its
positions show the restart by their times.
"""


class Following:
    """Keeps how near the vehicle has come to each position of a run.

    Between two reported positions it may have been anywhere that its speed allows; that distance is
    added to what counts as near.
    """

    def __init__(
        self,
        trail: Trail,
        places: Mapping[int, Place],
        item: Callable[[], int],
        first: int,
        width: float | None = None,
    ) -> None:
        """Begin at an item, before the vehicle does: it may have passed it by its next message.

        Args:
            trail: of the vehicle, from now on.
            places: by item.
            item: gives the item that the vehicle is at; less than 0: unknown.
            first: that it begins with.
            width: metres that the vehicle may be beside the legs between the positions; None: any number.
        """
        self._trail = trail
        self._places = places
        self._item = item
        self._claimed = self._proven = first
        self._claimed_order = self._judged_order = -1
        self._here = trail.begun
        corners = (trail.begun, *(places[seq] for seq in sorted(places)))
        self._corridor = Corridor(() if width is None else corners, width or 0.0)
        self._missed: dict[int, float] = {}
        self._since: dict[int, int] = {}
        self._back: set[int] = set()
        self._approach(self._here)

    def look(self) -> int:
        """Take note of where the vehicle is; return the first item that it has not surely left behind.

        Raises:
            FaultError: it has left items out, or has gone back, or is elsewhere.
        """
        for place in self._trail.passed():
            self._approach(place)
            self._corridor.check(place)
        self._claim(self._item())
        self._count()
        while self._proven < self._claimed and self._was_near(self._proven):
            self._proven += 1
        return self._proven

    def _claim(self, now: int) -> None:
        """Take note of the item that the vehicle says it is at.

        Raises:
            FaultError: it has gone back.
        """
        if 0 <= now < self._claimed:
            self._back.add(self._trail.place_order())
            if len(self._back) > SET_BACK_AFTER:
                raise FaultError(NO_PROGRESS, f"the mission was set back from item {self._claimed} to {now}")
            return
        self._back.clear()
        if now > self._claimed:
            self._claimed, self._claimed_order = now, self._trail.item_order()

    def _count(self) -> None:
        """Count a position that the vehicle has sent since it last reported an item as passed.

        One that stands still counts as well: otherwise the wait at the end of a mission would time out.
        """
        order = self._trail.place_order()
        if order > max(self._claimed_order, self._judged_order):
            self._judged_order = order
            for seq in range(self._proven, self._claimed):
                self._since[seq] = self._since.get(seq, 0) + 1

    def _was_near(self, seq: int) -> bool:
        """Return whether the vehicle has been near an item, or the item is nowhere.

        Raises:
            FaultError: it surely has not.
        """
        if self._missed.get(seq, 0.0) <= 0.0:
            return True
        if self._since.get(seq, 0) >= JUDGED_AFTER:
            ahead = f"the mission was set ahead to item {self._claimed}"
            raise FaultError(NO_PROGRESS, f"{ahead}: the vehicle has not been near item {seq}")
        return False

    def _approach(self, here: Place) -> None:
        """Keep by how many metres each place was missed up to now; 0: not at all."""
        gap = distance(self._here, here)
        for seq, place in self._places.items():
            if seq >= self._proven:
                missed = max(0.0, distance_to_leg(place, self._here, here) - NEAR_METRES - gap / 2.0)
                self._missed[seq] = min(self._missed.get(seq, missed), missed)
        self._here = here
