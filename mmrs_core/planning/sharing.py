"""Shares a work out among robots so that the last of them is back as early as possible.

The time by which all must be back is halved in on; each robot takes of what is left, in order, as much as it
can by then (chains on chains: Pınar and Aykanat, 2004).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import permutations
from math import inf
from typing import Protocol

from mmrs_core.planning.capacities import Capacity
from mmrs_core.planning.materials import Material
from mmrs_core.planning.runs import PortionRun
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Ready, State

_HALVINGS = 12
_CLOSE = 4e-3
"""Share of the time within which two ways of sharing out are alike."""


@dataclass(frozen=True, eq=False)
class ShareCandidate:
    """A robot that may take a share.

    Attributes:
        pilot: of the robot.
        state: in which it would begin.
        ready: what it would wait for.
        forwards: the material in its own direction.
        backwards: lays it out in the other direction; None where the work has only one.
        record: see `PortionRun`.
    """

    pilot: Pilot
    state: State
    ready: Ready
    forwards: Material
    backwards: Callable[[], Material | None]
    record: bool
    _runs: dict[int, PortionRun] = field(default_factory=dict)

    @cached_property
    def capacity(self) -> Capacity:
        """Return how much work the robot can do by when."""
        return Capacity(self.pilot, self.forwards, self.state, self.ready)

    def run(self, begin: int) -> PortionRun:
        """Return the robot's run from a portion on, made when it is first asked for."""
        if begin not in self._runs:
            self._runs[begin] = self._run(self.forwards, begin)
        return self._runs[begin]

    def _run(self, material: Material, begin: int) -> PortionRun:
        return PortionRun(self.pilot, material, self.state, begin, self.ready, record=self.record)

    def turned(self, share: Share) -> Share:
        """Return its share in the direction in which it is back sooner."""
        backwards = self.backwards()
        if backwards is None:
            return share
        begin, end = len(backwards) - 1 - share.end, len(backwards) - 1 - share.run.begin
        run = self._run(backwards, begin)
        return Share(self, run, end) if run.back(end) < share.back - 1e-6 else share


@dataclass(frozen=True, slots=True)
class Share:
    """A run of portions for one robot, begin to end in the run's own direction."""

    candidate: ShareCandidate
    run: PortionRun
    end: int

    @property
    def back(self) -> float:
        """When the robot is back, seconds."""
        return self.run.back(self.end)


@dataclass(frozen=True, slots=True)
class Sharing:
    """A work shared out; `back` is when the last robot is back, seconds."""

    shares: tuple[Share, ...]
    back: float


class Filling(Protocol):
    """A work shared out among robots.

    Attributes:
        begin: seconds at which the first of them would set out.
        alone: whether there is one robot only, whose share is the work.
    """

    begin: float
    alone: bool

    def shares(self, limit: float) -> Sequence[Share]:
        """Return shares of all the work after which robots are back by a time; none if they cannot be."""


def earliest(filling: Filling, limit: float = inf) -> Sharing | None:
    """Return shares of all the work after which all are back as early as can be; None if not by a limit.

    The time by which all must be back is halved down until they no longer can.
    """
    found = filling.shares(limit)
    if not found:
        return None
    low, back = filling.begin, _back(found)
    for _ in range(0 if filling.alone else _HALVINGS):
        if back - low <= _CLOSE * back:
            break
        middle = (low + back) / 2
        if better := filling.shares(middle):
            found, back = better, _back(better)
        else:
            low = middle
    return each_turned(found)


def each_turned(shares: Sequence[Share]) -> Sharing:
    """Return shares, each in the direction in which its robot is back sooner."""
    turned = tuple(share.candidate.turned(share) for share in shares)
    return Sharing(turned, _back(turned))


def _back(shares: Sequence[Share]) -> float:
    return max(share.back for share in shares)


def fillings(candidates: Sequence[ShareCandidate], *, everyone: bool = False) -> list[RowFilling]:
    """Return the ways worth a try to share a work out among robots, all of which have the same portions.

    Args:
        candidates: the robots; the order of the first ones along the work is open.
        everyone: whether each robot must have a share.
    """
    return [RowFilling(order, everyone=everyone) for order in _orders(candidates)]


def _orders(candidates: Sequence[ShareCandidate]) -> list[tuple[ShareCandidate, ...]]:
    """Return orders worth a try: all of few robots, else by where along the work they are nearest."""
    if len(candidates) <= 2:
        return list(permutations(candidates))
    along = tuple(sorted(candidates, key=lambda each: each.forwards.nearest(each.state.at)))
    return [along, along[::-1]]


class RowFilling:
    """Fills robots with portions one after the other: exact for an order but for the size of portions."""

    def __init__(self, order: Sequence[ShareCandidate], *, everyone: bool) -> None:
        """Make it for robots in one order, each of which must have a share or not."""
        self._order, self._everyone, self.alone = order, everyone, len(order) == 1
        self.begin = min(candidate.state.time for candidate in order)
        self.portions = len(order[0].forwards)
        self._materials = list({id(each.forwards): each.forwards for each in order}.values())

    def shares(self, limit: float) -> list[Share]:
        """Return shares of all portions after which robots are back by a time; none if they cannot be."""
        return self.whole(limit, 0, self.portions)

    def whole(self, limit: float, first: int, end: int) -> list[Share]:
        """Return shares of all portions from one to before another; none if they take longer."""
        capacity = inf if self.alone else sum(each.capacity.until(limit) for each in self._order)
        found = self._filled(limit, first, end, capacity)
        return found if found and found[-1].end == end - 1 else []

    def part(self, limit: float, first: int, end: int) -> list[Share]:
        """Return shares from one portion on, before another: as many as are done by a time."""
        return self._filled(limit, first, end, inf)

    def _filled(self, limit: float, first: int, end: int, capacity: float) -> list[Share]:
        """Return the same; none as soon as what is left takes longer than the robots left have.

        Args:
            limit: by which all are back.
            first: portion.
            end: portion before which they end.
            capacity: seconds of work that all of them can do by then.
        """
        shares: list[Share] = []
        waiting = list(self._order)
        while first < end:
            robots = len(waiting)
            if capacity < min(each.fewest_seconds(robots, first, end - 1) for each in self._materials):
                return []
            share = self._next_share(waiting, first, end, limit)
            if share is None:
                break
            shares.append(share)
            capacity -= share.candidate.capacity.until(limit) if capacity < inf else 0.0
            first = share.end + 1
        return [] if self._everyone and waiting else shares

    def _next_share(self, waiting: list[ShareCandidate], first: int, end: int, limit: float) -> Share | None:
        """Return the share of the first waiting robot that can begin there; it waits no longer."""
        left_for_others = len(waiting) - 1 if self._everyone else 0
        for each in waiting:
            run = each.run(first)
            last = min(run.until(limit), end - 1 - left_for_others)
            if last >= first:
                waiting.remove(each)
                return Share(each, run, last)
        return None
