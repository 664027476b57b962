"""Orders strokes so that the hops between them are short: nearest end first, then improved."""

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
        self,
        first: Plane,
        last: Plane,
        origin: complex,
        index: NDArray[np.intp],
        flip: NDArray[np.bool_],
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
            for i in range(count - size + 1):
                best = best._with_move(i, i + size)
        return best

    def _with_move(self, i: int, j: int) -> _Tour:
        """Move strokes i to j - 1 to where that shortens the tour most."""
        head, tail = self._enter[i], self._leave[j - 1]
        left_out = self._gaps[i] + self._gaps[j] - float(_far(self._came[i], self._next[j]))
        onwards = _far(self._came, head) + _far(tail, self._next) - self._gaps
        backwards = _far(self._came, tail) + _far(head, self._next) - self._gaps
        added = np.minimum(onwards, backwards)
        added[i : j + 1] = np.inf
        to = int(np.argmin(added))
        if added[to] >= left_out - _SHORTER:
            return self
        back = bool(backwards[to] < onwards[to])
        run = np.arange(i, j)[:: -1 if back else 1]
        rest = np.r_[0:i, j : len(self.index)]
        before = to if to < i else to - (j - i)
        places = np.concatenate([rest[:before], run, rest[before:]])
        return self.arranged(places, (places >= i) & (places < j) & back)
