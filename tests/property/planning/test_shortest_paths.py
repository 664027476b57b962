"""Paths in the plane are as short as those in a full graph of visibility, which shares no code with them."""

from heapq import heappop, heappush
from itertools import pairwise
from math import dist, inf

import numpy as np
import pytest
import shapely

from mmrs_core.geometry.clearance import EPSILON, grow
from mmrs_core.planning import visibility
from mmrs_core.planning.obstacles import Obstacles
from mmrs_core.planning.visibility import Visibility
from mmrs_core.scene import Area, AreaUse

CLEARANCE = 1.0


def ring_of(rng, size):
    """Return a star, or a box on a coarse raster: boxes touch, share sides and lie within others."""
    if rng.random() < 0.4:
        west, south = (10.0 * rng.integers(0, size // 10, 2)).tolist()
        wide, high = (10.0 * rng.integers(1, 4, 2)).tolist()
        return [(west, south), (west + wide, south), (west + wide, south + high), (west, south + high)]
    count = int(rng.integers(3, 9))
    turns = np.sort(rng.uniform(0, 2 * np.pi, count))
    ring = rng.uniform(0, size, 2) + rng.uniform(1, 18, (count, 1)) * np.c_[np.cos(turns), np.sin(turns)]
    return [tuple(place) for place in ring.tolist()]


def horseshoe(rng, size):
    x, y = rng.uniform(0, size, 2)
    ring = [(0, 0), (30, 0), (30, 30), (20, 30), (20, 8), (10, 8), (10, 30), (0, 30)]
    return [(float(x + a), float(y + b)) for a, b in ring]


def scene(seed):
    rng = np.random.default_rng(seed)
    size = 60.0 + 10.0 * (seed % 5)
    rings = [ring_of(rng, size) for _ in range(int(rng.integers(1, 9)))]
    rings += [horseshoe(rng, size)] if seed % 3 == 0 else []
    blocked = shapely.union_all([grow(ring, CLEARANCE, margin=EPSILON) for ring in rings])
    ends = []
    while len(ends) < 6:
        place = tuple(rng.uniform(-10, size + 10, 2).tolist())
        if not blocked.intersects(shapely.Point(place)):
            ends.append(place)
    return rings, list(zip(ends[::2], ends[1::2], strict=True))


def metres_by_brute_force(rings, start, goal):
    """Dijkstra over all pairs of corners of grown shapes that see each other."""
    larger = [grow(ring, CLEARANCE, margin=EPSILON) for ring in rings]
    blocked = shapely.union_all([grow(ring, CLEARANCE, margin=EPSILON - 1e-8) for ring in rings])
    corners = np.unique(np.concatenate([shapely.get_coordinates(shape) for shape in larger]), axis=0)
    free = corners[~shapely.intersects_xy(blocked, corners[:, 0], corners[:, 1])]
    places = np.concatenate([[start, goal], free])
    best, queue, done = {0: 0.0}, [(0.0, 0)], set()
    shapely.prepare(blocked)
    while queue:
        metres, here = heappop(queue)
        if here == 1:
            return metres
        if here in done:
            continue
        done.add(here)
        lines = shapely.linestrings(np.stack([np.broadcast_to(places[here], places.shape), places], axis=1))
        for there in np.flatnonzero(~shapely.intersects(blocked, lines)).tolist():
            reached = metres + dist(places[here], places[there])
            if reached < best.get(there, inf):
                best[there] = reached
                heappush(queue, (reached, there))
    return None


def check(seed):
    rings, pairs = scene(seed)
    areas = [Area(f"area {i}", AreaUse.OBSTACLE, tuple(ring)) for i, ring in enumerate(rings)]
    visibility = Visibility(Obstacles(areas, CLEARANCE))
    drawn = shapely.union_all([shapely.make_valid(shapely.Polygon(ring)) for ring in rings])
    for start, goal in pairs:
        path = visibility.shortest_path(start, goal, np.ones(len(areas), np.bool_))
        metres = metres_by_brute_force(rings, start, goal)
        assert (path is None) == (metres is None)
        if path is not None:
            assert (path[0], path[-1]) == (start, goal)
            assert sum(dist(*leg) for leg in pairwise(path)) == pytest.approx(metres, rel=1e-9)
            assert shapely.LineString(path).distance(drawn) >= CLEARANCE


@pytest.mark.parametrize("seed", range(25))
def test_paths_are_shortest_and_clear(seed):
    check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(25, 500))
def test_many_paths_are_shortest_and_clear(seed):
    check(seed)


@pytest.mark.thorough
def test_paths_are_the_same_where_nothing_is_compiled(monkeypatch):
    pytest.importorskip("numba", reason="loops are compiled with numba (extra fast) only")

    def paths_with(many):
        monkeypatch.setattr(visibility, "_MANY", many)
        rings, pairs = scene(3)
        areas = [Area(f"area {i}", AreaUse.OBSTACLE, tuple(ring)) for i, ring in enumerate(rings)]
        found = visibility.Visibility(Obstacles(areas, CLEARANCE))
        return [found.shortest_path(*pair, np.ones(len(areas), np.bool_)) for pair in pairs]

    assert paths_with(0) == paths_with(10**9)
