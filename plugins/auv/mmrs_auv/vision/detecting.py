"""Detection of things in a pair of pictures: segments, shapes, ranges, colours, and how sure all that is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import dist, exp, log, pi, sqrt

import cv2
import numpy as np

from ..vessel.body.surroundings import BUOY, GATE, PATH, Surroundings
from ..vessel.eyes import BOTTOM, FRONT
from ..vessel.sheet import Vector
from .cameras import Camera, Numbers, Picture
from .colours import colour_of
from .confidence import confidence_of
from .segments import Segment, View, matted, segments_of, view_of
from .shapes import Disc, Frame, Post, Strip, discs_of, frames_of, strip_of
from .stereo import disparity
from .water import POOL, Water

_MOST_SEGMENTS = 12
_TOLERANCE = 0.25
_LEAST_ALIKE = 0.6


@dataclass(frozen=True, slots=True)
class Sought:
    """Something to look out for.

    Attributes:
        kind: `surroundings.GATE`, `BUOY` or `PATH`. name: that detections bear.
        colour: one of `water.TOLD_APART`; things of others are not seen.
        size: metres, as of `surroundings.Thing`.
        place: north, east, depth where it is expected: tells things apart that look the same; None: unknown.
    """

    kind: str
    name: str
    colour: str
    size: float
    place: Vector | None = None


@dataclass(frozen=True, slots=True)
class Sighting:
    """Something seen.

    Attributes:
        kind, colour: what it looks like.
        size: metres, as measured.
        point: metres right, down and ahead of the camera's middle.
        score: how well all fits, from 0 to 1; confidence: how often a sighting with that score is right.
        matches: what it may be of what is sought, never empty.
    """

    kind: str
    colour: str
    size: float
    point: Vector
    score: float
    confidence: float
    matches: tuple[Sought, ...]


def sought_in(surroundings: Surroundings) -> tuple[Sought, ...]:
    """Return what cameras can look out for there."""
    return tuple(
        Sought(each.kind, each.name, each.colour, each.size, (each.north, each.east, each.depth))
        for each in surroundings.things
    )


def detect(
    left: Picture, right: Picture, camera: Camera, sought: Sequence[Sought], water: Water = POOL
) -> list[Sighting]:
    """Return what is seen of what is sought, the surest first.

    The front camera sees gates and buoys, the bottom camera paths; things that the picture's edge cuts are
    left out, since their middle is not known.

    Args:
        camera: that took pictures of that size.
        water: that they were taken in, as far as it is known.

    Raises:
        ValueError: the pictures are not of the camera's size.
    """
    for picture in (left, right):
        if picture.shape != (camera.height, camera.width, 3):
            raise ValueError(f"picture of {picture.shape}, not of {camera.width}x{camera.height} pixels")
    seen = _Seen(view_of(left), view_of(right), camera, water, tuple(sought))
    mask, segments = segments_of(seen.left)
    segments = segments[:_MOST_SEGMENTS]
    found: list[Sighting] = []
    if camera.name == FRONT:
        if segments:
            found += _best([each for each in map(seen.gate, frames_of(mask)) if each is not None])
        found += [each for each in map(seen.buoy, _discs(segments, camera)) if each is not None]
    if camera.name == BOTTOM:
        found += [each for each in map(seen.path, _strips(segments, camera)) if each is not None]
    return sorted(found, key=lambda each: -each.score)


def _discs(segments: Sequence[Segment], camera: Camera) -> Iterator[Disc]:
    for segment in segments:
        yield from (
            each for each in discs_of(segment) if not each.segment.cut_by(camera.width, camera.height)
        )


def _strips(segments: Sequence[Segment], camera: Camera) -> Iterator[Strip]:
    for segment in segments:
        if not segment.cut_by(camera.width, camera.height) and (strip := strip_of(segment)) is not None:
            yield strip


def _best(found: Sequence[Sighting]) -> list[Sighting]:
    """Return the best of those that are the same thing."""
    kept: list[Sighting] = []
    for each in sorted(found, key=lambda each: -each.score):
        if all(dist(each.point, other.point) > each.size for other in kept):
            kept.append(each)
    return kept


@dataclass(frozen=True, slots=True)
class _Seen:
    """A pair of pictures."""

    left: View
    right: View
    camera: Camera
    water: Water
    sought: tuple[Sought, ...]

    def buoy(self, disc: Disc) -> Sighting | None:
        margin = round(0.4 * disc.radius) + 2
        column, row, area = matted(self.left.hue, disc.segment)
        ranged = self._point(column, row, _box(disc.segment, margin))
        if ranged is None:
            return None
        point, alike = ranged
        size = 2.0 * sqrt(area / pi) * point[2] / self.camera.focal
        return self._sighting(BUOY, self._mean(disc.segment), point, size, disc.fit * alike)

    def path(self, strip: Strip) -> Sighting | None:
        ranged = self._point(strip.column, strip.row, _box(strip.segment, 4))
        if ranged is None:
            return None
        point, alike = ranged
        size = strip.length * point[2] / self.camera.focal
        return self._sighting(PATH, self._mean(strip.segment), point, size, strip.fit * alike)

    def gate(self, frame: Frame) -> Sighting | None:
        one, other = self._top(frame.left), self._top(frame.right)
        if one is None or other is None:
            return None
        point = (
            (one[0][0] + other[0][0]) / 2.0,
            (one[0][1] + other[0][1]) / 2.0,
            (one[0][2] + other[0][2]) / 2.0,
        )
        pixels = np.concatenate([self._along(post) for post in (frame.left, frame.right)])
        fit = frame.fit * min(one[1], other[1])
        return self._sighting(GATE, np.median(pixels, axis=0), point, dist(one[0], other[0]), fit)

    def _top(self, post: Post) -> tuple[Vector, float] | None:
        """Return where the top of a post is."""
        across = round(max(7.0, 1.5 * post.width))
        down = round(max(8.0, min(24.0, (post.foot[1] - post.top[1]) / 2.0)))
        column, row = round(post.top[0]), round(post.top[1])
        above = round(post.width / 2.0) + 3
        box = (column - across, row - above, column + across + 1, row + down)
        return self._point(post.top[0], post.top[1], box)

    def _point(
        self, column: float, row: float, box: tuple[int, int, int, int]
    ) -> tuple[Vector, float] | None:
        found = disparity(self.left.hue, self.right.hue, self.camera, box)
        if found is None or found[1] < _LEAST_ALIKE:
            return None
        return self.camera.point(column, row, found[0]), found[1]

    def _mean(self, segment: Segment) -> Numbers:
        """Return the colour of the middle of a region, where its edges do not mix with what is behind."""
        rows = slice(segment.top, segment.top + segment.height)
        part = self.left.smooth[rows, segment.left : segment.left + segment.width]
        framed = cv2.copyMakeBorder(segment.mask, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
        depth = cv2.distanceTransform(framed, cv2.DIST_L2, 3)[1:-1, 1:-1]
        inner = depth >= 0.6 * float(depth.max())
        mean: Numbers = part[inner].mean(axis=0)
        return mean

    def _along(self, post: Post) -> Numbers:
        share = np.linspace(0.1, 0.9, 12)
        columns = np.rint(post.top[0] + share * (post.foot[0] - post.top[0])).astype(int)
        rows = np.rint(post.top[1] + share * (post.foot[1] - post.top[1])).astype(int)
        found: Numbers = self.left.smooth[
            np.clip(rows, 0, self.camera.height - 1), np.clip(columns, 0, self.camera.width - 1)
        ]
        return found

    def _sighting(self, kind: str, pixel: Numbers, point: Vector, size: float, fit: float) -> Sighting | None:
        told = colour_of(pixel, self.left.veil, dist(point, (0.0, 0.0, 0.0)), self.water)
        if told is None:
            return None
        colour, margin = told
        alike = [each for each in self.sought if (each.kind, each.colour) == (kind, colour)]
        fits = [(exp(-((log(size / each.size) / _TOLERANCE) ** 2)), each) for each in alike]
        fits = [each for each in fits if each[0] > 0.1]
        if not fits:
            return None
        best = max(each[0] for each in fits)
        matches = tuple(each for _, each in fits)
        score = fit * best * min(1.0, 2.0 * margin)
        return Sighting(kind, colour, size, point, score, confidence_of(kind, score), matches)


def _box(segment: Segment, margin: int) -> tuple[int, int, int, int]:
    return (
        segment.left - margin,
        segment.top - margin,
        segment.left + segment.width + margin,
        segment.top + segment.height + margin,
    )
