"""Shares a work out among robots so that the last of them is back as early as possible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations
from math import dist, inf

from mmrs_core.planning.materials import Material
from mmrs_core.planning.runs import PortionRun
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Ready, State

_HALVINGS = 12
CLOSE = 4e-3
"""Share of the time within which two ways of sharing out are alike."""


@dataclass(frozen=True, slots=True)
class ShareCandidate:
    """A robot that may take a share.

    Attributes:
        pilot: of the robot.
        state: in which it would begin.
        ready: what it would wait for.
        forwards: the material in its own direction.
        backwards: in the other direction; None where the work has only one.
    """

    pilot: Pilot
    state: State
    ready: Ready
    forwards: Material
    backwards: Material | None


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


def share_out(
    candidates: Sequence[ShareCandidate], *, everyone: bool = False, record: bool = False
) -> Sharing | None:
    """Return the best way found to share out a work; None if these robots cannot do it.

    Robots take runs of portions one after the other; the time by which all must be back is halved
    down until they no longer can. Exact for each order of robots but for the size of portions.

    Args:
        candidates: the robots; all materials have the same portions.
        everyone: whether each robot must have a share.
        record: see `PortionRun`.
    """
    best: Sharing | None = None
    for order in _orders(candidates):
        found = _Filling(order, everyone, record).best(inf if best is None else best.back)
        if found is not None and (best is None or found.back < best.back - 1e-9):
            best = found
    return best


def _orders(candidates: Sequence[ShareCandidate]) -> list[tuple[ShareCandidate, ...]]:
    """Return orders worth a try: all of few robots, else by where along the work they are nearest."""
    if len(candidates) <= 2:
        return list(permutations(candidates))
    along = tuple(sorted(candidates, key=_nearest_portion))
    return [along, along[::-1]]


def _nearest_portion(candidate: ShareCandidate) -> int:
    here, material = candidate.state.at, candidate.forwards
    return min(range(len(material)), key=lambda i: dist(here, material.first(i)))


class _Filling:
    """Fills robots with portions in one order, remembering their runs."""

    def __init__(self, order: Sequence[ShareCandidate], everyone: bool, record: bool) -> None:
        self._order, self._everyone, self._record = order, everyone, record
        self._runs: dict[tuple[int, int], PortionRun] = {}
        self._count = len(order[0].forwards)

    def best(self, limit: float) -> Sharing | None:
        """Return the best sharing that is back before a limit; None if there is none."""
        found = self._fill(limit)
        if found is None:
            return None
        low = min(candidate.state.time for candidate in self._order)
        for _ in range(_HALVINGS):
            if found.back - low <= CLOSE * found.back:
                break
            middle = (low + found.back) / 2
            better = self._fill(middle)
            if better is None:
                low = middle
            else:
                found = better
        shares = tuple(self._turned(share) for share in found.shares)
        return Sharing(shares, max(share.back for share in shares))

    def _fill(self, limit: float) -> Sharing | None:
        shares: list[Share] = []
        waiting = list(range(len(self._order)))
        begin = 0
        while begin < self._count:
            share = self._next_share(waiting, begin, limit)
            if share is None:
                return None
            shares.append(share)
            begin = share.end + 1
        if self._everyone and waiting:
            return None
        return Sharing(tuple(shares), max(share.back for share in shares))

    def _next_share(self, waiting: list[int], begin: int, limit: float) -> Share | None:
        """Return the share of the first waiting robot that can begin there; it waits no longer."""
        left_for_others = len(waiting) - 1 if self._everyone else 0
        for place in waiting:
            run = self._run(place, begin)
            end = min(run.until(limit), self._count - 1 - left_for_others)
            if end >= begin:
                waiting.remove(place)
                return Share(self._order[place], run, end)
        return None

    def _run(self, place: int, begin: int) -> PortionRun:
        if (place, begin) not in self._runs:
            each = self._order[place]
            self._runs[place, begin] = PortionRun(
                each.pilot, each.forwards, each.state, begin, each.ready, record=self._record
            )
        return self._runs[place, begin]

    def _turned(self, share: Share) -> Share:
        each = share.candidate
        if each.backwards is None:
            return share
        begin, end = self._count - 1 - share.end, self._count - 1 - share.run.begin
        run = PortionRun(each.pilot, each.backwards, each.state, begin, each.ready, record=self._record)
        return Share(each, run, end) if run.back(end) < share.back - 1e-6 else share
