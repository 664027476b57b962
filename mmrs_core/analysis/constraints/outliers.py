"""Which places of a mission and its context lie together, and which lie apart from the rest.

Three hands write places: that of the homes, that of the tasks, and that of the context. Elements that one
hand wrote, and a file as a whole, can be wrong in the same respect; so what counts is how many elements and
hands agree, never how many vertices.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator
from dataclasses import dataclass
from math import cos, radians

import numpy as np
from numpy.typing import NDArray

from mmrs_core.grounding.features import child, number
from mmrs_core.grounding.frame import (
    coordinates_of,
    is_geographic,
    is_relative,
    on_earth,
    origin_of,
    reference_in,
)
from mmrs_core.languages.element import Element, container_of
from mmrs_core.languages.modelset import ModelSet

WIDEST = 100_000.0
"""Metres from a place to the next one that are meant unless the mission says otherwise: farther than robots
of these languages go without a task in between, and less than exchanging figures moves most places."""
NEAR = 5_000.0
"""Metres within which places belong to one site."""
EARTH_RADIUS = 6_371_000.0
"""Metres, mean."""
_MOST = 1000
"""Points that are compared with each other; where there are more, neighbours are taken together."""

EXCHANGED, NORTH_SIGN, EAST_SIGN, BOTH_SIGNS = "exchanged", "latitude", "longitude", "both"
_Numbers = NDArray[np.float64]
_Whole = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Owner:
    """An element with places of its own: a robot, an origin, a task, an area.

    Attributes:
        hand: who wrote it: ``homes``, ``tasks`` or ``context``.
        coordinates: those that have a place; its rows in the table of degrees from ``first``.
    """

    element: Element
    hand: str
    coordinates: tuple[Element, ...]
    first: int


@dataclass(frozen=True, slots=True)
class Stray:
    """An element that lies apart from the rest, wholly or with one coordinate.

    Attributes:
        apart: metres to the nearest place of the rest.
        reading: the one other reading of its figures that puts it among the rest; None for none or several.
    """

    element: Element
    apart: float
    reading: str | None


@dataclass(frozen=True, slots=True)
class Rival:
    """One of several groups of elements of which any may be the one that is right.

    Attributes:
        owners: its elements, in order. whole: whether they are all that their file has.
        apart: metres to the nearest of the other groups.
        exchanged: whether exchanging latitude and longitude would put it among one of the others.
    """

    owners: tuple[Owner, ...]
    whole: bool
    apart: float
    exchanged: bool


@dataclass(frozen=True, slots=True)
class Outliers:
    """What lies apart: single elements where the rest agrees, or groups where it does not."""

    strays: tuple[Stray, ...] = ()
    rivals: tuple[Rival, ...] = ()


def outliers_of(models: ModelSet) -> Outliers:
    """Return what lies apart; at least the mission's ``largestGap`` from everything else.

    Where the mission does not say, figures that look exchanged are found from `NEAR` on.
    """
    known = _whereabouts(models)
    owners = tuple(_owners(models, known))
    placed = [each for owner in owners for each in owner.coordinates]
    degrees = np.array([known[each] for each in placed], float).reshape(-1, 2)
    readable = np.array([is_geographic(each) for each in placed], bool)
    said = number(models.mission, "largestGap")
    gap = WIDEST if said is None or said <= 0.0 else said
    found = _Places(owners, degrees, readable, gap).outliers()
    if said is not None or found.strays or found.rivals:
        return found
    fine = _Places(owners, degrees, readable, NEAR).outliers()
    rivals = fine.rivals if any(each.exchanged for each in fine.rivals) else ()
    return Outliers(tuple(each for each in fine.strays if each.reading == EXCHANGED), rivals)


def _whereabouts(models: ModelSet) -> dict[Element, tuple[float, float]]:
    """Return latitude and longitude of all coordinates; those of a local mission lie about (0, 0)."""
    origin, reference = origin_of(models.mission), reference_in(models.context)
    local = origin is not None and is_relative(origin)
    base = (0.0, 0.0) if local or origin is None else _own(origin)
    known: dict[Element, tuple[float, float] | None] = {}
    for coordinate in (*coordinates_of(models.mission), *coordinates_of(models.context)):
        chain: dict[Element, None] = {}
        each: Element | None = coordinate
        while each is not None and each not in known and each not in chain and is_relative(each):
            chain[each] = None
            each = reference(each)
        if each is not None and each not in known:
            known[each] = None if local or each in chain else _own(each)
        place = base if each is None else known[each]
        for each in reversed(chain):
            place = known.setdefault(each, _moved(place, each))
    return {each: place for each, place in known.items() if place is not None}


def _own(coordinate: Element) -> tuple[float, float] | None:
    if not on_earth(coordinate):
        return None
    return number(coordinate, "latitude") or 0.0, number(coordinate, "longitude") or 0.0


def _moved(base: tuple[float, float] | None, coordinate: Element) -> tuple[float, float] | None:
    x, y = number(coordinate, "x"), number(coordinate, "y")
    if base is None or x is None or y is None:
        return None
    metres = EARTH_RADIUS * radians(1.0)
    return base[0] + y / metres, base[1] + x / metres / max(cos(radians(base[0])), 1e-3)


def _owners(models: ModelSet, known: Container[Element]) -> Iterator[Owner]:
    first = 0
    for hand, element in _written(models):
        found = tuple(each for each in (element, *coordinates_of(element)) if each in known)
        if found:
            yield Owner(element, hand, found, first)
            first += len(found)


def _written(models: ModelSet) -> Iterator[tuple[str, Element]]:
    """Yield what hands wrote: the parts of the two models that hold places, and each robot of the team."""
    team = child(models.mission, "team")
    for root in (models.mission, models.context):
        seen: set[Element] = set()
        for coordinate in coordinates_of(root):
            element, above = coordinate, container_of(coordinate)
            while above is not None and above is not root and above is not team:
                element, above = above, container_of(above)
            if element not in seen:
                seen.add(element)
                home = above is team or element is child(models.mission, "origin")
                yield "context" if root is models.context else "homes" if home else "tasks", element


class _Places:
    """Places, and the cluster of each: those less than a gap from each other, directly or by others."""

    def __init__(
        self, owners: tuple[Owner, ...], degrees: _Numbers, readable: NDArray[np.bool_], gap: float
    ) -> None:
        self._owners = owners
        self._degrees = degrees
        self._readable = readable
        self._points = points_of(degrees)
        self._clusters = _clusters(self._points, gap)

    def outliers(self) -> Outliers:
        """Return what lies apart."""
        if not self._clusters.any():
            return Outliers()
        candidates = self._candidates()
        if len(candidates) == 1:
            return Outliers(tuple(self._strays(candidates)))
        return Outliers(tuple(self._strays(candidates)), tuple(self._rivals(candidates)))

    def _of(self, owner: Owner) -> _Whole:
        return self._clusters[owner.first : owner.first + len(owner.coordinates)]

    def _seat(self, owner: Owner) -> int | None:
        """Return the cluster with more than half of an element's coordinates."""
        return _winner(Counter(self._of(owner).tolist()))

    def _candidates(self) -> tuple[int, ...]:
        """Return the clusters that may be right: one where hands and files agree."""
        hands: dict[str, Counter[int]] = {}
        for owner in self._owners:
            seat = self._seat(owner)
            if seat is not None:
                hands.setdefault(owner.hand, Counter())[seat] += 1
        chosen = {hand: winner for hand, votes in hands.items() if (winner := _winner(votes)) is not None}
        homes, tasks, context = (chosen.get(hand) for hand in ("homes", "tasks", "context"))
        found = dict.fromkeys(each for each in (homes, tasks, context) if each is not None)
        if context is not None and context in (homes, tasks):
            return (context,)  # the two files agree
        if found:
            return tuple(found)
        return tuple(dict.fromkeys(self._clusters.tolist()))

    def _strays(self, candidates: tuple[int, ...]) -> Iterator[Stray]:
        rest = self._points[np.isin(self._clusters, candidates)]
        for owner in self._owners:
            off = ~np.isin(self._of(owner), candidates)
            rows = owner.first + np.flatnonzero(off)
            if off.all():
                yield self._stray(owner.element, rows, rest, candidates)
            else:
                for row in rows:
                    each = owner.coordinates[row - owner.first]
                    yield self._stray(each, np.array([row]), rest, candidates)

    def _stray(self, element: Element, rows: _Whole, rest: _Numbers, candidates: tuple[int, ...]) -> Stray:
        apart = _nearest(self._points[rows], rest)
        readings = [name for name, read in _READINGS if _fits(read(self._degrees[rows]), rest)]
        one = len(readings) == 1 and len(candidates) == 1 and bool(self._readable[rows].all())
        return Stray(element, apart, readings[0] if one else None)

    def _rivals(self, candidates: tuple[int, ...]) -> Iterator[Rival]:
        for cluster in candidates:
            mine = self._clusters == cluster
            others = self._points[np.isin(self._clusters, [each for each in candidates if each != cluster])]
            owners = tuple(each for each in self._owners if self._seat(each) == cluster)
            files = {each.hand == "context" for each in owners}
            same = [each for each in self._owners if (each.hand == "context") in files]
            if owners:
                yield Rival(
                    owners,
                    len(files) == 1 and len(same) == len(owners),
                    _nearest(self._points[mine], others),
                    _fits(_exchange(self._degrees[mine]), others),
                )


def _winner(votes: Counter[int]) -> int | None:
    """Return what more than half of the votes are for."""
    return next((each for each, count in votes.items() if 2 * count > votes.total()), None)


def points_of(degrees: _Numbers) -> _Numbers:
    """Return points on a sphere, metres from its centre: (n, 3) for latitudes and longitudes as (n, 2)."""
    north, east = np.radians(degrees[:, 0]), np.radians(degrees[:, 1])
    flat = np.cos(north)
    return EARTH_RADIUS * np.column_stack((flat * np.cos(east), flat * np.sin(east), np.sin(north)))


def _clusters(points: _Numbers, gap: float) -> _Whole:
    """Return the cluster of each point, numbered from 0 by its first point."""
    if not len(points) or float(np.linalg.norm(np.ptp(points, axis=0))) <= gap:
        return np.zeros(len(points), np.intp)
    side, cells = gap / 100.0, np.zeros((0, 3))
    while not len(cells) or len(cells) > _MOST:
        cells, index = np.unique(np.floor(points / side), axis=0, return_inverse=True)
        side *= 2.0
    index = index.reshape(-1)
    centres = np.zeros((len(cells), 3))
    centres[index] = points
    labels = _linked(centres, gap)[index]
    names = {each: number for number, each in enumerate(dict.fromkeys(labels.tolist()))}
    return np.array([names[each] for each in labels.tolist()], np.intp)


def _linked(points: _Numbers, gap: float) -> _Whole:
    """Return the cluster of each of a few points."""
    labels = np.full(len(points), -1, np.intp)
    for start in range(len(points)):
        pending = [start] if labels[start] < 0 else []
        labels[pending] = start
        while pending:
            away = np.linalg.norm(points - points[pending.pop()], axis=1)
            reached = np.flatnonzero((away <= gap) & (labels < 0))
            labels[reached] = start
            pending.extend(reached.tolist())
    return labels


def _nearest(points: _Numbers, others: _Numbers) -> float:
    """Return the smallest distance on the sphere between two groups, metres; large ones are sampled."""
    one, other = (each[:: len(each) // _MOST + 1] for each in (points, others))
    if not len(one) or not len(other):
        return 0.0
    chord = min(float(np.linalg.norm(other - each, axis=1).min()) for each in one)
    return 2.0 * EARTH_RADIUS * float(np.arcsin(min(chord / (2.0 * EARTH_RADIUS), 1.0)))


def _fits(degrees: _Numbers | None, rest: _Numbers) -> bool:
    """Return whether every place lies among the rest: no farther off than the rest is wide, or than near."""
    if degrees is None or not len(rest):
        return False
    sample = rest[:: len(rest) // _MOST + 1]
    reach = min(max(NEAR, float(np.linalg.norm(np.ptp(rest, axis=0)))), WIDEST / 2.0)
    points = points_of(degrees)[:_MOST]
    return all(float(np.linalg.norm(sample - each, axis=1).min()) <= reach for each in points)


def _exchange(degrees: _Numbers) -> _Numbers | None:
    return degrees[:, ::-1] if (np.abs(degrees[:, 1]) <= 90.0).all() else None


_READINGS = (
    (EXCHANGED, _exchange),
    (NORTH_SIGN, lambda degrees: degrees * (-1.0, 1.0)),
    (EAST_SIGN, lambda degrees: degrees * (1.0, -1.0)),
    (BOTH_SIGNS, lambda degrees: -degrees),
)
