"""Routes among random relays and areas stay in range, and are found where there are any."""

from heapq import heappop, heappush
from itertools import pairwise
from math import dist, hypot, inf

import numpy as np
import pytest
import shapely
from plain_scenes import box

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.paths import Space
from mmrs_core.planning.reach import Reach
from mmrs_core.scene.timing import Rates

CLEARANCE = 1.0
CELL = 5.0
"""Metres between the places of the grid that routes are compared with."""


def relays(rng, tall):
    """Return a chain of balls, each with its centre in an earlier one."""
    balls = [((0.0, 0.0, 0.0), 100.0)]
    for _ in range(int(rng.integers(1, 5))):
        (east, north, up), radius = balls[int(rng.integers(len(balls)))]
        turn, away = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.5, 0.95) * radius
        rise = float(rng.uniform(0.0, 60.0)) if tall else 0.0
        place = (east + away * float(np.sin(turn)), north + away * float(np.cos(turn)), up + rise)
        balls.append((place, float(rng.uniform(60.0, 110.0))))
    return Reach(("", *map(str, range(1, len(balls)))), *map(tuple, zip(*balls, strict=True)))


def walls(rng, reach):
    for k in range(int(rng.integers(0, 5))):
        east, north, _ = reach.centres[int(rng.integers(len(reach.centres)))]
        west, south = east + rng.uniform(-80.0, 80.0), north + rng.uniform(-80.0, 80.0)
        wide, deep = rng.uniform(4.0, 60.0, 2)
        high = float(rng.choice([15.0, 40.0, inf]))
        yield box(f"wall {k}", west, south, west + wide, south + deep, high=high, safety=0.0)


def inside(reach, places):
    away = np.linalg.norm(np.asarray(places)[:, None] - np.array(reach.centres), axis=2)
    return (np.array(reach.ranges) - away).max(axis=1)


def place_in(rng, reach, space, up):
    for _ in range(100):
        east, north, _ = reach.centres[int(rng.integers(len(reach.centres)))]
        place = (east + float(rng.uniform(-100, 100)), north + float(rng.uniform(-100, 100)), up)
        if inside(reach, [place])[0] > 0.0 and space.is_clear((place,)):
            return place
    pytest.skip("no clear place in range")


@pytest.mark.parametrize("seed", range(40))
def test_routes_stay_in_range_and_clear(seed):
    rng = np.random.default_rng(seed)
    reach = relays(rng, tall=True)
    space = Space(walls(rng, reach), CLEARANCE, 0.0, 60.0, rates=Rates(8.0, 3.0, 2.0)).within(reach)
    for _ in range(6):
        ends = [place_in(rng, reach, space, float(rng.uniform(0.0, 60.0))) for _ in range(2)]
        try:
            route = space.route(*ends)
        except UnreachableError:
            continue
        assert [route[0], route[-1]] == ends
        assert space.is_clear(route)
        for one, two in pairwise(route):
            assert inside(reach, np.linspace(one, two, 300)).min() >= -1e-6


@pytest.mark.parametrize("seed", range(40))
def test_a_route_in_the_plane_is_found_where_a_grid_has_one_and_is_not_longer(seed):
    rng = np.random.default_rng(1000 + seed)
    reach = relays(rng, tall=False)
    areas = tuple(walls(rng, reach))
    space = Space(areas, CLEARANCE, 0.0, 0.0).within(reach)
    for _ in range(3):
        ends = [place_in(rng, reach, space, 0.0) for _ in range(2)]
        least = along_grid(reach, areas, *ends)
        try:
            route = space.route(*ends)
        except UnreachableError:
            assert least == inf
            continue
        assert sum(dist(a, b) for a, b in pairwise(route)) <= least + 1e-6


def along_grid(reach, areas, start, goal):
    """Return the metres of the shortest path by neighbouring cells well in range and clear; inf: none."""
    centres, most = np.array(reach.centres), max(reach.ranges)
    low = centres[:, :2].min(axis=0) - most
    columns, rows = (np.ptp(centres[:, :2], axis=0) + 2.0 * most) // CELL + 1
    x, y = np.meshgrid(np.arange(columns) * CELL + low[0], np.arange(rows) * CELL + low[1], indexing="ij")
    places = np.stack([x, y, np.zeros_like(x)], axis=2)
    free = inside(reach, places.reshape(-1, 3)).reshape(x.shape) > CELL
    for area in areas:
        shape = shapely.Polygon(area.shell)
        free &= shapely.distance(shapely.points(x, y), shape) > CLEARANCE + CELL
    first, last = (
        tuple(np.unravel_index(np.hypot(x - end[0], y - end[1]).argmin(), x.shape)) for end in (start, goal)
    )
    if not (free[first] and free[last]):
        return inf
    best, queue = {first: 0.0}, [(0.0, first)]
    while queue:
        length, here = heappop(queue)
        if here == last:
            ends = sum(dist(end[:2], places[at][:2]) for end, at in ((start, first), (goal, last)))
            return length + ends
        for i, j in ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)):
            there = (here[0] + i, here[1] + j)
            if 0 <= there[0] < x.shape[0] and 0 <= there[1] < x.shape[1] and free[there]:
                further = length + CELL * hypot(i, j)
                if further < best.get(there, inf):
                    best[there] = further
                    heappush(queue, (further, there))
    return inf
