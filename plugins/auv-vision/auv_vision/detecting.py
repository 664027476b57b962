"""Detection of things in a pair of pictures: segments, shapes, ranges, colours, and how sure all that is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import dist, exp, log, pi, sqrt
from typing import Final

import cv2
import numpy as np

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings
from auv_vessel.eyes import BOTTOM, FRONT, Detection, owner_of
from auv_vessel.sheet import Vector
from auv_vision.cameras import Camera, Numbers, Picture, Pose
from auv_vision.segments import Segment, View, matted, segments_of, view_of
from auv_vision.shapes import Disc, Frame, Post, Strip, discs_of, frames_of, strip_of
from auv_vision.water import POOL, TOLD_APART, Water, colour_of

_SCORES: Final = (0.0, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)
_RIGHT: Final[Mapping[str, tuple[float, ...]]] = {
    BUOY: (0.05, 0.16, 0.3, 0.6, 0.75, 0.88, 0.92, 0.96, 0.99, 0.99),
    GATE: (0.2, 0.4, 0.5, 0.6, 0.75, 0.88, 0.95, 0.97, 0.98, 0.99),
    PATH: (0.2, 0.4, 0.5, 0.6, 0.75, 0.88, 0.95, 0.98, 0.99, 0.99),
}
"""Part of sightings that have the right name, and a place within 0.3 m or a tenth of the distance of the
true one; `benchmarks/auv_vision.py` measures it. Of gates and paths few have low scores: those are guesses
on the safe side."""


def confidence_of(kind: str, score: float) -> float:
    """Return how often a sighting of that kind with that score, from 0 to 1, is right."""
    return float(np.interp(score, _SCORES, _RIGHT[kind]))


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
    part may lie outside the right picture, which continues there as at its rim.

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


_MOST_SEGMENTS = 12
_MOST_COVERED = 0.4
_TOLERANCE = 0.25


@dataclass(frozen=True, slots=True)
class Sought:
    """Something to look out for.

    Attributes:
        kind: `surroundings.GATE`, `BUOY` or `PATH`. name: in detections.
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
            found.append(f"{each.name!r} is never detected: unknown shape of a {each.kind!r}")
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
        self, kind: str, segment: Segment, middle: tuple[float, float], margin: int, across: float, fit: float
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
        reported = colour_of(pixel, self.left.veil, dist(point, (0.0, 0.0, 0.0)), self.water)
        if reported is None:
            return None
        colour, margin = reported
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


def detections_of(
    sightings: Iterable[Sighting], camera: Camera, pose: Pose, time: float, robot: str = ""
) -> list[Detection]:
    """Return the detections of sightings; each name at most once, the surest first.

    Args:
        sightings: in the camera's pictures.
        camera: of the vehicle.
        pose: where the vehicle believed to be when the pictures were taken, at `time`.
        time: seconds of the vehicle's clock.
        robot: whose camera it is; empty: not stated.
    """
    found: dict[str, Detection] = {}
    for each in sorted(sightings, key=lambda each: -each.confidence):
        place = camera.world(each.point, pose)
        name = name_of(each.matches, place)
        if name is not None and name not in found:
            found[name] = Detection(time, name, each.confidence, *place, camera.name, owner_of(robot))
    return list(found.values())


def name_of(matches: Iterable[Sought], place: Vector) -> str | None:
    """Return which of things that look the same is at a place; None where nothing tells them apart."""
    known = list(matches)
    if len(known) == 1:
        return known[0].name
    expected = [(dist(each.place, place), each.name) for each in known if each.place is not None]
    return min(expected)[1] if len(expected) == len(known) else None
