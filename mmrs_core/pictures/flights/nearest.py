"""Distances of points from a path of straight legs, and along it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mmrs_core.geometry.frames import Floats


def nearest(points: Floats, way: Floats) -> tuple[Floats, Floats]:
    """Return the nearest point of a path to each point, (n, 3), and how far along it is, (n,) metres.

    Args:
        points: (n, 3), at least one.
        way: (m, 3) corners, at least one.
    """
    best = np.broadcast_to(way[0], points.shape).copy()
    least = np.linalg.norm(points - way[0], axis=1)
    along_way = np.zeros(len(points))
    behind = 0.0
    for begin, end in pairwise(way):
        leg = end - begin
        length = float(np.linalg.norm(leg))
        share = np.clip((points - begin) @ leg / length**2, 0.0, 1.0) if length > 0 else np.zeros(len(points))
        foot = begin + share[:, None] * leg
        distance = np.linalg.norm(points - foot, axis=1)
        nearer = distance < least
        best[nearer], least[nearer] = foot[nearer], distance[nearer]
        along_way[nearer] = behind + share[nearer] * length
        behind += length
    return best, along_way


def along(points: Floats, way: Floats) -> Floats:
    """Return how far along a path each point is, (n,) from 0 to 1; 0 for a path without length."""
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    return nearest(points, way)[1] / length if length > 0 else np.zeros(len(points))
