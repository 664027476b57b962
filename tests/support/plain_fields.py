"""Fields of stops in the plane, for searches of tours and orders."""

from itertools import chain
from math import dist, inf
from random import Random

import numpy as np

from mmrs_core.planning.ruin_loops import Field


def field(homes, stops, **features):
    """Return a field in the plane for robots of one kind that go 1 m/s."""
    n, m = len(stops), len(homes)
    out = [dist(home, stop) for home in homes for stop in stops]
    near = [sorted(set(range(n)) - {i}, key=lambda j, i=i: dist(stops[i], stops[j])) for i in range(n)]
    plain = {
        "sizes": [n, m, n - 1, m, 0, 0],
        "kinds": [0] * m,
        "out": out,
        "go": [dist(one, two) for one in stops for two in stops],
        "back": out,
        "work": [0.0] * n,
        "near": [*chain.from_iterable(near)],
        "near_robots": [*range(m)] * n,
        "apart": [],
        "limits": [inf] * m,
        "recharges": [0.0] * m,
        "earliest": [0.0] * n,
        "deadlines": [inf] * n,
        "ranks": [0] * n,
    }
    whole = ("sizes", "kinds", "near", "near_robots", "apart", "ranks")
    given = {**plain, **features}
    return Field(**{k: np.array(v, np.int64 if k in whole else np.float64) for k, v in given.items()})


def places(count, seed):
    random = Random(seed)
    return [(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0)) for _ in range(count)]
