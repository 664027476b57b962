"""How far things are, by how much their pictures in both eyes differ."""

from __future__ import annotations

import cv2
import numpy as np

from auv_vision.cameras import Camera, Numbers

NEAREST = 0.5
"""Metres within which nothing is ranged."""

LEAST_ALIKE = 0.6
"""Correlation of what counts as the same thing."""

_ROWS, _LEAST = 1, 1.5
_MOST, _NEARLY, _APART = 4, 0.15, 5


def disparities(
    left: Numbers, right: Numbers, camera: Camera, box: tuple[int, int, int, int]
) -> list[tuple[float, float]]:
    """Return by how many columns a part of the left picture may be further left in the right one.

    There is more than one where several things look the same; none where nothing is alike. Up to half of the
    part may lie outside the right picture, which goes on there as it is at its rim.

    Args:
        left: shares of colours, as of `segments.View`; right: of the other eye.
        box: columns and rows of the part: left, top, right, bottom, ends excluded.

    Returns:
        Columns, finer than one, and the correlation, at most 1; the most alike first.
    """
    height, width = left.shape[:2]
    first, top = max(0, box[0]), max(_ROWS, box[1])
    last, bottom = min(width, box[2]), min(height - _ROWS, box[3])
    if last - first < 3 or bottom - top < 3:
        return []
    farthest = int(camera.focal * camera.baseline / NEAREST)
    begin = max(first - farthest, -((last - first) // 2))
    outside = max(0, -begin)
    there = right[top - _ROWS : bottom + _ROWS, begin + outside : last]
    strip = cv2.copyMakeBorder(there, 0, 0, outside, 0, cv2.BORDER_REPLICATE)
    table = cv2.matchTemplate(strip, left[top:bottom, first:last], cv2.TM_CCOEFF_NORMED)
    alike = np.nan_to_num(np.max(table, axis=0), nan=-1.0, posinf=-1.0, neginf=-1.0)
    whole = alike.copy()
    found: list[tuple[float, float]] = []
    for _ in range(_MOST):
        column = int(np.argmax(alike))
        score = float(alike[column])
        if not LEAST_ALIKE <= score <= 1.001 or (found and score < found[0][1] - _NEARLY):
            break
        shift = first - begin - column - _finer(whole, column)
        if shift >= _LEAST:
            found.append((float(shift), min(1.0, score)))
        alike[max(0, column - _APART) : column + _APART + 1] = -1.0
    return found


def _finer(alike: Numbers, column: int) -> float:
    """Return by what part of a column the top of a parabola through three neighbours is off."""
    if not 0 < column < len(alike) - 1:
        return 0.0
    before, here, after = (float(each) for each in alike[column - 1 : column + 2])
    bend = before - 2.0 * here + after
    return 0.0 if bend >= 0.0 else max(-0.5, min(0.5, 0.5 * (before - after) / bend))
