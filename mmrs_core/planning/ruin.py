"""Ruin and recreate: tours taken apart near one place and put together better, again and again.

Schrimpf, Schneider, Stamm-Wilbrandt and Dueck, "Record breaking optimization results using the ruin and
recreate principle", J. Comput. Phys. 159 (2000): remove some stops, insert them again, keep what is better or
only a little worse. What is removed and how it is inserted follow Christiaens and Vanden Berghe, "Slack
induction by string removals for vehicle routing problems", Transp. Sci. 54 (2020): strings of stops of
neighbouring tours; greedy insertion that overlooks a position now and then; simulated annealing. As the
longest tour counts here, every second step begins at one of its stops, and insertion shuns what makes a tour
longer than a limit between the mean and the longest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from random import Random
from types import ModuleType
from typing import Any

import numpy as np

from mmrs_core.geometry.compilation import can_compile, compiled
from mmrs_core.planning import ruin_loops
from mmrs_core.planning.effort import SLICE
from mmrs_core.planning.ruin_loops import Field, Room, Tours

_HOT, _COLD = 0.2, 0.002
"""Temperature at the beginning and at the end, as a share of the mean tour."""

_MANY = 50
"""Stops from which it is worth to compile the steps."""

_DENSE = 2_000
"""Stops up to which numbers stand in lists if they are not compiled: quicker than arrays, but larger."""


class Search:
    """A search for tours, step by step.

    Attributes:
        best: the best tours so far.
    """

    def __init__(self, field: Field, seed: int, weights: tuple[float, float] = (1.0, 0.1)) -> None:
        """Insert all stops once.

        Args:
            field: of the stops, in arrays.
            seed: of the random numbers.
            weights: of the longest tour, and of the mean of all.
        """
        n, m = field.sizes[:2]
        self._loops, self._field, listed = loops_for(field, ruin_loops)
        self._weights = weights
        whole = [np.zeros(count, np.int64) for count in (1, n, m + 1, m, m + 1, m)]
        random, gone, *rest = [each.tolist() if listed else each for each in whole]
        self._room = Room(random, gone, [0.0] * n if listed else np.zeros(n), *rest)
        self._now, self._other, self.best = (_none(n, m, listed) for _ in range(3))
        shuffled = Random(seed)
        self._room.random[0] = shuffled.randrange(1, 2**31 - 1)
        stops = list(range(n))
        shuffled.shuffle(stops)
        stops.sort(key=lambda each: -field.ranks[each])
        self._loops.construct(self._field, self._other, self._room, stops if listed else np.array(stops))
        everyone = list(range(m))
        for target in (self._now, self.best):
            robots = [*everyone, m]
            self._loops.follow(
                self._other, target, *((each if listed else np.array(each)) for each in (robots, [1] * m))
            )
        self._room.changed[m] = 0
        for robot in everyone:
            self._room.differs[robot] = 0
        self._mean = self._loops.mean_of(self._now)

    def run(self, shares: Iterable[float], steps: int = SLICE) -> Iterator[float]:
        """Yield the least makespan so far before each slice of so many steps.

        Args:
            shares: which share of the search is done, before each slice: it cools down with that.
            steps: of a slice.
        """
        for share in shares:
            yield max(self.best.seconds)
            heat = _HOT * self._mean * (_COLD / _HOT) ** share
            self._loops.anneal(
                self._field, self._now, self._other, self.best, self._room, *self._weights, heat, steps
            )


def loops_for(field: Field, module: ModuleType) -> tuple[Any, Field, bool]:
    """Return the functions of a module, a field as they take it, and whether they take lists, not arrays."""
    n, arrays = field.sizes[0], tuple[Any, ...](field)
    if n >= _MANY and can_compile():
        return compiled(module), field, False
    return module, Field(*(each.tolist() for each in arrays)) if n <= _DENSE else field, True


def stops_of(tours: Tours, robot: int) -> Iterator[int]:
    """Yield the stops of a robot in order."""
    home = len(tours.robot) + robot
    stop = tours.after[home]
    while stop != home:
        yield int(stop)
        stop = tours.after[stop]


def _none(n: int, m: int, listed: bool) -> Tours:
    """Return empty tours."""
    ring = np.concatenate([np.full(n, -1), np.arange(n, n + m)])
    times = [np.zeros(count) for count in (n + m, n + m, m, m)]
    parts = (ring, ring.copy(), np.full(n, -1), *times, np.zeros(m, np.int64))
    return Tours(*(each.tolist() if listed else each for each in parts))
