"""Which boxes in space and time overlap, as time passes: a loop to be compiled, see `nearness`."""

from __future__ import annotations

from math import floor

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def overlapping_boxes(robots: Indices, low: Floats, high: Floats, times: Floats, cell: float) -> Indices:
    """Return pairs of boxes of different robots that overlap in space and time: (n, 2), in any order.

    Boxes enter a grid over the ground when their time begins, and leave it when one that enters finds that
    their time is over; the cells are chains in a hash table. A pair counts in the first cell that both share.

    Args:
        robots: (m,) whose the boxes are.
        low, high: (m, 3) corners.
        times: (m, 2) begin and end; in the order of their begins.
        cell: metres that the cells of the grid are wide.
    """
    size = 16
    while size < len(robots):
        size *= 2
    heads = np.full(size, -1, np.int64)
    box, after = np.empty(1024, np.int64), np.empty(1024, np.int64)
    used, unused = 0, -1
    boxes = np.column_stack((low, high, times[:, 1]))
    corners = np.empty((len(robots), 2), np.int64)
    found, count = np.empty((1024, 2), np.intp), 0
    for i in range(len(robots)):
        left, front, under, right, back, over, end = boxes[i]
        begin = times[i, 0]
        west, south = floor(left / cell), floor(front / cell)
        corners[i, 0], corners[i, 1] = west, south
        for x in range(west, floor(right / cell) + 1):
            for y in range(south, floor(back / cell) + 1):
                place = ((x * 73856093) ^ (y * 19349663)) & (size - 1)
                last, entry = -1, heads[place]
                while entry >= 0:
                    j, following = box[entry], after[entry]
                    if boxes[j, 6] <= begin:
                        if last < 0:
                            heads[place] = following
                        else:
                            after[last] = following
                        after[entry], unused = unused, entry
                        entry = following
                        continue
                    if (
                        robots[i] != robots[j]
                        and left < boxes[j, 3]
                        and boxes[j, 0] < right
                        and front < boxes[j, 4]
                        and boxes[j, 1] < back
                        and under < boxes[j, 5]
                        and boxes[j, 2] < over
                        and begin < end
                        and max(west, corners[j, 0]) == x
                        and max(south, corners[j, 1]) == y
                    ):
                        if count == len(found):
                            found = np.concatenate((found, found))
                        found[count, 0], found[count, 1] = i, j
                        count += 1
                    last, entry = entry, following
                if unused >= 0:
                    entry, unused = unused, after[unused]
                else:
                    if used == len(box):
                        box, after = np.concatenate((box, box)), np.concatenate((after, after))
                    entry, used = used, used + 1
                box[entry], after[entry], heads[place] = i, heads[place], entry
    return found[:count]
