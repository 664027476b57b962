"""A simulated stand-in for a vehicle: it moves at a steady speed, for dry runs without a link."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.geodesy import at_height, bearing, distance
from mmrs_runtime.controllers.state import State

from ..profiles.modes import GUIDED, HOLD, LAND, SURFACE
from ..program import Geographic, Look, Place
from .vehicle import Vehicle

if TYPE_CHECKING:
    from ..services.items import Item
    from ..services.uploads import Uploads

CRUISE = 5.0
CLIMB = 2.0


class DryVehicle(Vehicle):
    """Does everything at once that a real vehicle takes its time for, but takes the time, too.

    There is no link to lose, no fence, no hardware and no external control: the rest does nothing.

    Attributes:
        start: where it is to stand before it takes off.
    """

    def __init__(self, clock: Clock, home: Place, guard: Callable[[], None]) -> None:
        """Stand at home."""
        self.start = home
        self._clock = clock
        self._here = home
        self._home = home
        self._guard = guard
        self._items: Sequence[Item] = ()
        self._mode = GUIDED
        self._armed = False

    def prepare(self, uploads: Uploads) -> None:
        """Keep the mission."""
        self._items = uploads.mission

    def take_off(self, height: float) -> None:
        """Climb to a height above home."""
        self._mode, self._armed = GUIDED, True
        self._climb(height)

    def land(self) -> None:
        """Descend to the height of home."""
        self._mode = LAND
        self._climb(self._home.height)
        self._armed = False

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Arrive at a position after the duration of the path."""
        self._mode = GUIDED
        self.rest(distance(self._here, place) / (speed or CRUISE))
        self._here = place

    def fly(self, first: int, last: int, reached: Callable[[int], None], look: Look | None = None) -> None:
        """Pass the mission's items one after the other."""
        for seq in range(first, last + 1):
            item = self._items[seq]
            if item.x or item.y:
                self.go_to(Geographic(item.x * 1e-7, item.y * 1e-7, item.z), None, None, True)
            reached(seq)

    def rest(self, seconds: float) -> None:
        """Stay for `seconds`."""
        until = self._clock.now() + seconds
        while (left := until - self._clock.now()) > 0:
            before = self._clock.now()
            self._guard()
            # A hold is obeyed inside the guard, and is no part of the time that something takes.
            until += self._clock.now() - before
            time.sleep(min(self._clock.real(left), 0.1))
        self._guard()

    def measure(self, value: str, seconds: float) -> None:
        """Measure nothing: there is nothing to measure."""

    def hold(self) -> bool:
        """Stay."""
        self._mode = HOLD
        self._guard()
        return False

    def carry_on(self) -> None:
        """Become ready."""
        self._mode = GUIDED

    def surface(self) -> None:
        """Move to the surface."""
        self._mode = SURFACE
        self._here = at_height(self._here, 0.0)

    def evidence(self) -> DryVehicle:
        """Return itself: it carries out every command."""
        return self

    def in_mode(self, mode: str) -> bool:
        """Return whether it is in a mode."""
        return self._mode == mode

    def is_off(self) -> bool:
        """Return that it is: there are no motors."""
        return True

    def bound_for(self, place: Place, speed: float | None) -> bool:
        """Return that it goes to every commanded position."""
        return True

    def state(self) -> State:
        """Return where the vehicle would be, with a full battery."""
        heading = bearing(self._home, self._here)
        return State(
            self._clock.now(), self._here, 0.0, heading, 1.0, self._mode, armed=self._armed, wind=0.0
        )

    def _climb(self, height: float) -> None:
        self.rest(abs(height - self._here.height) / CLIMB)
        self._here = at_height(self._here, height)
