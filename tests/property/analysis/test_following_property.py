"""Whether a path follows a line agrees with the same question asked of dense samples of both."""

from itertools import pairwise
from math import dist, inf

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.analysis.following import Piece, Tube

STEP = 0.25
places = st.tuples(st.integers(-8, 8), st.integers(-8, 8)).map(lambda at: (float(at[0]), float(at[1])))
heights = st.sampled_from([0.0, 2.0, 4.0])
paths = st.lists(st.tuples(places, heights), min_size=2, max_size=6)
lines = st.lists(places, min_size=2, max_size=4, unique=True)


def sampled(points):
    """Return places along a polyline, a step from each other at most."""
    rows = [np.linspace(a, b, max(2, int(np.ceil(dist(a, b) / STEP)) + 1)) for a, b in pairwise(points)]
    return np.concatenate(rows)


def follows_sampled(path, line, aside, low, high):
    """Return the same by a discrete free-space diagram: steps forwards along one, the other, or both."""
    near = np.linalg.norm(path[:, None, :2] - line[None], axis=2) <= aside
    near &= ((low <= path[:, 2]) & (path[:, 2] <= high))[:, None]
    reached = np.zeros(near.shape, bool)
    for i in range(len(path)):
        for j in range(len(line)):
            before = j == 0 or reached[i, j - 1] or (i > 0 and (reached[i - 1, j] or reached[i - 1, j - 1]))
            reached[i, j] = near[i, j] and before
    return bool(reached[:, -1].any())


@given(paths, lines, st.floats(0.2, 6.0), st.sampled_from([(-inf, inf), (-1.0, 3.0), (1.0, inf)]))
def test_following_agrees_with_dense_samples(path, line, aside, band):
    points = [(*place, up) for place, up in path]
    pieces = [Piece(a, b, k) for k, (a, b) in enumerate(pairwise(points))]
    found = Tube(tuple(line), aside, *band).follows(pieces)[0]
    one, other = sampled(points), sampled([(*place, 0.0) for place in line])[:, :2]
    if follows_sampled(one, other, aside - 1e-6, *band):
        assert found
    if found:
        assert follows_sampled(one, other, aside + 2.0 * STEP, band[0] - STEP * 4, band[1] + STEP * 4)


@given(paths, lines, st.floats(0.2, 6.0))
def test_following_with_something_to_spare_is_following_a_narrower_line(path, line, aside):
    pieces = [Piece((*a[0], a[1]), (*b[0], b[1]), 0) for a, b in pairwise(path)]
    for spare in (-1.0, 0.1):
        expected = Tube(tuple(line), aside - spare, -1.0 + spare, 3.0 - spare).follows(pieces)[0]
        assert Tube(tuple(line), aside, -1.0, 3.0).follows(pieces, spare)[0] == expected


@given(paths, lines)
def test_a_line_is_followed_by_itself_whatever_comes_before_and_after(path, line):
    before = [(*place, 0.0) for place, _ in path]
    points = [*before, *((*place, 0.0) for place in line), *reversed(before)]
    pieces = [Piece(a, b, 0) for a, b in pairwise(points)]
    assert Tube(tuple(line), 0.0).follows(pieces)[0]
