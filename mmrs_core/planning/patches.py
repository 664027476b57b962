"""Shares of an area in one patch each, where that costs little."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from math import dist, inf
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from mmrs_core.planning.sharing import RowFilling, Share, Sharing, each_turned, earliest
from mmrs_core.planning.strokes import turned
from mmrs_core.scene import Position, Stroke, Work

_WORTH = 0.02
"""Share of the time until all are back, and of the mean of these times, by which the last may be later."""

_STEPS = 8
"""Times up to then that are tried."""

_TOUCHING = 1.03
"""Widths of a strip by which strokes may be apart that touch: a width, and some rounding."""

_PARALLEL = 0.02
"""Sine of the angle by which strokes may deviate from the direction of all."""


def in_fewer_patches(sharing: Sharing, ways: Iterable[RowFilling], width: float) -> Sharing:
    """Return shares of which fewer are in more than one patch, or the same ones.

    Args:
        sharing: so that all are back as early as can be.
        ways: to share the same work out among the same robots.
        width: of the strip that a stroke covers, metres.
    """
    best, parted = sharing, number_of_parted(sharing.shares, width)
    latest = sharing.back * (1.0 + _WORTH)
    for each in ways if parted else ():
        found = earliest(each, latest)
        for step in range(1, _STEPS + 1):
            if found is None or found.back > latest:
                break
            left = number_of_parted(found.shares, width)
            if (left, found.back) < (parted, best.back) and _is_even(found):
                best, parted = found, left
            shares = each.shares(sharing.back + step / _STEPS * (latest - sharing.back)) if left else ()
            found = each_turned(shares) if shares else None
    return best


def number_of_parted(shares: Sequence[Share], width: float) -> int:
    """Return how many shares are in more than one patch.

    Args:
        shares: of a work.
        width: of the strip that a stroke covers, metres.
    """
    return sum(not _is_one(each, _TOUCHING * width) for each in shares)


def _is_one(share: Share, touching: float) -> bool:
    """Return whether all strokes of a share are in one patch with its first."""
    material = share.run.material
    first, *rest = range(material.numbers(share.run.begin).start, material.numbers(share.end).stop)
    near, border, left = material.near(touching), [first], set(rest)
    while border:
        more = left.intersection(near[border.pop()])
        left -= more
        border += more
    return not left


def _is_even(sharing: Sharing) -> bool:
    backs = [each.back for each in sharing.shares]
    return sharing.back * len(backs) <= (1.0 + _WORTH) * sum(backs)


def in_rows(work: Work) -> Work | None:
    """Return a work row by row, to and fro, from about where it begins; None if it is not laid in rows."""
    if work.coverage is None or work.ordered or not all(each.reversible for each in work.strokes):
        return None
    ahead = _direction(work.strokes)
    if ahead is None:
        return None
    ends = np.array([[each.points[0][:2], each.points[-1][:2]] for each in work.strokes])
    along, across = ends @ ahead, (ends @ np.array([-ahead[1], ahead[0]])).mean(axis=1)
    rows: list[list[int]] = []
    beyond = -inf
    for i in across.argsort(kind="stable").tolist():
        if across[i] > beyond:
            beyond = across[i] + work.coverage.width / 2.0
            rows.append([])
        rows[-1].append(i)
    ordered = [sorted(row, key=along.mean(axis=1).__getitem__) for row in rows]
    upwards = [each if along[i, 0] <= along[i, 1] else turned(each) for i, each in enumerate(work.strokes)]
    both = [([upwards[i] for i in row], [turned(upwards[i]) for i in reversed(row)]) for row in ordered]
    begin = work.entry or work.strokes[0].points[0]
    return replace(work, strokes=min(_to_and_fro(begin, both), _to_and_fro(begin, both[::-1]))[1])


def _to_and_fro(
    begin: Position, rows: Sequence[tuple[list[Stroke], list[Stroke]]]
) -> tuple[float, tuple[Stroke, ...]]:
    """Return the fewest metres between strokes of rows, each in one of two directions, and these."""
    ways = [(0.0, begin, list[Stroke]())]
    for both in rows:
        ways = [min((_followed(*way, row) for way in ways), key=itemgetter(0)) for row in both]
    metres, _, done = min(ways, key=itemgetter(0))
    return metres, tuple(done)


def _followed(
    metres: float, at: Position, done: list[Stroke], row: list[Stroke]
) -> tuple[float, Position, list[Stroke]]:
    for each in row:
        metres += dist(at, each.points[0])
        at = each.points[-1]
    return metres, at, [*done, *row]


def _direction(strokes: Sequence[Stroke]) -> NDArray[np.float64] | None:
    """Return the direction in which all strokes are laid, as a unit vector; None if there is none."""
    legs = np.array([np.subtract(two, one)[:2] for each in strokes for one, two in pairwise(each.points)])
    legs = legs[np.hypot(*legs.T) > 0.0] if len(legs) else legs
    if not len(legs):
        return None
    longest = legs[np.hypot(*legs.T).argmax()]
    ahead = longest / np.hypot(*longest)
    aside = np.abs(legs @ np.array([-ahead[1], ahead[0]])) / np.hypot(*legs.T)
    return ahead if (aside < _PARALLEL).all() else None
