"""Which pieces may come near to each other, slot by slot: a loop to be compiled, see `sweep`."""

from __future__ import annotations

from math import floor, sqrt

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def overlapping_codes(
    owners: Indices,
    times: Floats,
    least: Floats,
    places: Floats,
    reach: Floats,
    moved: NDArray[np.bool_],
    since: float,
    slot: float,
    last_slot: int,
) -> Indices:
    """Return the codes i · n + j of pieces i < j that overlap in a slot, some twice; see `sweep`.

    Boxes are laid out by slot, so that each slot's lie together; a slot's cells are chains in a hash table.
    A pair counts in the first cell that both boxes share.
    """
    n = len(owners)
    starts = np.zeros(last_slot + 3, np.int64)
    first, last = np.empty(n, np.int64), np.empty(n, np.int64)
    for i in range(n):
        first[i] = floor(max(0.0, min(float(last_slot), (times[i, 0] - since) / slot)))
        last[i] = floor(max(0.0, min(float(last_slot), (times[i, 1] - since) / slot)))
        for s in range(first[i], last[i] + 1):
            starts[s + 2] += 1
    most = 0
    for s in range(1, last_slot + 3):
        most = max(most, starts[s])
        starts[s] += starts[s - 1]
    total = starts[-1]
    members = np.empty(total, np.int64)
    boxes = np.empty((total, 6))
    squares = 0.0
    for i in range(n):
        whole = least[i]
        for s in range(first[i], last[i] + 1):
            k = starts[s + 1]
            starts[s + 1] += 1
            members[k] = i
            begin = since + s * slot
            ahead, behind = 1.0, 0.0
            if whole > 0.0:
                ahead = min(max((begin + slot - times[i, 0]) / whole, 0.0), 1.0)
                behind = min(max(1.0 - (times[i, 1] - begin) / whole, 0.0), ahead)
            for axis in range(3):
                start = places[i, 0, axis]
                along = places[i, 1, axis] - start
                one, two = start + behind * along, start + ahead * along
                boxes[k, axis], boxes[k, 3 + axis] = min(one, two) - reach[i], max(one, two) + reach[i]
            squares += (boxes[k, 3] - boxes[k, 0]) ** 2 + (boxes[k, 4] - boxes[k, 1]) ** 2
    cell = 2.0 * max(sqrt(squares / total), 1e-6)
    size = 4
    while size < 4 * most:
        size *= 2
    heads = np.zeros(size, np.int64)
    after, box = np.empty(16 * most + 16, np.int64), np.empty(16 * most + 16, np.int64)
    corner = np.empty((total, 2), np.int64)
    codes, found = np.empty(1024, np.int64), 0
    for s in range(last_slot + 1):
        heads[:] = 0
        used = 1
        for k in range(starts[s], starts[s + 1]):
            i = members[k]
            left, front, under, right, back, over = boxes[k]
            x0, y0 = floor(left / cell), floor(front / cell)
            corner[k, 0], corner[k, 1] = x0, y0
            for x in range(x0, floor(right / cell) + 1):
                for y in range(y0, floor(back / cell) + 1):
                    place = ((x * 73856093) ^ (y * 19349663)) & (size - 1)
                    entry = heads[place]
                    while entry > 0:
                        o = box[entry]
                        entry = after[entry]
                        if (
                            left < boxes[o, 3]
                            and boxes[o, 0] < right
                            and front < boxes[o, 4]
                            and boxes[o, 1] < back
                            and under < boxes[o, 5]
                            and boxes[o, 2] < over
                            and max(x0, corner[o, 0]) == x
                            and max(y0, corner[o, 1]) == y
                        ):
                            j = members[o]
                            if owners[i] != owners[j] and (moved[i] or moved[j]):
                                if found == len(codes):
                                    codes = np.concatenate((codes, codes))
                                codes[found] = min(i, j) * n + max(i, j)
                                found += 1
                    if used == len(box):
                        after, box = np.concatenate((after, after)), np.concatenate((box, box))
                    box[used], after[used], heads[place] = k, heads[place], used
                    used += 1
    return codes[:found]
