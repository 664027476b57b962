"""Swaths over random concave polygons with holes and obstacles cover them, and stay inside."""

import numpy as np
import pytest
import shapely

from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.polygons import parts
from mmrs_core.planning.swaths import swaths


def target(seed):
    rng = np.random.default_rng(seed)
    corners = int(rng.integers(3, 14))
    angles = np.sort(rng.uniform(0.0, 2 * np.pi, corners))
    radii = rng.uniform(30.0, 300.0, corners)
    whole = shapely.make_valid(shapely.Polygon(np.c_[radii * np.cos(angles), radii * np.sin(angles)]))
    taken = []
    for _ in range(int(rng.integers(0, 6))):
        centre, turns = rng.uniform(-150, 150, 2), np.sort(rng.uniform(0, 2 * np.pi, 4))
        ring = centre + rng.uniform(4, 40, (4, 1)) * np.c_[np.cos(turns), np.sin(turns)]
        taken.append(grow([tuple(corner) for corner in ring], float(rng.uniform(0, 10))))
    left = shapely.difference(whole, shapely.union_all(taken, grid_size=1e-6), grid_size=1e-6)
    return parts(left, 1e-6), float(rng.uniform(2.0, 60.0))


def check(seed):
    pieces, width = target(seed)
    if not pieces:
        return
    lines = swaths(pieces, width)
    whole = shapely.union_all(pieces, grid_size=1e-6)
    strips = [
        shapely.buffer(shapely.LineString(leg), width / 2, cap_style="flat")
        for line in lines
        for leg in np.stack([line.points[:-1], line.points[1:]], axis=1)
    ]
    covered = shapely.intersection(whole, shapely.union_all(strips, grid_size=1e-6), grid_size=1e-6)
    assert covered.area / whole.area >= 0.999
    edge = shapely.buffer(whole, 1e-4)
    assert all(edge.covers(shapely.LineString(line.points)) for line in lines)


@pytest.mark.parametrize("seed", range(40))
def test_a_random_target_is_covered_from_inside(seed):
    check(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(40, 440))
def test_many_random_targets_are_covered_from_inside(seed):
    check(seed)
