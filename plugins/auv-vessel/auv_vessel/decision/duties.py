"""What a decision centre has a vehicle do; each is begun, then asked whether it is done. Nothing waits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan2, degrees, dist, hypot
from typing import Protocol

from auv_vessel.api import Craft
from auv_vessel.goals import SLOWEST
from auv_vessel.sheet import Sheet, Vector

NO_PROGRESS, DEVICE_SILENT, OBJECT_NOT_FOUND = "NO_PROGRESS", "DEVICE_SILENT", "OBJECT_NOT_FOUND"
BATTERY_LOW = "BATTERY_LOW"

STALE = 1.0
"""Seconds of silence of the sensor controller after which the vehicle is not known to be where it was."""

PASSED = 0.5
"""Metres from a place within which it counts as passed where the vehicle need not stop."""

AFLOAT = 0.1
"""Metres deeper than it floats at rest that count as at the surface still."""

FULL, CHARGING, CHARGING_SPARE = 0.95, 3.0, 5.0
"""Part of the battery that is full; times as long as it should take, and seconds more, till it fails."""


class FailureError(Exception):
    """Something that ends what the vehicle does; `event` is in the words that policies use."""

    def __init__(self, event: str, reason: str) -> None:
        super().__init__(reason)
        self.event = event
        self.reason = reason


class Duty(Protocol):
    """Something that a vehicle does."""

    def begin(self, craft: Craft, now: float) -> None:
        """Begin, or resume after a pause."""
        ...

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether it is done.

        Raises:
            FailureError: it cannot be done.
        """
        ...


@dataclass(frozen=True, slots=True)
class Look:
    """A position that the front points at, metres; at an `angle` of 90 degrees it is to starboard."""

    north: float
    east: float
    angle: float = 0.0

    def heading(self, north: float, east: float) -> float | None:
        """Return the heading from a position, degrees; None at the position that is looked at."""
        away = (self.north - north, self.east - east)
        return None if hypot(*away) < 1e-6 else (degrees(atan2(away[1], away[0])) - self.angle) % 360.0


class Ready:
    """Start at the vehicle's position before it moves."""

    def begin(self, craft: Craft, now: float) -> None:
        """Begin; nothing moves."""

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether depth, heading and place are known."""
        state = craft.state()
        return state.trusted and state.age < STALE and not state.position_lost


class Travel:
    """Go from place to place, to the last without a stop if it is to go through it."""

    def __init__(
        self, points: Sequence[Vector], speed: float = 0.0, look: Look | None = None, *, through: bool = False
    ) -> None:
        """Go to each of the points: metres north, east and below the surface."""
        self._points, self._look, self._through = tuple(points), look, through
        self._speed = max(speed, SLOWEST) if speed > 0.0 else 0.0
        self._next = 0

    def begin(self, craft: Craft, now: float) -> None:
        """Set out for the next place.

        Raises:
            FailureError: it is beyond what can be said on the bus.
        """
        if self._next < len(self._points):
            north, east, depth = self._points[self._next]
            heading = self._look.heading(north, east) if self._look is not None else None
            try:
                craft.go_to(north, east, max(0.0, depth), speed=self._speed, heading=heading)
            except ValueError as error:
                raise FailureError(NO_PROGRESS, str(error)) from error

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the last place is reached."""
        if self._next >= len(self._points):
            return True
        state = craft.state()
        if state.progress == "FAILED":
            raise FailureError(NO_PROGRESS, f"does not get nearer than {state.distance:.2f} m")
        last = self._next == len(self._points) - 1
        passed = self._through and last and state.progress == "ACTIVE" and state.distance < PASSED
        if state.progress != "REACHED" and not passed:
            return False
        self._next += 1
        if not last:
            self.begin(craft, now)
        return last


class Face:
    """Turn on the spot."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._turns = True

    def begin(self, craft: Craft, now: float) -> None:
        """Begin to turn."""
        state = craft.state()
        heading = self._look.heading(state.north, state.east)
        self._turns = heading is not None
        if heading is not None:
            craft.turn(heading)

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the vehicle points there."""
        state = craft.state()
        if self._turns and state.progress == "FAILED":
            raise FailureError(NO_PROGRESS, "does not turn")
        return not self._turns or state.progress == "REACHED"


class Stay:
    """Hold for `seconds` at the position of the last goal, or where the vehicle is if there was none."""

    def __init__(self, seconds: float, *, hold: bool = False) -> None:
        """Stay; `hold`: where the vehicle is when it begins."""
        self._left, self._hold = seconds, hold
        self._since: float | None = None

    def begin(self, craft: Craft, now: float) -> None:
        """Begin, or resume after a pause."""
        if self._hold:
            craft.hold()
        elif self._left > 0.0:
            craft.stay()
        self._since = None

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the time has passed."""
        self._left -= now - self._since if self._since is not None else 0.0
        self._since = now
        return self._left <= 1e-6


class Finish:
    """Move no more: without thrust where the vehicle floats, else kept at the surface by thrust."""

    def __init__(self, *, floats: bool) -> None:
        self._floats = floats

    def begin(self, craft: Craft, now: float) -> None:
        """Begin."""
        if self._floats:
            craft.idle()
        else:
            craft.surface()

    def done(self, craft: Craft, now: float) -> bool:
        """Return that it is done."""
        return True


class Surface:
    """Surface, and rest there without thrust for recovery, unless the vehicle would sink."""

    def __init__(self, afloat: float, *, floats: bool) -> None:
        """Come up; `afloat`: depth of the centre of gravity afloat, metres."""
        self._afloat, self._rest = afloat, Finish(floats=floats)

    def begin(self, craft: Craft, now: float) -> None:
        """Begin; thrust helps unless the dive was given up."""
        craft.surface()

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the vehicle is at the surface."""
        state = craft.state()
        up = state.progress == "REACHED" or (state.age < STALE and state.depth < self._afloat + AFLOAT)
        if up:
            self._rest.begin(craft, now)
        return up


class Charge:
    """Stay at the surface until the battery is full."""

    def __init__(self, seconds: float, charged: Callable[[], None] = lambda: None) -> None:
        """Charge for at least `seconds`; then `charged` is called, as when batteries are changed."""
        self._seconds, self._charged = seconds, charged
        self._since: float | None = None

    def begin(self, craft: Craft, now: float) -> None:
        """Come up and wait."""
        craft.surface()
        self._since = now if self._since is None else self._since

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the battery is full."""
        taken = now - (self._since or 0.0)
        if taken < self._seconds:
            return False
        self._charged()
        charge = craft.state().charge
        if charge is not None and charge < FULL and taken >= CHARGING * self._seconds + CHARGING_SPARE:
            raise FailureError(BATTERY_LOW, f"after {taken:.0f} s of charging the battery is at {charge:.0%}")
        return charge is None or charge >= FULL


class Use:
    """Command a device."""

    def __init__(self, device: str, action: int, parameter: float = 0.0, patience: float = 30.0) -> None:
        """Do the action of that number; its parameter means what the device says. Seconds to wait."""
        self._device, self._action, self._parameter = device, action, parameter
        self._patience = patience
        self._request: int | None = None
        self._until = 0.0

    def begin(self, craft: Craft, now: float) -> None:
        """Command the device, once."""
        if self._request is None:
            self._request = craft.operate(self._device, self._action, self._parameter)
            self._until = now + self._patience

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the device has done it."""
        state = craft.state().devices.get(self._request or 0, "NONE")
        if state == "FAILED":
            raise FailureError(DEVICE_SILENT, f"'{self._device}' cannot do it")
        if state != "REACHED" and now >= self._until:
            raise FailureError(DEVICE_SILENT, f"'{self._device}': no answer for {self._patience:g} s")
        return state == "REACHED"


Sight = Callable[[str], "Vector | None"]
"""Where an object of that name is seen, or was lately: metres north, east and down; None: it is not."""


class Seek:
    """Go to an object, where it is detected within `within` metres of its expected position.

    What looks the same and is farther away is passed by.
    """

    def __init__(
        self,
        name: str,
        expected: Vector,
        tolerance: float | None,
        sight: Sight,
        way: Callable[[Vector, bool], Duty],
        reported: Vector | None = None,
    ) -> None:
        """Seek an object.

        Args:
            name: as it is called by who sees it.
            expected: metres north, east and below the surface.
            tolerance: None: it may be anywhere.
            sight: who sees it.
            way: how to get to it where it is; False: to where it is expected, to see it from there.
            reported: where another robot has detected it, so that it is sought there first; None: unknown.
        """
        self._name, self._expected, self._tolerance = name, expected, tolerance
        self._sight, self._way = sight, way
        self._reported, self._far = reported, ""
        self._towards = way(expected if reported is None else reported, False)
        self._found = False
        self._figures = [False, True]
        self._searching = False

    def begin(self, craft: Craft, now: float) -> None:
        """Set out, or resume.

        Raises:
            FailureError: others have seen it farther from where it is expected than it may be.
        """
        if self._reported is not None and self._is_far(self._reported):
            raise FailureError(OBJECT_NOT_FOUND, self._far)
        if self._searching and not self._found:
            self._search(craft)
        else:
            self._towards.begin(craft, now)

    def done(self, craft: Craft, now: float) -> bool:
        """Return whether the vehicle is there."""
        place = None if self._found else self._sight(self._name)
        if place is not None and not self._is_far(place):
            self._found, self._towards = True, self._way(place, True)
            self._towards.begin(craft, now)
            return False
        if self._found or not self._searching:
            if not self._towards.done(craft, now):
                return False
            if self._found:
                return True
        elif craft.state().progress not in ("REACHED", "FAILED"):
            return False
        if not self._figures:
            raise FailureError(
                OBJECT_NOT_FOUND, self._far or f"object {self._name!r} is not seen where it is expected"
            )
        self._searching = True
        self._search(craft, self._figures.pop(0))
        return False

    def _search(self, craft: Craft, along: bool = False) -> None:
        """Look around on the spot, or along a spiral."""
        here = craft.state()
        heading = None if along else here.heading
        craft.search(here.north, here.east, max(0.0, here.depth), heading=heading)

    def _is_far(self, place: Vector) -> bool:
        """Return whether that cannot be the object, since it is too far from where it is expected."""
        away = dist(place, self._expected)
        if self._tolerance is None or away <= self._tolerance:
            return False
        self._far = f"object {self._name!r} is {away:.1f} m from where it is expected"
        return True


class ThrusterNews:
    """Notices which thrusters have failed since it was asked last, and which work again."""

    def __init__(self, craft: Craft, sheet: Sheet) -> None:
        """Take all for well."""
        self._craft, self._thrusters = craft, sheet.thrusters
        self._failed: frozenset[int] = frozenset()

    def news(self) -> tuple[tuple[str, str], ...]:
        """Return for each how grave it is, in a word of MAVLink's, and a sentence."""
        failed, before = self._craft.state().failed, self._failed
        self._failed = failed
        return tuple(
            _news(self._thrusters[number].id, number in failed) for number in sorted(failed ^ before)
        )


def _news(thruster: str, failed: bool) -> tuple[str, str]:
    grave, what = ("ERROR", "has failed") if failed else ("NOTICE", "works again")
    return grave, f"thruster '{thruster}' {what}"
