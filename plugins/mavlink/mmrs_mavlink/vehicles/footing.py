"""Where a vehicle stands before it takes off: at the home of its program, or where that has landed it."""

from __future__ import annotations

from math import hypot

from mmrs_runtime.controllers.geodesy import offset

from ..program import Geographic, Place

ELSEWHERE = 5.0
"""Metres from home from which on a place where a program lands is another place."""

LANDED = "where its program has landed it"


def footing(home: Place, landed: Place) -> Place:
    """Return where a vehicle stands that its program has landed: home, where that is there."""
    return landed if aside(home, landed) > ELSEWHERE else home


def aside(a: Place, b: Place) -> float:
    """Return the metres between two places, whatever their heights."""
    return hypot(*offset(a, b)[:2])


def misplaced(home: Place, start: Place, here: Place, tolerance: float) -> str:
    """Return that a vehicle does not stand where it is to take off, and where to carry it; or nothing.

    Args:
        home: of its program.
        start: where it is to take off.
        here: where it is.
        tolerance: metres that it may be from there.
    """
    away = aside(start, here)
    if away <= tolerance:
        return ""
    place = "its home" if start == home else LANDED
    return f"it stands {away:.0f} m from {place}: carry it {there(start, home)}"


def there(start: Place, home: Place) -> str:
    """Return the direction to a vehicle's take-off position, as printed.

    >>> there(Geographic(42.3706, 13.35, 0.0), Geographic(42.37, 13.35, 0.0))
    'to 42.370600, 13.350000'
    """
    if start == home:
        return "home"
    if isinstance(start, Geographic):
        return f"to {start.latitude:.6f}, {start.longitude:.6f}"
    return f"{start.north:.1f} m north and {start.east:.1f} m east of its home"
