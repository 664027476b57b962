"""Stops that wait for each other, given to robots one by one in an order that is changed again and again.

Each stop in turn goes to the robot that ends it first (serial schedule generation: Kolisch, "Serial and
parallel resource-constrained project scheduling methods revisited", Eur. J. Oper. Res. 90, 1996). The order
begins with what the longest chain of work waits for. It is searched by simulated annealing: one stop is moved
between those that it waits for and those that wait for it (Bouleimen and Lecocq, "A new efficient simulated
annealing algorithm for the resource-constrained project scheduling problem", Eur. J. Oper. Res. 149, 2003).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate
from random import Random
from typing import Any

import numpy as np

from mmrs_core.planning import order_loops
from mmrs_core.planning.effort import SLICE
from mmrs_core.planning.order_loops import Line, Waits
from mmrs_core.planning.ruin import loops_for
from mmrs_core.planning.ruin_loops import Field

_HOT, _COLD, _LAST = 0.01, 0.0005, 0.00003
"""Temperature at the beginning, before the last part of a search, and in that part, as a share of the first
makespan."""

_LAST_PART = 0.25
"""Part of a search that is spent on the best order near to where it is."""


class OrderSearch:
    """A search for an order, step by step.

    Attributes:
        best: the best order so far, with whose each stop is and when it begins.
    """

    def __init__(self, field: Field, before: Sequence[Sequence[int]], seed: int) -> None:
        """Give all stops to robots once.

        Args:
            field: of the stops.
            before: by stop: those that it waits for; they come before it.
            seed: of the random numbers.
        """
        m = field.sizes[1]
        self._loops, self._field, listed = loops_for(field, order_loops)
        after: list[list[int]] = [[] for _ in before]
        for stop, each in enumerate(before):
            for other in each:
                after[other].append(stop)
        rows = [
            np.array(each, np.int64)
            for some in (before, after)
            for each in ([0, *accumulate(map(len, some))], [stop for row in some for stop in row])
        ]
        self._waits = Waits(*(each.tolist() if listed else each for each in rows))
        order = _first_order(field, before)
        self._line, self.best = (_line(order, m, listed) for _ in range(2))
        self._line.random[0] = Random(seed).randrange(1, 2**31 - 1)
        self._first = self._now = self._loops.carry_out(self._field, self._waits, self._line)
        self.makespan = self._loops.carry_out(self._field, self._waits, self.best)

    def run(self, shares: Iterable[float], steps: int = SLICE) -> Iterator[float]:
        """Yield the least makespan so far before each slice of so many steps, see `Search`."""
        for share in shares:
            yield self.makespan
            cooled = share / (1.0 - _LAST_PART)
            heat = self._first * (_HOT * (_COLD / _HOT) ** cooled if cooled < 1.0 else _LAST)
            self._now, self.makespan = self._loops.anneal(
                self._field, self._waits, self._line, self.best, self._now, self.makespan, heat, steps
            )


def _first_order(field: Field, before: Sequence[Sequence[int]]) -> list[int]:
    """Return the stops with priority first, with what they wait for, then those with the longest chains."""
    n = len(before)
    work = [float(each) for each in field.work[:n]]
    ranks, tails = [int(each) for each in field.ranks], [*work]
    for stop in reversed(range(n)):
        for other in before[stop]:
            ranks[other] = max(ranks[other], ranks[stop])
            tails[other] = max(tails[other], work[other] + tails[stop])
    return sorted(range(n), key=lambda stop: (-ranks[stop], -tails[stop]))


def _line(order: Sequence[int], m: int, listed: bool) -> Line:
    n = len(order)
    places = np.empty(n, np.int64)
    places[order] = np.arange(n)
    parts: tuple[Any, ...] = (
        *(np.array(order), places, np.full(n, -1), np.zeros(n), np.zeros(n)),
        *(np.zeros(m, np.int64), np.zeros(m), np.zeros(m), np.zeros(1, np.int64)),
    )
    return Line(*(each.tolist() if listed else each for each in parts))
