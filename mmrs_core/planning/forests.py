"""A bound on the longest of several tours, by shortest forests with multipliers.

Let `a` robots have a tour each that begins at its home. Without the legs from and to homes, tours are paths:
a forest of `a` trees that spans all places. Its length is at least that of a shortest spanning tree (Prim,
"Shortest connection networks and some generalizations", Bell Syst. Tech. J. 36, 1957) less its `a` - 1
longest edges. The legs from and to homes are at least as long as those of the `a` robots that are nearest to
any place. So the longest tour takes at least the sum of these and of all work, divided by `a`, for whichever
`a` that is least.

In tours, each place has two legs; in a forest it may have one or many. A multiplier is added to all legs at a
place and twice subtracted from the sum: that changes no tour, only which forest is shortest. Any multipliers
give a bound, and good ones raise it: Held and Karp, "The traveling-salesman problem and minimum spanning
trees", Oper. Res. 18 (1970), and their ascent along the numbers of legs less two in part II, Math. Program. 1
(1971).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

_ROUNDS = 60

_MOST_EDGES = 20_000_000
"""Edges that all rounds together look at, at most."""

Array = NDArray[np.float64]


def least_longest(between: Array, there: Array, back: bool, work: float) -> float:
    """Return seconds that the longest of several tours does not fall below.

    Each place is one robot's. Seconds must keep to the triangle inequality: then no tour is shorter for
    passing a place twice.

    Args:
        between: (n, n), seconds between places, alike in both directions.
        there: (m, n), seconds from homes to places.
        back: whether all robots return home.
        work: seconds at all places together.
    """
    extra, best, length = np.zeros(len(between)), 0.0, 0.0
    for turn in range(rounds := 1 + min(_ROUNDS, _MOST_EDGES // between.size)):
        edges, ends = spanning_tree((between + extra[:, None] + extra).__getitem__, len(extra))
        first = (there + extra).argmin(axis=1)
        out = (there + extra)[np.arange(len(there)), first]
        last = out if back else np.full(len(out), extra.min())
        robots = np.argsort(out, kind="stable")
        means = shared(edges, (out + last)[robots[: len(extra)]], work - 2.0 * float(extra.sum()))
        active = int(means.argmin()) + 1
        best = max(best, float(means[active - 1]))
        legs = np.bincount(ends[np.argsort(edges)[: len(edges) - active + 1]].ravel(), minlength=len(extra))
        np.add.at(legs, first[robots[:active]], 1)
        np.add.at(legs, first[robots[:active]] if back else np.full(active, extra.argmin()), 1)
        beyond = legs - 2
        if turn + 1 == rounds or not beyond.any():
            break
        length = 0.05 * best * active if turn == 0 else 0.95 * length
        extra += length * beyond / float(beyond @ beyond)
    return best


def shared(edges: Array, ways: Array, work: float) -> Array:
    """Return the mean tour of 1, 2, … robots, by edges of a tree and ways of robots from and to home.

    There may be more robots than places, where these can be shared.
    """
    robots = len(ways)
    forests = np.concatenate([np.cumsum(np.sort(edges))[::-1], np.zeros(robots)])[:robots]
    means: Array = (forests + np.cumsum(np.sort(ways)) + work) / np.arange(1, robots + 1)
    return means


def spanning_tree(lengths_from: Callable[[int], Array], count: int) -> tuple[Array, NDArray[np.int64]]:
    """Return (count - 1) lengths and (count - 1, 2) ends of the edges of a shortest spanning tree."""
    near, comes_from = lengths_from(0).copy(), np.zeros(count, np.int64)
    near[0], left = np.inf, np.ones(count, np.bool_)
    left[0] = False
    edges, ends = np.zeros(count - 1), np.zeros((count - 1, 2), np.int64)
    for i in range(count - 1):
        nearest = int(near.argmin())
        edges[i], ends[i] = near[nearest], (comes_from[nearest], nearest)
        left[nearest], near[nearest] = False, np.inf
        row = lengths_from(nearest)
        closer = (row < near) & left
        np.copyto(near, row, where=closer)
        comes_from[closer] = nearest
    return edges, ends
