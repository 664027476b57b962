"""Routes among random obstacles keep their distance, sampled along their legs, and are not much too long."""

from itertools import pairwise
from math import inf

import numpy as np
import pytest
import shapely

from mmrs_core.errors import UnreachableError
from mmrs_core.planning import visibility
from mmrs_core.planning.paths import Space
from mmrs_core.scene import Area, AreaUse
from mmrs_core.scene.timing import Rates

CLEARANCE = 1.0


def areas(rng, count, size):
    for k in range(count):
        turns = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 8))))
        ring = (
            rng.uniform(0, size, 2)
            + rng.uniform(3, 25, (len(turns), 1)) * np.c_[np.cos(turns), np.sin(turns)]
        )
        low = -inf if rng.random() < 0.8 else 8.0
        high = float(rng.choice([10.0, 20.0, 35.0, inf]))
        shell = tuple((float(x), float(y)) for x, y in ring)
        yield Area(f"area {k}", AreaUse.OBSTACLE, shell, low, high, float(rng.uniform(0, 4)))


def sampled_margin(route, area):
    """The least distance kept, less what is required, at a point every half metre."""
    worst = inf
    shape = shapely.Polygon(area.shell)
    for one, two in pairwise(route):
        count = int(np.linalg.norm(np.subtract(two, one)) / 0.5) + 2
        places = np.linspace(one, two, count)
        sideways = shapely.distance(shapely.points(places[:, :2]), shape)
        upright = np.abs(places[:, 2] - np.clip(places[:, 2], area.low, area.high))
        worst = min(worst, float(np.hypot(sideways, upright).min()))
    return worst - area.safety_distance - CLEARANCE


def check(seed):
    rng = np.random.default_rng(seed)
    size = float(rng.uniform(100, 400))
    around = tuple(areas(rng, int(rng.integers(1, 25)), size))
    space = Space(around, CLEARANCE, 2.0, 30.0, rates=Rates(8.0, 3.0, 2.0))
    for _ in range(12):
        start, goal = ((*rng.uniform(0, size, 2).tolist(), float(rng.uniform(2, 30))) for _ in range(2))
        try:
            route = space.route(start, goal)
        except UnreachableError:
            continue
        assert (route[0], route[-1]) == (start, goal)
        assert min(sampled_margin(route, area) for area in around) >= -1e-9
        assert all(2.0 <= point[2] <= 30.0 for point in route)
        assert space.seconds(route) >= space.rates.even(start, goal) - 1e-9


@pytest.mark.parametrize("seed", range(10))
def test_routes_keep_their_distance(seed):
    check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(10, 220))
def test_many_routes_keep_their_distance(seed):
    check(seed)


@pytest.mark.parametrize("seed", range(12))
def test_a_way_that_exists_by_construction_is_found(seed, monkeypatch):
    """Convex obstacles with room to pass between any two: there is always a way in the plane.

    To compile the search takes longer than all else here, and it finds the same (`test_shortest_paths`).
    """
    monkeypatch.setattr(visibility, "can_compile", lambda: False)
    rng = np.random.default_rng(seed)
    around = []
    for east in range(0, 400, 50):
        for north in range(0, 400, 50):
            turns = np.arange(5) * 2 * np.pi / 5 + rng.uniform(0, 1)
            centre = np.array([east, north]) + rng.uniform(-4, 4, 2)
            ring = centre + rng.uniform(4, 12) * np.c_[np.cos(turns), np.sin(turns)]
            shell = tuple((float(x), float(y)) for x, y in ring)
            around.append(Area(f"{east} {north}", AreaUse.FORBIDDEN, shell, safety_distance=3.0))
    space = Space(around, CLEARANCE)
    start, goal = (-40.0, 75.0 + seed, 10.0), (430.0, 220.0 - 3 * seed, 10.0)
    route = space.route(start, goal)
    assert space.seconds(route) < 1.1 * np.hypot(470.0, 145.0 - 4 * seed)
