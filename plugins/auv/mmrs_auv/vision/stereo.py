"""How far things are, by how much their pictures in both eyes differ."""

from __future__ import annotations

import cv2
import numpy as np

from .cameras import Camera, Numbers

NEAREST = 0.5
"""Metres within which nothing is ranged."""

_ROWS, _LEAST = 1, 1.5


def disparity(
    left: Numbers, right: Numbers, camera: Camera, box: tuple[int, int, int, int]
) -> tuple[float, float] | None:
    """Return by how many columns a part of the left picture is further left in the right one, and how alike.

    Args:
        left: shares of colours, as of `segments.View`; right: of the other eye.
        box: columns and rows of the part: left, top, right, bottom, ends excluded.

    Returns:
        Columns, finer than one, and the correlation, at most 1; None where nothing is alike.
    """
    height, width = left.shape[:2]
    first, top = max(0, box[0]), max(_ROWS, box[1])
    last, bottom = min(width, box[2]), min(height - _ROWS, box[3])
    if last - first < 3 or bottom - top < 3:
        return None
    farthest = int(camera.focal * camera.baseline / NEAREST)
    begin = max(0, first - farthest)
    strip = right[top - _ROWS : bottom + _ROWS, begin:last]
    alike = cv2.matchTemplate(strip, left[top:bottom, first:last], cv2.TM_CCOEFF_NORMED)
    _, score, _, (column, row) = cv2.minMaxLoc(alike)
    found = first - begin - column - _finer(alike[row], column)
    if not np.isfinite(score) or found < _LEAST:
        return None
    return float(found), float(score)


def _finer(alike: Numbers, column: int) -> float:
    """Return by what part of a column the top of a parabola through three neighbours is off."""
    if not 0 < column < len(alike) - 1:
        return 0.0
    before, here, after = (float(each) for each in alike[column - 1 : column + 2])
    bend = before - 2.0 * here + after
    return 0.0 if bend >= 0.0 else max(-0.5, min(0.5, 0.5 * (before - after) / bend))
