"""Detection of things in a pair of pictures: segments, shapes, ranges, colours, and how sure all that is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import dist, exp, log, pi, sqrt

import cv2
import numpy as np

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings
from auv_vessel.eyes import BOTTOM, FRONT
from auv_vessel.sheet import Vector
from auv_vision.cameras import Camera, Numbers, Picture
from auv_vision.colours import colour_of
from auv_vision.confidence import confidence_of
from auv_vision.segments import Segment, View, matted, segments_of, view_of
from auv_vision.shapes import Disc, Frame, Post, Strip, discs_of, frames_of, strip_of
from auv_vision.stereo import disparities
from auv_vision.water import POOL, TOLD_APART, Water

_MOST_SEGMENTS = 12
_MOST_COVERED = 0.4
_TOLERANCE = 0.25


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


def unseen(camera: Camera, sought: Iterable[Sought]) -> list[str]:
    """Return which of what is sought a camera sees never, though it should, and why."""
    kinds = (GATE, BUOY) if camera.name == FRONT else (PATH,)
    found = []
    for each in sought:
        if each.kind not in (GATE, BUOY, PATH):
            found.append(f"{each.name!r} is never seen: nobody knows what a {each.kind!r} looks like")
        elif each.kind in kinds and each.colour not in TOLD_APART:
            apart = ", ".join(TOLD_APART)
            found.append(f"{each.name!r} is never seen: {each.colour} is none of {apart}")
    return found


def detect(
    left: Picture, right: Picture, camera: Camera, sought: Sequence[Sought], water: Water = POOL
) -> list[Sighting]:
    """Return what is seen of what is sought, the surest first.

    The front camera sees gates and buoys, the bottom camera paths; things that the picture's edge cuts are
    left out, since their middle is not known. Nothing is seen in pictures that are full of colours: those
    are not of water.

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
    if not 0 < len(segments) <= _MOST_SEGMENTS or cv2.countNonZero(mask) > _MOST_COVERED * mask.size:
        return []
    found: list[Sighting] = []
    if camera.name == FRONT:
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


def _surest(found: Iterable[Sighting | None]) -> Sighting | None:
    return max((each for each in found if each is not None), key=lambda each: each.score, default=None)


def _between(one: Vector, other: Vector) -> Vector:
    return (one[0] + other[0]) / 2.0, (one[1] + other[1]) / 2.0, (one[2] + other[2]) / 2.0


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
        across = 2.0 * sqrt(area / pi)
        return self._ranged(BUOY, disc.segment, (column, row), margin, across, disc.fit)

    def path(self, strip: Strip) -> Sighting | None:
        return self._ranged(PATH, strip.segment, (strip.column, strip.row), 4, strip.length, strip.fit)

    def gate(self, frame: Frame) -> Sighting | None:
        pixels = np.concatenate([self._along(post) for post in (frame.left, frame.right)])
        pixel: Numbers = np.median(pixels, axis=0)
        return _surest(
            self._sighting(GATE, pixel, _between(one, other), dist(one, other), frame.fit * min(alike, like))
            for one, alike in self._tops(frame.left)
            for other, like in self._tops(frame.right)
        )

    def _ranged(
        self,
        kind: str,
        segment: Segment,
        middle: tuple[float, float],
        margin: int,
        across: float,
        fit: float,
    ) -> Sighting | None:
        """Return what a region is, at the range at which it fits best."""
        pixel = self._mean(segment)
        return _surest(
            self._sighting(kind, pixel, point, across * point[2] / self.camera.focal, fit * alike)
            for point, alike in self._points(middle, _box(segment, margin))
        )

    def _tops(self, post: Post) -> list[tuple[Vector, float]]:
        """Return where the top of a post may be."""
        across = round(max(7.0, 1.5 * post.width))
        down = round(max(8.0, min(24.0, (post.foot[1] - post.top[1]) / 2.0)))
        column, row = round(post.top[0]), round(post.top[1])
        above = round(post.width / 2.0) + 3
        return self._points(post.top, (column - across, row - above, column + across + 1, row + down))

    def _points(
        self, middle: tuple[float, float], box: tuple[int, int, int, int]
    ) -> list[tuple[Vector, float]]:
        return [
            (self.camera.point(*middle, shift), alike)
            for shift, alike in disparities(self.left.hue, self.right.hue, self.camera, box)
        ]

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
        score = float(fit * best * min(1.0, 2.0 * margin))
        return Sighting(kind, colour, size, point, score, confidence_of(kind, score), matches)


def _box(segment: Segment, margin: int) -> tuple[int, int, int, int]:
    return (
        segment.left - margin,
        segment.top - margin,
        segment.left + segment.width + margin,
        segment.top + segment.height + margin,
    )
