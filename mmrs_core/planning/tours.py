"""Orders strokes so that the hops between them are short: nearest end first, then improved.

Parts are reversed (2-opt: Croes, 1958) and short runs moved (or-opt: Or, 1976) until neither helps; then
neighbouring parts are swapped at random, and both tried again (Lourenço, Martin and Stützle, 2003).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]
Plane: TypeAlias = NDArray[np.complex128]
"""Points as east + i north, so that a distance is the absolute value of a difference."""

_PASSES = 20
_RUN = 4
"""Strokes at most that are moved to another place of a tour together."""

_KICKS = 20
_KICKED = 1000
"""Strokes at most, in all tours together, that are improved again from somewhere else."""

_AT_ONCE = 1000
"""Pairs of a run of strokes and a place for it that are looked at together."""

_SHORTER = 1e-6
"""Metres by which a tour must become shorter to be kept."""

_NOWHERE = complex("nan")


def tour(
    begins: ArrayLike, ends: ArrayLike, start: ArrayLike | None = None, *, improve: bool = True
) -> list[tuple[int, bool]]:
    """Return an order of n strokes as (index, reversed), good in the total length of straight hops.

    Args:
        begins: (n, 2) first points.
        ends: (n, 2) last points.
        start: (2,) where the tour begins; None: at whichever outer end is best.
        improve: whether to improve the nearest-end tour by reversals of parts (2-opt) and moves
            of short runs of strokes (or-opt) until neither helps, again from a few tours nearby.
            Deterministic.
    """
    first, last = _plane(begins), _plane(ends)
    if not len(first):
        return []
    origin = _NOWHERE if start is None else complex(*np.asarray(start, dtype=np.float64).tolist())
    starts = _corners(first, last) if start is None else [origin]
    tours = [_Tour(first, last, origin, *_nearest(first, last, point)) for point in starts]
    best = min(tours, key=lambda each: each.hops)
    return (_kicked(best.improved()) if improve else best).order


def hop_length(
    begins: ArrayLike, ends: ArrayLike, order: Sequence[tuple[int, bool]], start: ArrayLike | None = None
) -> float:
    """Return the metres of straight hops between the strokes in that order, from `start` if given."""
    origin = _NOWHERE if start is None else complex(*np.asarray(start, dtype=np.float64).tolist())
    index = np.array([i for i, _ in order], dtype=np.intp)
    flip = np.array([back for _, back in order], dtype=np.bool_)
    return _Tour(_plane(begins), _plane(ends), origin, index, flip).hops


def _plane(points: ArrayLike) -> Plane:
    pairs = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    return np.asarray(pairs[:, 0] + 1j * pairs[:, 1])


def _corners(first: Plane, last: Plane) -> list[complex]:
    ends = np.concatenate([first, last])
    along = np.stack([ends.real + ends.imag, ends.real - ends.imag])
    picks = dict.fromkeys(int(i) for row in along for i in (np.argmin(row), np.argmax(row)))
    return [complex(ends[i]) for i in picks]


def _nearest(first: Plane, last: Plane, at: complex) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Append the stroke that has the nearest end, again and again; O(n²)."""
    ends = np.stack([first, last])
    done = np.zeros(ends.shape)
    order = []
    for _ in range(len(first)):
        flip, index = divmod(int(np.argmin(np.abs(ends - at) + done)), len(first))
        order.append((index, flip))
        done[:, index] = np.inf
        at = complex(ends[1 - flip, index])
    pairs = np.array(order, dtype=np.intp)
    return pairs[:, 0], pairs[:, 1].astype(np.bool_)


def _kicked(best: _Tour) -> _Tour:
    """Swap random neighbouring parts of the tour and improve it again; keep what became shorter."""
    count = len(best.index)
    rng = np.random.default_rng(0)
    for _ in range(min(_KICKS, _KICKED // count) if count > 2 else 0):
        i, j, k = np.sort(rng.choice(count + 1, 3, replace=False)).tolist()
        other = best.arranged(np.r_[0:i, j:k, i:j, k:count]).improved()
        if other.hops < best.hops - _SHORTER:
            best = other
    return best


def _far(one: Plane | complex, two: Plane | complex) -> Floats:
    """Return distances; 0 from and to nowhere."""
    far: Floats = np.fmax(np.abs(np.subtract(one, two)), 0.0)
    return far


class _Tour:
    """Strokes in an order, each one way round.

    Hop k leads to the k-th stroke; the last one, to nowhere, has no length, nor has the first without
    an origin.
    """

    def __init__(
        self, first: Plane, last: Plane, origin: complex, index: NDArray[np.intp], flip: NDArray[np.bool_]
    ) -> None:
        self._first, self._last, self._origin = first, last, origin
        self.index, self.flip = index, flip
        self._enter = np.where(flip, last[index], first[index])
        self._leave = np.where(flip, first[index], last[index])
        self._came = np.concatenate([[origin], self._leave])
        self._next = np.concatenate([self._enter, [_NOWHERE]])
        self._gaps = _far(self._came, self._next)
        self.hops = float(self._gaps.sum())

    @property
    def order(self) -> list[tuple[int, bool]]:
        """The strokes as (index, reversed)."""
        return list(zip(self.index.tolist(), self.flip.tolist(), strict=True))

    def arranged(self, places: NDArray[np.intp], turned: NDArray[np.bool_] | None = None) -> _Tour:
        """Return the tour with its strokes in another order, some of them turned."""
        flip = self.flip[places] if turned is None else self.flip[places] ^ turned
        return _Tour(self._first, self._last, self._origin, self.index[places], flip)

    def improved(self) -> _Tour:
        """Return the tour after reversals and moves, until neither helps."""
        best = self
        for _ in range(_PASSES):
            other = best._with_reversals()._with_moves()
            if other.hops >= best.hops - _SHORTER:
                return best
            best = other
        return best

    def _with_reversals(self) -> _Tour:
        """Turn parts of the tour around wherever that shortens it (one sweep of 2-opt)."""
        best = self
        for i in range(len(self.index)):
            gain = best._gaps[i] + best._gaps[i + 1 :]
            gain = gain - _far(best._came[i], best._leave[i:]) - _far(best._enter[i], best._next[i + 1 :])
            j = i + int(np.argmax(gain))
            if gain[j - i] > _SHORTER:
                best = best._reversed(i, j)
        return best

    def _reversed(self, i: int, j: int) -> _Tour:
        places = np.arange(len(self.index))
        places[i : j + 1] = places[i : j + 1][::-1].copy()
        turned = (places >= i) & (places <= j)
        return self.arranged(places, turned)

    def _with_moves(self) -> _Tour:
        """Move runs of strokes to a better place, either way round, wherever that shortens the tour."""
        best = self
        count = len(self.index)
        for size in range(1, min(_RUN, count - 1) + 1):
            i, step = 0, max(1, _AT_ONCE // count)
            while i <= count - size:
                last = min(i + step, count - size + 1)
                found = best._first_move(i, last, size)
                best, i = (best, last) if found is None else found
        return best

    def _first_move(self, first: int, last: int, size: int) -> tuple[_Tour, int] | None:
        """Move the first run that becomes shorter to where that shortens the tour most.

        Args:
            first, last: strokes with which runs begin, the last one not included.
            size: strokes of a run.

        Returns:
            the tour, and the stroke with which the next run begins; None: no move helps.
        """
        i = np.arange(first, last)
        heads, tails = self._enter[i][:, None], self._leave[i + size - 1][:, None]
        left_out = self._gaps[i] + self._gaps[i + size] - _far(self._came[i], self._next[i + size])
        onwards = _far(self._came, heads) + _far(tails, self._next) - self._gaps
        backwards = _far(self._came, tails) + _far(heads, self._next) - self._gaps
        added = np.minimum(onwards, backwards)
        places = np.arange(len(self._gaps))
        added[(places >= i[:, None]) & (places <= i[:, None] + size)] = np.inf
        to = np.argmin(added, axis=1)
        rows = np.arange(len(i))
        shorter = np.flatnonzero(added[rows, to] < left_out - _SHORTER)
        if not len(shorter):
            return None
        row = int(shorter[0])
        best = int(to[row])
        return self._moved(first + row, size, best, back=bool(backwards[row, best] < onwards[row, best])), (
            first + row + 1
        )

    def _moved(self, i: int, size: int, to: int, *, back: bool) -> _Tour:
        """Return the tour with a run of strokes before another one, either way round."""
        j = i + size
        run = np.arange(i, j)[:: -1 if back else 1]
        rest = np.r_[0:i, j : len(self.index)]
        before = to if to < i else to - size
        places = np.concatenate([rest[:before], run, rest[before:]])
        return self.arranged(places, (places >= i) & (places < j) & back)
