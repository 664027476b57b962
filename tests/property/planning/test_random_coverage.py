"""Swaths over random concave polygons with holes and obstacles cover them, clear of the obstacles."""

from itertools import pairwise

import numpy as np
import pytest
import shapely

from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.polygons import parts
from mmrs_core.planning.patterns import Pattern, layers_of
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
    closed = shapely.union_all(taken, grid_size=1e-6)
    left = shapely.difference(whole, closed, grid_size=1e-6)
    return parts(left, 1e-6), closed, float(rng.uniform(2.0, 60.0)), float(rng.uniform(2.0, 60.0))


def rectangle(centre, ahead, length, width):
    """The corners of a rectangle along a direction, laid out by hand."""
    aside = np.array([-ahead[1], ahead[0]])
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return shapely.Polygon([centre + a * ahead * length / 2 + b * aside * width / 2 for a, b in signs])


def strips(line, width):
    """What a swath covers on its way."""
    for one, two in pairwise(line.points):
        far = np.hypot(*(two - one))
        yield rectangle((one + two) / 2, (two - one) / far, far, width)


def tiles(line, width, length):
    """What actions at the spots of a swath cover, each along the leg on which it is first met."""
    if len(line.points) == 1:
        yield shapely.Point(line.points[0]).buffer(min(width, length) / 2)
        return
    done, waiting = 0.0, list(line.spots)
    for one, two in pairwise(line.points):
        far = np.hypot(*(two - one))
        while waiting and waiting[0] <= done + far + 1e-6:
            ahead = (two - one) / far
            yield rectangle(one + ahead * (waiting.pop(0) - done), ahead, length, width)
        done += far
    assert not waiting


def share(pieces, shapes):
    whole = shapely.union_all(pieces, grid_size=1e-6)
    union = shapely.union_all(list(shapes), grid_size=1e-6)
    return shapely.intersection(whole, union, grid_size=1e-6).area / whole.area


def check(seed):
    pieces, closed, width, length = target(seed)
    if not pieces:
        return
    forbidden = shapely.buffer(closed, -1e-3)
    on_the_way = swaths(pieces, width, closed=closed)
    at_spots = swaths(pieces, width, length=length, closed=closed)
    assert share(pieces, (each for line in on_the_way for each in strips(line, width))) >= 0.9999
    assert share(pieces, (each for line in at_spots for each in tiles(line, width, length))) >= 0.9999
    for line in (*on_the_way, *at_spots):
        assert len(line.points) == 1 or not shapely.LineString(line.points).intersects(forbidden)
        assert (np.hypot(*np.diff(line.points, axis=0).T) >= 0.01).all()


def check_pattern(seed):
    pieces, closed, width, length = target(seed)
    if not pieces:
        return
    rng = np.random.default_rng(seed)
    corner = tuple(rng.choice([-1.0, 1.0], 2))
    pattern = Pattern(rng.uniform(0.0, np.pi), cross_hatch=True, corner=corner, alternate=bool(seed % 2))
    layers = layers_of(
        pattern,
        None,
        lambda angle, start: swaths(pieces, width, length=length, closed=closed, angle=angle, start=start),
    )
    assert len(layers) == 2
    for lines in layers:
        assert share(pieces, (each for line in lines for each in tiles(line, width, length))) >= 0.9999
    ends = np.array([line.points[[0, -1]] for line in layers[0]])
    assert layers[0][0].points[0] @ np.array(corner) == pytest.approx((ends @ np.array(corner)).max())


@pytest.mark.parametrize("seed", range(2))
def test_a_random_target_is_covered_clear_of_what_is_closed(seed):
    check(seed)


def test_a_random_target_is_covered_by_each_layer_of_a_pattern():
    check_pattern(6)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [2, 3, *range(14, 440)])
def test_many_random_targets_are_covered_clear_of_what_is_closed(seed):
    check(seed)
    check_pattern(seed)
