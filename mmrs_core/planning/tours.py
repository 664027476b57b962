"""Orders strokes so that the hops between them are short: nearest end first, then improved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]

_PASSES = 20


def tour(
    begins: ArrayLike, ends: ArrayLike, start: ArrayLike | None = None, *, improve: bool = True
) -> list[tuple[int, bool]]:
    """Return an order of n strokes as (index, reversed), good in the total length of straight hops.

    Args:
        begins: (n, 2) first points.
        ends: (n, 2) last points.
        start: (2,) where the tour begins; None: at whichever outer end is best.
        improve: whether to go on after the nearest-end tour with reversals of parts (2-opt) and moves
            of single strokes until neither helps. Deterministic.
    """
    first = np.asarray(begins, dtype=np.float64).reshape(-1, 2)
    last = np.asarray(ends, dtype=np.float64).reshape(-1, 2)
    if not len(first):
        return []
    starts = [np.asarray(start, dtype=np.float64)] if start is not None else _corners(first, last)
    tours = [_nearest(first, last, point) for point in starts]
    best = min(tours, key=lambda order: hop_length(first, last, order, start))
    return _improved(first, last, best, start) if improve else best


def hop_length(
    begins: Floats, ends: Floats, order: Sequence[tuple[int, bool]], start: ArrayLike | None = None
) -> float:
    """Return the metres of straight hops between the strokes in that order, from `start` if given."""
    enter, leave = _directed(begins, ends, order)
    total = float(np.linalg.norm(enter[1:] - leave[:-1], axis=1).sum())
    if start is not None:
        total += float(np.linalg.norm(enter[0] - np.asarray(start, dtype=np.float64)))
    return total


def _corners(first: Floats, last: Floats) -> list[Floats]:
    """Return the outermost ends in four directions, without repeats."""
    ends = np.concatenate([first, last])
    along = np.stack([ends.sum(axis=1), ends[:, 0] - ends[:, 1]])
    picks = dict.fromkeys(int(i) for row in along for i in (np.argmin(row), np.argmax(row)))
    return [ends[i] for i in picks]


def _nearest(first: Floats, last: Floats, start: Floats) -> list[tuple[int, bool]]:
    """Go on with the stroke that has the nearest end, again and again; O(n²)."""
    ends = np.stack([first, last])
    open_ends = np.zeros((2, len(first)))
    order = []
    at = start
    for _ in range(len(first)):
        distance = np.hypot(ends[..., 0] - at[0], ends[..., 1] - at[1]) + open_ends
        flip, index = divmod(int(np.argmin(distance)), len(first))
        order.append((index, bool(flip)))
        open_ends[:, index] = np.inf
        at = ends[1 - flip, index]
    return order


def _directed(begins: Floats, ends: Floats, order: Sequence[tuple[int, bool]]) -> tuple[Floats, Floats]:
    """Return the points at which strokes are entered and left, in order."""
    index = np.array([i for i, _ in order], dtype=np.intp)
    flip = np.array([back for _, back in order])[:, None]
    return np.where(flip, ends[index], begins[index]), np.where(flip, begins[index], ends[index])


def _improved(
    first: Floats, last: Floats, order: list[tuple[int, bool]], start: ArrayLike | None
) -> list[tuple[int, bool]]:
    for _ in range(_PASSES):
        better = _moved(first, last, _reversed(first, last, order, start), start)
        if hop_length(first, last, better, start) >= hop_length(first, last, order, start) - 1e-6:
            return order
        order = better
    return order


def _distance(one: Floats, two: Floats) -> Floats:
    gap: Floats = np.hypot(one[..., 0] - two[..., 0], one[..., 1] - two[..., 1])
    return gap


def _reversed(
    first: Floats, last: Floats, order: list[tuple[int, bool]], start: ArrayLike | None
) -> list[tuple[int, bool]]:
    """Turn parts of the tour around wherever that shortens it (one sweep of 2-opt)."""
    order = list(order)
    for i in range(len(order)):
        enter, leave = _directed(first, last, order)
        came = leave[i - 1] if i else (None if start is None else np.asarray(start, dtype=np.float64))
        gain = np.zeros(len(order) - i)
        if came is not None:
            gain += _distance(came, enter[i]) - _distance(came, leave[i:])
        gain[:-1] += _distance(leave[i:-1], enter[i + 1 :]) - _distance(enter[i], enter[i + 1 :])
        j = int(np.argmax(gain))
        if gain[j] > 1e-6:
            order[i : i + j + 1] = [(k, not back) for k, back in reversed(order[i : i + j + 1])]
    return order


def _moved(
    first: Floats, last: Floats, order: list[tuple[int, bool]], start: ArrayLike | None
) -> list[tuple[int, bool]]:
    """Move single strokes to a better place, either way round, wherever that shortens the tour."""
    order = list(order)
    for stroke in range(len(order)):
        at = next(i for i, (k, _) in enumerate(order) if k == stroke)
        rest = order[:at] + order[at + 1 :]
        if not rest:
            return order
        enter, leave = _directed(first, last, rest)
        best = hop_length(first, last, order, start) - 1e-6
        base = hop_length(first, last, rest, start)
        for back in (False, True):
            head, tail = (last[stroke], first[stroke]) if back else (first[stroke], last[stroke])
            cost = np.zeros(len(rest) + 1)
            cost[1:] += _distance(leave, head)
            cost[:-1] += _distance(tail, enter)
            cost[1:-1] -= _distance(leave[:-1], enter[1:])
            if start is not None:
                origin = np.asarray(start, dtype=np.float64)
                cost[0] += _distance(origin, head) - _distance(origin, enter[0])
            place = int(np.argmin(cost))
            if base + cost[place] < best:
                best = base + float(cost[place])
                order = [*rest[:place], (stroke, back), *rest[place:]]
    return order
