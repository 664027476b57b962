"""A bound on the longest of several tours, by the best tours to a few of the places.

Tours that come to all places come to these, and are no longer where the others are left out. So the best
tours to few places are a bound on any to all. They are found exactly: how long each robot's shortest tour to
each set of them is (Held and Karp, "A dynamic programming approach to sequencing problems", J. SIAM 10,
1962), then robot by robot which set is left for it.

The bound is high where robots have far to go to few places, where that of `forests` is low. Two sorts of
places are tried, from each of the places most distant from all homes on: those around it, distant ones
rather than near ones; and those each as far as can be from homes and from the ones before, so that tours
have to cross (Gonzalez, "Clustering to minimize the maximum intercluster distance", Theor. Comput. Sci. 38,
1985).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

_FEW = 8
"""Places of one set: the seconds that it takes grow threefold with each."""

_BEGINS = 8
"""Places from which sets of each sort begin."""

_ROBOTS = 16
"""Robots that count as they are; all others as one each for any place, as near to it as the nearest."""

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


def longest_to_few(between: Array, there: Array, back: bool) -> float:
    """Return seconds that the longest of several tours does not fall below.

    Each place is one robot's. Seconds must keep to the triangle inequality.

    Args:
        between: (n, n), seconds between places, alike in both directions.
        there: (m, n), seconds from homes to places.
        back: whether all robots return home.
    """
    sets = {tuple(sorted(each.tolist())) for each in _sets(between, there.min(axis=0))}
    found = (_exact(between[np.ix_(each, each)], _fewer(there[:, each]), back) for each in map(list, sets))
    return max(found, default=0.0)


def _sets(between: Array, nearest: Array) -> Iterator[Indices]:
    few = min(_FEW, len(nearest))
    for first in np.argsort(-nearest, kind="stable")[:_BEGINS].tolist():
        yield np.argsort(between[first] - nearest, kind="stable")[:few]
        chosen, away = [first], np.minimum(nearest, between[first])
        while len(chosen) < few:
            away[chosen] = -1.0
            chosen.append(int(away.argmax()))
            away = np.minimum(away, between[chosen[-1]])
        yield np.array(chosen)


def _fewer(there: Array) -> Array:
    """Return the same for fewer robots, which are nowhere further away than these."""
    robots, places = there.shape
    if robots <= _ROBOTS + places:
        return there
    near = np.argsort(there.min(axis=1), kind="stable")
    others = there[near[_ROBOTS:]].min(axis=0)
    return np.concatenate([there[near[:_ROBOTS]], np.broadcast_to(others, (places, places))])


def _exact(between: Array, there: Array, back: bool) -> float:
    """Return the longest tour of the best tours to all of few places."""
    robots, places = there.shape
    last = np.full((1 << places, robots, places), np.inf)
    last[1 << np.arange(places), :, np.arange(places)] = there.T
    for some in range(1, 1 << places):
        other = np.array([i for i in range(places) if not some >> i & 1], np.intp)
        further = (last[some][:, :, None] + between).min(axis=1)
        new = some | 1 << other
        last[new, :, other] = np.minimum(last[new, :, other], further[:, other].T)
    tours = (last + there if back else last).min(axis=2)
    tours[0] = 0.0
    whole, part, begins = _parts(places)
    longest = np.full(1 << places, np.inf)
    longest[0] = 0.0
    for robot in range(robots):
        longest = np.minimum.reduceat(np.maximum(longest[whole ^ part], tours[part, robot]), begins)
    return float(longest[-1])


@cache
def _parts(places: int) -> tuple[Indices, Indices, Indices]:
    """Return each set of places and each part of it, both as bits, and where the parts of a set begin."""
    bits = np.arange(1 << places)
    whole, part = np.nonzero((bits[None, :] & ~bits[:, None]) == 0)
    return whole, part, np.searchsorted(whole, bits)
