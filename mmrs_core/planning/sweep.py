"""Which moving pieces may come near to each other at all: a hash grid over place and time.

Time is cut into slots; what a piece may take up within a slot is a box, and pieces whose boxes share a
cell of a grid and overlap are a pair (a uniform grid in space-time, after Bentley and Friedman 1979, with
the boxes of spatial hashing by Teschner and others 2003). Slots and cells are as large as what lies in
them is on average, so that there are O(n) boxes and entries.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.geometry.compilation import can_compile, compiled
from mmrs_core.planning import box_pairs

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]
Flags: TypeAlias = NDArray[np.bool_]

_MANY = 20_000
"""Pieces from which on compiled loops are worth their import, where they are installed."""

_AT_ONCE = 1_000_000
"""Pairs in one cell, about, that are compared at once."""


def overlapping(
    owners: Indices, times: Floats, least: Floats, places: Floats, reach: Floats, moved: Flags
) -> tuple[Indices, Indices]:
    """Return pairs (i, j), i < j, each once and in order: all of which the boxes overlap in some slot.

    Args:
        owners: (n,) pieces of one owner make no pair.
        times: (n, 2) between which a piece is taken up; -inf and inf where that has no end.
        least: (n,) seconds that it takes to go along the piece at least.
        places: (n, 2, 3) its ends.
        reach: (n,) metres from it that count as its own.
        moved: (n,) one of a pair at least has moved.
    """
    if len(owners) < 2:
        return np.empty(0, np.intp), np.empty(0, np.intp)
    finite = times[np.isfinite(times)]
    since, until = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    lasting = np.minimum(times[:, 1], until) - np.maximum(times[:, 0], since)
    slot = max(float(lasting.mean()), (until - since) / 1e6, 1e-6)
    last_slot = int((until - since) // slot)
    codes_of = (
        compiled(box_pairs, "overlapping_codes").overlapping_codes
        if len(owners) >= _MANY and can_compile()
        else _codes
    )
    codes = codes_of(owners, times, least, places, reach, moved, since, slot, last_slot)
    first, second = np.divmod(np.unique(codes), len(owners))
    return first, second


def _codes(
    owners: Indices,
    times: Floats,
    least: Floats,
    places: Floats,
    reach: Floats,
    moved: Flags,
    since: float,
    slot: float,
    last_slot: int,
) -> Indices:
    """Return the codes i · n + j of all pairs of pieces i < j with overlapping boxes, some more than once."""
    slots = np.clip((times - since) / slot, 0.0, last_slot).astype(np.intp)
    of, which = _each(slots[:, 0], slots[:, 1])
    boxes = _boxes(of, since + which.astype(np.float64) * slot, slot, times, least, places, reach)
    cell = 0.5 * max(float(np.sqrt(((boxes[:, 1, :2] - boxes[:, 0, :2]) ** 2).sum(axis=1).mean())), 1e-6)
    cells = ((boxes[:, :, :2] - boxes[:, 0, :2].min(axis=0)) // cell).astype(np.intp)
    deep, wide = cells[:, 1].max(axis=0) + 1
    across, column = _each(cells[:, 0, 0], cells[:, 1, 0])
    box, row = _each(cells[across, 0, 1], cells[across, 1, 1])
    entry = across[box]
    keys = (which[entry] * deep + column[box]) * wide + row
    groups = keys * (int(owners.max()) + 1) + owners[of[entry]]
    order = np.argsort(groups)
    groups, keys, entry = groups[order], keys[order], entry[order]
    begins, ends = (np.searchsorted(each, each, side="right") for each in (groups, keys))
    pairs = np.cumsum(ends - begins)
    found = []
    cuts = np.searchsorted(pairs, np.arange(_AT_ONCE, int(pairs[-1]), _AT_ONCE))
    for some in np.split(np.arange(len(keys)), cuts):
        first, second = _each(begins[some], ends[some] - 1)
        one, two = entry[some][first], entry[second]
        near = moved[of[one]] | moved[of[two]]
        for low, high in zip(boxes[:, 0].T, boxes[:, 1].T, strict=True):
            one, two = one[near], two[near]
            near = (low[one] < high[two]) & (low[two] < high[one])
        i, j = of[one[near]], of[two[near]]
        found.append(np.minimum(i, j) * len(owners) + np.maximum(i, j))
    return np.concatenate(found)


def _each(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Return (index, number) for each number from first to last, by index."""
    counts = last - first + 1
    of = np.repeat(np.arange(len(counts)), counts)
    return of, np.arange(len(of)) - np.repeat(np.cumsum(counts) - counts - first, counts)


def _boxes(
    of: Indices, begin: Floats, slot: float, times: Floats, least: Floats, places: Floats, reach: Floats
) -> Floats:
    """Return (m, 2, 3): lowest and highest coordinates of what pieces may take up within slots.

    That is at most as far as they can have come by the slot's end, and far enough to come to the end in time.
    """
    whole = np.where(least > 0.0, least, 1.0)[of]
    ahead = np.clip((begin + slot - times[of, 0]) / whole, 0.0, 1.0)
    behind = np.clip(1.0 - (times[of, 1] - begin) / whole, 0.0, ahead)
    stays = least[of] <= 0.0
    ahead[stays], behind[stays] = 1.0, 0.0
    start, along = places[of, 0], (places[:, 1] - places[:, 0])[of]
    one, two = start + behind[:, None] * along, start + ahead[:, None] * along
    more = reach[of, None]
    return np.stack([np.minimum(one, two) - more, np.maximum(one, two) + more], axis=1)
