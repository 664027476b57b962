"""Random shapes on a plane, in metres."""

from math import cos, hypot, pi, sin
from random import Random

import shapely


def star(random: Random, centre: tuple[float, float], radius: float, corners: int, dent: float = 0.4):
    """Return a simple ring around a centre; the larger `dent` (0 to 1), the more concave."""
    angles = sorted((k + random.uniform(-0.3, 0.3)) * 2 * pi / corners for k in range(corners))
    ring = []
    for angle in angles:
        reach = radius * random.uniform(1 - dent, 1)
        ring.append((round(centre[0] + reach * cos(angle), 3), round(centre[1] + reach * sin(angle), 3)))
    return ring


def separated(random: Random, count: int, size: float, radii: tuple[float, float], gap: float, taken: list):
    """Return discs (x, y, r) that keep a gap from each other and from those already taken."""
    found = []
    for _ in range(count * 30):
        if len(found) == count:
            break
        radius = random.uniform(*radii)
        x, y = random.uniform(-size, size), random.uniform(-size, size)
        if all(hypot(x - a, y - b) >= radius + r + gap for a, b, r in [*taken, *found]):
            found.append((x, y, radius))
    return found


def ngon(centre: tuple[float, float], radius: float, corners: int, turn: float):
    """Return a convex ring: a regular polygon."""
    return [
        (
            round(centre[0] + radius * cos(turn + k * 2 * pi / corners), 3),
            round(centre[1] + radius * sin(turn + k * 2 * pi / corners), 3),
        )
        for k in range(corners)
    ]


def contains(shell, hole):
    """Return whether a ring lies inside another one."""
    return shapely.Polygon(shell).contains_properly(shapely.Polygon(hole))


def area(shell, holes=()):
    """Return the area of a polygon in square metres."""
    return shapely.Polygon(shell, holes).area
