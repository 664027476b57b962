"""Distances and directions between places, on the ellipsoid: exact to a millionth over a kilometre."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, remainder

from .vocabulary import Geographic, Local, Place


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Return the metres of a degree northwards and eastwards on WGS 84, to a few centimetres."""
    phi = radians(latitude)
    north = 111_132.954 - 559.822 * cos(2 * phi) + 1.175 * cos(4 * phi)
    east = 111_412.84 * cos(phi) - 93.5 * cos(3 * phi) + 0.118 * cos(5 * phi)
    return north, east


def wrapped(longitude: float) -> float:
    """Return a longitude, or a difference of two, between -180 and 180 degrees, without rounding.

    >>> wrapped(-179.5 - 179.5)
    1.0
    """
    return remainder(longitude, 360.0)


def offset(a: Place, b: Place) -> tuple[float, float, float]:
    """Return how far `b` is north, east and up of `a`, metres.

    Raises:
        ValueError: one is geographic and the other is not.
    """
    if isinstance(a, Geographic) and isinstance(b, Geographic):
        northwards, eastwards = metres_per_degree((a.latitude + b.latitude) / 2.0)
        north, east = (b.latitude - a.latitude) * northwards, wrapped(b.longitude - a.longitude) * eastwards
        return north, east, b.height - a.height
    if isinstance(a, Local) and isinstance(b, Local):
        return b.north - a.north, b.east - a.east, b.height - a.height
    raise ValueError(f"{a} and {b} have no common frame")


def distance(a: Place, b: Place) -> float:
    """Return the metres between two places."""
    return hypot(*offset(a, b))


def bearing(a: Place, b: Place) -> float:
    """Return the direction from one place to another, degrees clockwise from north."""
    north, east, _ = offset(a, b)
    return degrees(atan2(east, north)) % 360.0


def turn(first: float, last: float) -> float:
    """Return the degrees to turn from one heading to another, clockwise positive, -180 to 180."""
    return (last - first + 180.0) % 360.0 - 180.0


def between(a: Place, b: Place, part: float) -> Place:
    """Return the position at a fraction of the straight line, 0 at `a` and 1 at `b`."""
    if isinstance(a, Geographic) and isinstance(b, Geographic):
        latitude = a.latitude + (b.latitude - a.latitude) * part
        # Meridians converge: a degree of the part's longitude is as long as at the part's middle.
        _, whole = metres_per_degree((a.latitude + b.latitude) / 2.0)
        _, partial = metres_per_degree((a.latitude + latitude) / 2.0)
        longitude = wrapped(a.longitude + wrapped(b.longitude - a.longitude) * part * whole / partial)
        return Geographic(latitude, longitude, a.height + (b.height - a.height) * part)
    north, east, up = offset(a, b)
    assert isinstance(a, Local)
    return Local(a.north + north * part, a.east + east * part, a.height + up * part)


def distance_to_leg(here: Place, a: Place, b: Place) -> float:
    """Return the metres from a place to a straight leg."""
    along, leg = offset(a, here), offset(a, b)
    square = sum(each * each for each in leg)
    part = sum(x * y for x, y in zip(along, leg, strict=True)) / square if square else 0.0
    return distance(here, between(a, b, min(1.0, max(0.0, part))))


def at_height(place: Place, height: float) -> Place:
    """Return the position above or below another at that height."""
    if isinstance(place, Geographic):
        return Geographic(place.latitude, place.longitude, height)
    return Local(place.north, place.east, height)


def ends_of(here: Place, target: Place, legs: str, short: float) -> tuple[Place, ...]:
    """Return the ends of the straight legs to a target, the last one `short` metres before it."""
    corners = {
        "level first": (at_height(target, here.height),),
        "climb first": (at_height(here, target.height),),
    }.get(legs, ())
    last = corners[-1] if corners else here
    left = distance(last, target)
    if short <= 0.0 or left == 0.0:
        return (*corners, target)
    return (*corners, between(last, target, max(0.0, 1.0 - short / left)))
