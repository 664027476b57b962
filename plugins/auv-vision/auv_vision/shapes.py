"""Shapes in a mask of what stands out: discs, strips and frames."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import hypot, pi, sqrt

import cv2
import numpy as np

from auv_vision.cameras import Numbers, Picture
from auv_vision.segments import Segment

Pixel = tuple[float, float]

ROUND, FULL, LONG, BARRED = 0.72, 0.7, 3.5, 0.7
"""Least overlap with a disc, least filling of a box, least proportion, and part of a bar, that is taken."""

_DRAWN, _MARGIN = 48, 12
_STEEP = 2.2
_TOGETHER = 14.0


@dataclass(frozen=True, slots=True)
class Disc:
    """A disc: its middle and radius, pixels; how well it fits, from 0 to 1; the region it was found in."""

    column: float
    row: float
    radius: float
    fit: float
    segment: Segment


@dataclass(frozen=True, slots=True)
class Strip:
    """A strip: its middle, length and width, pixels; how well it fits; the region it was found in."""

    column: float
    row: float
    length: float
    width: float
    fit: float
    segment: Segment


@dataclass(frozen=True, slots=True)
class Post:
    """An upright line: its axis from the top, pixels, and how wide it is."""

    top: Pixel
    foot: Pixel
    width: float


@dataclass(frozen=True, slots=True)
class Frame:
    """Two posts that hang from a bar; `fit`: the part of the bar that is seen."""

    left: Post
    right: Post
    fit: float


def disc_of(segment: Segment) -> Disc | None:
    """Return the disc that a region is, by the Hough transform for circles."""
    if not 0.6 < segment.width / segment.height < 1.67:
        return None
    scale = _DRAWN / max(segment.width, segment.height)
    drawn = cv2.resize(segment.mask, None, fx=scale, fy=scale, interpolation=cv2.INTER_LINEAR)
    drawn = cv2.copyMakeBorder(drawn, _MARGIN, _MARGIN, _MARGIN, _MARGIN, cv2.BORDER_CONSTANT, value=0)
    drawn = cv2.GaussianBlur(drawn, (5, 5), 1.5)
    radius = sqrt(segment.area / pi) * scale
    circles = cv2.HoughCircles(
        drawn, cv2.HOUGH_GRADIENT, 1.0, 2.0 * _DRAWN, param1=120, param2=9,
        minRadius=int(0.75 * radius), maxRadius=int(1.3 * radius) + 2,
    )  # fmt: skip
    if circles is None:
        return None
    column, row, size = (float(each) for each in np.asarray(circles).reshape(-1, 3)[0])
    filled = np.zeros_like(drawn)
    cv2.circle(filled, (round(column), round(row)), round(size), 255, -1)
    solid = drawn > 127
    both, either = np.count_nonzero(solid & (filled > 0)), np.count_nonzero(solid | (filled > 0))
    if both < ROUND * either:
        return None
    moments = cv2.moments(segment.mask, binaryImage=True)
    middle = (moments["m10"] / moments["m00"], moments["m01"] / moments["m00"])
    return Disc(
        segment.left + middle[0],
        segment.top + middle[1],
        sqrt(segment.area / pi),
        float(both / either),
        segment,
    )


def discs_of(segment: Segment) -> Iterator[Disc]:
    """Yield the discs of a region; those too that thin lines tie to other things."""
    if (disc := disc_of(segment)) is not None:
        yield disc
        return
    for size in (7, 11, 17):
        if min(segment.width, segment.height) < size:
            return
        brush = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
        framed = cv2.copyMakeBorder(segment.mask, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
        opened = np.asarray(cv2.morphologyEx(framed, cv2.MORPH_OPEN, brush), np.uint8)[1:-1, 1:-1]
        found = [disc for part in _parts(segment, opened) if (disc := disc_of(part)) is not None]
        if found:
            yield from found
            return


def _parts(segment: Segment, mask: Picture) -> Iterator[Segment]:
    count, labels, figures, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    for label in range(1, count):
        left, top, width, height, area = (int(each) for each in figures[label])
        part = np.where(labels[top : top + height, left : left + width] == label, 255, 0)
        yield Segment(part.astype(np.uint8), segment.left + left, segment.top + top, area)


def strip_of(segment: Segment) -> Strip | None:
    """Return the strip that a region is."""
    points = cv2.findNonZero(segment.mask)
    (column, row), sides, _ = cv2.minAreaRect(points)
    length, width = max(sides) + 1.0, min(sides) + 1.0
    full = segment.area / (length * width)
    if length < LONG * width or full < FULL:
        return None
    return Strip(segment.left + column, segment.top + row, length, width, min(1.0, full), segment)


def frames_of(mask: Picture) -> Iterator[Frame]:
    """Yield the frames of a mask, by the Hough transform for lines along its edges."""
    edges = cv2.Canny(mask, 60, 180)
    lines = cv2.HoughLinesP(edges, 1.0, pi / 180.0, 12, minLineLength=9, maxLineGap=4)
    if lines is None:
        return
    posts = [
        post
        for group in _grouped(_upright(np.asarray(lines).reshape(-1, 4).astype(float)))
        if (post := _post(mask, group)) is not None
    ]
    for left, right in combinations(sorted(posts, key=lambda each: each.top[0]), 2):
        if right.top[0] - left.top[0] < 2.0 * max(left.width, right.width, 4.0):
            continue
        covered = _covered(mask, left, right)
        if covered >= BARRED:
            yield Frame(left, right, covered)


def _upright(lines: Numbers) -> list[Numbers]:
    """Return the lines that are about upright, each from its upper end."""
    found = []
    for line in lines:
        x1, y1, x2, y2 = line if line[1] < line[3] else line[[2, 3, 0, 1]]
        if y2 - y1 > _STEEP * abs(x2 - x1):
            found.append(np.array((x1, y1, x2, y2)))
    return sorted(found, key=lambda each: float(each[0] + each[2]))


def _grouped(lines: Sequence[Numbers]) -> list[list[Numbers]]:
    """Return lines in groups of which each may be the two edges of a post."""
    groups: list[list[Numbers]] = []
    for line in lines:
        middle = (line[0] + line[2]) / 2.0
        if groups and middle - (groups[-1][0][0] + groups[-1][0][2]) / 2.0 < _TOGETHER:
            groups[-1].append(line)
        else:
            groups.append([line])
    return groups


def _post(mask: Picture, group: Sequence[Numbers]) -> Post | None:
    """Return the post that a group of lines are the edges of."""
    upper, lower = min(line[1] for line in group), max(line[3] for line in group)
    start = float(np.mean([(line[0] + line[2]) / 2.0 for line in group]))
    spots = []
    for part in (0.35, 0.5, 0.65, 0.8):
        row = round(upper + part * (lower - upper))
        if (run := _run(mask[row], start)) is not None:
            spots.append((row, (run[0] + run[1]) / 2.0, run[1] - run[0] + 1.0))
    if len(spots) < 3:
        return None
    rows, columns, widths = (np.array(each, dtype=float) for each in zip(*spots, strict=True))
    slope, offset = np.polyfit(rows, columns, 1)
    width = float(np.median(widths))
    if width > 0.5 * (lower - upper) or abs(slope) > 1.0 / _STEEP:
        return None
    top, foot = round(rows[0]), round(rows[-1])
    while top > 0 and _is_set(mask, slope * (top - 1) + offset, top - 1):
        top -= 1
    while foot < mask.shape[0] - 1 and _is_set(mask, slope * (foot + 1) + offset, foot + 1):
        foot += 1
    axis = top + width / 2.0
    return Post((slope * axis + offset, axis), (slope * foot + offset, float(foot)), width)


def _run(row: Picture, column: float) -> tuple[int, int] | None:
    """Return the ends of the run of set pixels in a row that is nearest to a column."""
    near = [round(column) + off for off in (0, -1, 1, -2, 2, -3, 3, -4, 4, -5, 5, -6, 6)]
    begin = next((each for each in near if 0 <= each < len(row) and row[each]), None)
    if begin is None:
        return None
    first = last = begin
    while first > 0 and row[first - 1]:
        first -= 1
    while last < len(row) - 1 and row[last + 1]:
        last += 1
    return first, last


def _is_set(mask: Picture, column: float, row: int) -> bool:
    spot = round(column)
    return 0 <= spot < mask.shape[1] and bool(mask[row, max(0, spot - 1) : spot + 2].any())


def _covered(mask: Picture, left: Post, right: Post) -> float:
    """Return the part of the line from one post's top to the other's that is set."""
    count = max(8, round(hypot(right.top[0] - left.top[0], right.top[1] - left.top[1]) / 2.0))
    share = np.linspace(0.05, 0.95, count)
    columns = np.rint(left.top[0] + share * (right.top[0] - left.top[0])).astype(int)
    rows = np.rint(left.top[1] + share * (right.top[1] - left.top[1])).astype(int)
    inside = (columns >= 0) & (columns < mask.shape[1]) & (rows >= 0) & (rows < mask.shape[0])
    return float(np.count_nonzero(mask[rows[inside], columns[inside]]) / count)
