"""Where robots come close to each other, and by how much later one must be so that they do not.

A robot on a straight piece is, at a share s of it, no earlier than the least time allows, and no later than
it must be to arrive in time. Two robots at shares s and t of their pieces may be there at one time where
s·L₁ − t·L₂ lies between two bounds, L being the least times; and a delay of one of them moves these. The
shares at which they are too near are a convex set, part of an ellipse, over which s·L₁ − t·L₂ has a
least and a greatest value. So whether they meet, and which delays do not help, is found without cutting
pieces, exact but for rounding.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from mmrs_core.planning.sweep import Flags, Floats, Indices, overlapping
from mmrs_core.planning.timeline import HomeRelation, Ride
from mmrs_core.scene import Position

Spans: TypeAlias = tuple[Floats, Floats]
"""Lower and upper bounds (n,); a lower one that exceeds the upper one: none."""

_SLOPE = 0.05
"""Metres by which robots over neighbouring homes may be nearer than the homes: these differ in height."""

_ONE_PLACE = 0.15
"""Metres within which two homes are one place, where no two robots can be."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """All that robots may take up: straight pieces, each within a span of time.

    Attributes:
        owners: (n,) number of the robot.
        steps: (n,) of its plan; over: (n,) the step with whose begin the piece is over for certain.
        times: (n, 2) seconds between which the robot may be on each piece.
        places: (n, 2, 3) ends of each piece, equal for a stay.
        least: (n,) seconds that it takes along the piece at least.
        radii: (n,) metres from the piece within which it may be.
        relations: (n,) where each piece is, seen from the robot's home (see `HomeRelation`).
    """

    owners: Indices
    steps: Indices
    over: Indices
    times: Floats
    places: Floats
    least: Floats
    radii: Floats
    relations: Indices

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.owners)


def pieces_of(rides: Iterable[Ride], owner: int = 0) -> Pieces:
    """Return the rides of a robot as pieces, one for each leg or stay."""
    rows, places = [], []
    for ride in rides:
        points = ride.points if len(ride.points) > 1 else ride.points * 2
        seconds = ride.least or (0.0,)
        before, whole = 0.0, sum(seconds)
        for leg, each in zip(pairwise(points), seconds, strict=True):
            late = ride.late - (whole - before - each)
            rows.append((ride.step, ride.over, ride.relation, ride.early + before, late, each, ride.radius))
            places.append(leg)
            before += each
    table = np.array(rows, dtype=np.float64).reshape(-1, 7)
    steps, over, relations = table[:, :3].T.astype(np.intp)
    ends = np.array(places, dtype=np.float64).reshape(-1, 2, 3)
    owners = np.full(len(rows), owner, np.intp)
    return Pieces(owners, steps, over, table[:, 3:5], ends, table[:, 5], table[:, 6], relations)


def joined(parts: Sequence[Pieces]) -> Pieces:
    """Return the pieces of several robots."""
    fields = Pieces.__slots__
    return Pieces(*(np.concatenate([getattr(part, each) for part in parts]) for each in fields))


def some_of(pieces: Pieces, chosen: Flags) -> Pieces:
    """Return those pieces of a robot that are chosen."""
    return Pieces(*(getattr(pieces, each)[chosen] for each in Pieces.__slots__))


class Proximity:
    """Pieces of robots with the distances to keep between them.

    Homes that are nearer to each other are the operator's choice: a robot that stands at such a home is
    no hindrance to the other one at its own, nor in the column over it, while their distance is at least
    that of their homes.
    """

    def __init__(self, pieces: Pieces, homes: Sequence[Position], least: float) -> None:
        """Make it.

        Args:
            pieces: of all robots.
            homes: of the robots, by their number.
            least: metres to keep.
        """
        self.pieces, self._least = pieces, least
        self._homes = np.array(homes, dtype=np.float64).reshape(-1, 3)

    def meetings(self, spare: float, moved: Flags | None = None) -> tuple[Indices, Indices]:
        """Return the pairs of pieces, each once and in order, on which two robots may come too near at once.

        Args:
            spare: seconds by which their times are apart at least.
            moved: (n,) only pairs of which one has moved; None: all.
        """
        pieces = self.pieces
        times = pieces.times + np.array([0.0, spare])
        reach = pieces.radii + self._least / 2.0 + 1e-6
        chosen = np.ones(len(pieces), np.bool_) if moved is None else moved
        i, j = overlapping(pieces.owners, times, pieces.least, pieces.places, reach, chosen)
        begin, end = self.delays(i, j, spare)
        near = (begin < 0.0) & (end > 0.0)
        return i[near], j[near]

    def paths(self, i: Indices, others: Indices) -> tuple[Indices, Indices]:
        """Return pairs of some pieces and others, of which the paths may be too near whatever the times."""
        low, high = self.pieces.places.min(axis=1), self.pieces.places.max(axis=1)
        reach = (self.pieces.radii + self._least / 2.0)[:, None]
        low, high = low - reach, high + reach
        near = np.ones((len(i), len(others)), np.bool_)
        for axis in range(3):
            near &= low[i, None, axis] < high[others, axis]
            near &= low[others, axis] < high[i, None, axis]
        first, second = np.nonzero(near)
        return i[first], others[second]

    def delays(self, i: Indices, j: Indices, spare: float, needed: Floats | None = None) -> Spans:
        """Return between which further delays of the second of two pieces robots may come too near.

        Args:
            spare: seconds by which their times are apart at least.
            needed: (n,) metres that paths must be apart; None: as much as is to be kept.
        """
        pieces = self.pieces
        low, high = self._spans(i, j, pieces.least[i], pieces.least[j], needed)
        never = low > high
        low[never] = high[never] = 0.0
        begin = low - (pieces.times[j, 1] - pieces.least[j] - pieces.times[i, 0]) - spare
        end = high + (pieces.times[i, 1] - pieces.least[i] - pieces.times[j, 0]) + spare
        begin[never], end[never] = np.inf, -np.inf
        return begin, end

    def soonest(self, i: Indices, j: Indices) -> Floats:
        """Return (n,): seconds before which two robots are certainly not too near."""
        none = np.zeros(len(i))
        one, two = (
            self._spans(a, b, self.pieces.least[a], none)[0] + self.pieces.times[a, 0]
            for a, b in ((i, j), (j, i))
        )
        later: Floats = np.maximum(one, two)
        return later

    def nearest(self, i: Indices, j: Indices, spare: float) -> Floats:
        """Return (n,): how many metres robots are apart at the least on pieces where they meet."""
        none, full = np.zeros(len(i)), self._needed(i, j)
        for _ in range(30):
            middle = (none + full) / 2.0
            begin, end = self.delays(i, j, spare, middle)
            near = (begin < 0.0) & (end > 0.0)
            none, full = np.where(near, none, middle), np.where(near, middle, full)
        apart: Floats = np.maximum(full - self.pieces.radii[i] - self.pieces.radii[j], 0.0)
        return apart

    def _spans(self, i: Indices, j: Indices, p: Floats, q: Floats, needed: Floats | None = None) -> Spans:
        places = self.pieces.places
        return spans_where_near(places[i], places[j], self._needed(i, j) if needed is None else needed, p, q)

    def at_home(self, i: Indices, j: Indices) -> Flags:
        """Return (n,): whether one of two robots then stands at its home."""
        relations = self.pieces.relations
        flags: Flags = (relations[i] == HomeRelation.HOME) | (relations[j] == HomeRelation.HOME)
        return flags

    def _needed(self, i: Indices, j: Indices) -> Floats:
        """Return (n,): the metres that two paths must be apart."""
        pieces = self.pieces
        gap = np.linalg.norm(self._homes[pieces.owners[i]] - self._homes[pieces.owners[j]], axis=1)
        relations = np.sort(np.stack([pieces.relations[i], pieces.relations[j]]), axis=0)
        excused = (relations[0] > HomeRelation.ELSEWHERE) & (relations[1] == HomeRelation.HOME)
        at_homes = np.maximum(gap - _SLOPE, _ONE_PLACE)
        apart = self._least + pieces.radii[i] + pieces.radii[j]
        needed: Floats = np.where(excused & (gap < self._least), at_homes, apart)
        return needed


def spans_where_near(one: Floats, two: Floats, needed: Floats, p: Floats, q: Floats) -> Spans:
    """Return the least and the greatest p·s − q·t of shares s and t at which legs are nearer than needed.

    They are on a side of the square of shares, or where the ellipse's tangent is parallel to the lines of
    one value.

    Args:
        one, two: (n, 2, 3) ends of legs.
        needed: (n,) metres.
        p, q: (n,)
    """
    u, v, w = one[:, 1] - one[:, 0], two[:, 1] - two[:, 0], one[:, 0] - two[:, 0]
    uu, uv, vv = _dot(u, u), _dot(u, v), _dot(v, v)
    square = needed**2
    low, high = np.full(len(w), np.inf), np.full(len(w), -np.inf)
    for along, length, gap, shift, factor in (
        (-v, vv, w, 0.0, -q),
        (-v, vv, w + u, p, -q),
        (u, uu, w, 0.0, p),
        (u, uu, w - v, -q, p),
    ):
        begin, end = _shares_within(along, length, gap, square)
        near = begin < end
        for share in (begin, end):
            value = shift + factor * share
            low = np.where(near, np.minimum(low, value), low)
            high = np.where(near, np.maximum(high, value), high)
    uw, vw = _dot(u, w), _dot(v, w)
    across = uu * vv - uv * uv
    slanted = across > 1e-12 * uu * vv
    across = np.where(slanted, across, 1.0)
    s, t = (uv * vw - vv * uw) / across, (uu * vw - uv * uw) / across
    apart = w + s[:, None] * u - t[:, None] * v
    left = square - _dot(apart, apart)
    ds, dt = (vv * p - uv * q) / across, (uv * p - uu * q) / across
    steepness = p * ds - q * dt
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.where(steepness > 0.0, np.sqrt(np.maximum(left, 0.0) / steepness), 0.0)
    for sign in (-step, step):
        a, b = s + sign * ds, t + sign * dt
        inside = slanted & (left > 0.0) & (a >= 0.0) & (a <= 1.0) & (b >= 0.0) & (b <= 1.0)
        value = p * a - q * b
        low = np.where(inside, np.minimum(low, value), low)
        high = np.where(inside, np.maximum(high, value), high)
    return low, high


def _shares_within(along: Floats, length: Floats, gap: Floats, square: Floats) -> Spans:
    """Return between which shares, from 0 to 1, |gap + share · along|² is less than a square."""
    middle, rest = _dot(gap, along), _dot(gap, gap) - square
    moves = length > 0.0
    root = middle**2 - length * rest
    some = np.where(moves, root > 0.0, rest < 0.0)
    half, safe = np.sqrt(np.maximum(root, 0.0)), np.where(moves, length, 1.0)
    begin = np.where(moves, np.maximum((-middle - half) / safe, 0.0), 0.0)
    end = np.where(moves, np.minimum((-middle + half) / safe, 1.0), 1.0)
    return begin, np.where(some, end, begin)


def _dot(a: Floats, b: Floats) -> Floats:
    product: Floats = np.einsum("nk,nk->n", a, b)
    return product
