"""Where the radio of a robot reaches its home: in balls about it, and about relays with a chain to it.

A path inside of balls that is as short as can be turns only at obstacles and where two balls meet, for a ball
is convex. So routes get these places beside the corners of obstacles, and legs are clear that balls cover.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from math import dist, hypot, inf, sqrt
from typing import TypeAlias

import numpy as np

from mmrs_core.diagnostics import lengths
from mmrs_core.geometry.clearance import EPSILON
from mmrs_core.geometry.segments import legs_of
from mmrs_core.planning.obstacles import Flags, Floats
from mmrs_core.planning.positions import SLACK
from mmrs_core.scene import AreaUse, Position, Robot, Scene, Stroke, distinct_works
from mmrs_core.scene.relays import Relay, radio_range, relays_of

_Disc: TypeAlias = tuple[float, float, float]

_ASIDE = 1.1
"""Times the distance to keep from an area at which the corners of routes around it are at most."""


_PLACES = 33
"""Places on each leg that are looked at for the farthest one out of range."""


@dataclass(frozen=True)
class Reach:
    """Balls in which one robot is in range of its radio.

    Attributes:
        names: of relays; empty for the control station at home, which comes first.
        centres: (east, north, up) of each, metres.
        ranges: the smaller of both ranges, metres, less what the relay may be elsewhere.
        error: of positions, by which balls are smaller, metres.
        severed: the relays that have no chain to home, in words: which, and by how much they miss one.
    """

    names: tuple[str, ...]
    centres: tuple[Position, ...]
    ranges: tuple[float, ...]
    error: float = 0.0
    severed: tuple[str, ...] = ()

    @cached_property
    def _balls(self) -> tuple[Floats, Floats]:
        return np.array(self.centres, dtype=np.float64), np.array(self.ranges, dtype=np.float64) - self.error

    def covers(self, legs: Floats, spare: float = -SLACK) -> Flags:
        """Return whether balls cover each of n straight legs (n, 2, 3).

        A ball covers a stretch of a leg between two shares of it; stretches are joined from the begin on.

        Args:
            legs: (n, 2, 3).
            spare: metres by which balls are smaller.
        """
        centres, radii = self._balls
        smaller = np.where(radii > spare, (radii - spare) ** 2, -inf)
        offset, away = legs[:, None, 1] - legs[:, None, 0], legs[:, None, 0] - centres
        square = np.maximum((offset * offset).sum(axis=2), 1e-18)
        half = (offset * away).sum(axis=2)
        root = half * half - square * ((away * away).sum(axis=2) - smaller)
        span = np.sqrt(np.maximum(root, 0.0))
        begins = np.where(root >= 0.0, (-half - span) / square, inf)
        ends = np.where(root >= 0.0, (-half + span) / square, -inf)
        covered = np.zeros(len(legs))
        for _ in radii:
            further = np.where(begins <= covered[:, None] + 1e-12, ends, -inf).max(axis=1, initial=-inf)
            if not (further > covered).any():
                break
            covered = np.maximum(covered, further)
        started = (begins <= 1e-12).any(axis=1, where=ends >= -1e-12)
        found: Flags = started & (covered >= 1.0 - 1e-12)
        return found

    def contains(self, points: Sequence[Position], spare: float = -SLACK) -> bool:
        """Return whether balls cover a polyline of one point or more; mostly a single one does."""
        balls = zip(self.centres, self.ranges, strict=True)
        shorter = self.error + spare + SLACK
        alone = any(all(dist(place, at) <= far - shorter for place in points) for at, far in balls)
        return alone or bool(self.covers(legs_of(points), spare).all())

    def turns(self, height: float) -> Floats:
        """Return (n, 2): where routes at a height may turn from one ball into another: just inside."""
        discs = self._discs(height)
        places = [place for one, two in combinations(discs, 2) for place in _crossings(one, two)]
        return np.array(places, dtype=np.float64).reshape(-1, 2)

    def _discs(self, height: float) -> list[_Disc]:
        centres, radii = self._balls
        across = np.maximum(radii - EPSILON, 0.0) ** 2 - (centres[:, 2] - height) ** 2
        places = zip(centres.tolist(), across.tolist(), strict=True)
        return [(east, north, sqrt(square)) for (east, north, _), square in places if square > 0.0]

    def gates(self, ends: Sequence[Position]) -> list[Position]:
        """Return places through which routes may get from ball to ball at a height that is neither end's.

        These are, of the disc in which the rims of two balls meet, the places nearest to the ends; none where
        the balls meet beside each other at the height of an end.
        """
        found = list[Position]()
        balls = [
            (np.array(each), each, r - EPSILON) for each, r in zip(self.centres, self._balls[1], strict=True)
        ]
        for (one, here, r), (two, there, s) in combinations(balls, 2):
            apart = dist(here, there)
            if not abs(r - s) < apart < r + s or any(self._beside(here, r, there, s, up) for *_, up in ends):
                continue
            axis, along = (two - one) / apart, (apart * apart + r * r - s * s) / (2.0 * apart)
            rim = sqrt(r * r - along * along)
            for end in ends:
                aside = np.array(end) - one
                aside = aside - aside.dot(axis) * axis
                aside *= min(1.0, rim / max(float(np.linalg.norm(aside)), 1e-9))
                east, north, up = (one + along * axis + aside).tolist()
                found.append((east, north, up))
        return found

    def _beside(self, one: Position, r: float, two: Position, s: float, up: float) -> bool:
        """Return whether the rims of two balls cross at a height."""
        first, second = (each * each - (at[2] - up) ** 2 for each, at in ((r, one), (s, two)))
        if first <= 0.0 or second <= 0.0:
            return False
        return any(True for _ in _crossings((*one[:2], sqrt(first)), (*two[:2], sqrt(second))))

    def beyond(self, points: Sequence[Position], spare: float = 0.0) -> str:
        """Return in words where a polyline is farthest out of range, and how far from the nearest station."""
        legs = legs_of(points)
        shares = np.linspace(0.0, 1.0, _PLACES)[:, None, None]
        places = (legs[:, 0] + shares * (legs[:, 1] - legs[:, 0])).reshape(-1, 3)
        away = np.linalg.norm(places[:, None] - np.array(self.centres), axis=2)
        outside = away - np.array(self.ranges)
        worst = int(outside.min(axis=1).argmax())
        nearest = int(outside[worst].argmin())
        metres, limit = lengths(float(away[worst, nearest]) + spare + self.error, self.ranges[nearest])
        east, north, up = places[worst].tolist()
        name = _named(self.names[nearest])
        severed = " and from ".join(self.severed)
        without = f"; no chain of relays leads home from {severed}" if severed else ""
        at = f" at ({east:.1f}, {north:.1f}, {up:.1f})"
        return f"{metres} from {name}{at}, its radio reaches {limit}{without}"


def reach_of(robot: Robot, relays: Sequence[Relay], error: float) -> Reach | None:
    """Return where a robot is in range; None where its range is unknown."""
    range = radio_range(robot.type)
    if range is None:
        return None
    chain, rest = [Relay("", robot.home, range)], list(relays)
    position = 0
    while position < len(chain):
        here = chain[position]
        near = [each for each in rest if _linked(each, here)]
        chain += near
        rest = [each for each in rest if each not in near]
        position += 1
    return Reach(
        tuple(each.name for each in chain),
        tuple(each.position for each in chain),
        tuple(min(range, each.range) - each.spread for each in chain),
        error,
        tuple(_missing(each, chain) for each in rest),
    )


def _linked(one: Relay, two: Relay) -> bool:
    return _missed(one, two) <= 0.0


def _missed(one: Relay, two: Relay) -> float:
    """Return the metres by which two relays may be too far apart to reach each other."""
    return dist(one.position, two.position) + one.spread + two.spread - min(one.range, two.range)


def _missing(relay: Relay, chain: Sequence[Relay]) -> str:
    """Return in words by how much a relay misses the nearest of a chain."""
    nearest = min(chain, key=lambda each: _missed(each, relay))
    allowed = min(nearest.range, relay.range)
    away, limit = lengths(_missed(nearest, relay) + allowed, allowed)
    far = f"it is {away} from {_named(nearest.name)}"
    return f"{_named(relay.name)}: {far}, they reach each other within {limit}"


def _named(relay: str) -> str:
    return f"relay '{relay}'" if relay else "home"


class Reaches:
    """What limits where the robots of a scene may go, robot by robot: those of one home share it."""

    def __init__(self, scene: Scene) -> None:
        """Find out between which places all ways lie.

        Args:
            scene: expanded.
        """
        self._relays = (*relays_of(scene.elements), *scene.stations)
        self._error = scene.position_error
        self._known: dict[tuple[Position, float | None], Reach | None] = {}
        self._corners = tuple(_corners(scene))

    def of(self, robot: Robot) -> Reach | None:
        """Return where a robot is in range; None where it is wherever it may ever be, or that is unknown."""
        key = robot.home, radio_range(robot.type)
        if key not in self._known:
            found = reach_of(robot, self._relays, self._error)
            within = found is None or all(
                dist(robot.home, each) <= found.ranges[0] - self._error for each in self._corners
            )
            self._known[key] = None if within else found
        return self._known[key]


def _corners(scene: Scene) -> Iterator[Position]:
    """Yield the corners of a box in which robots stay: about homes, works, corridors and areas."""
    points = [robot.home for robot in scene.robots]
    points += [p for work in distinct_works(scene.works) for stroke in work.strokes for p in stroke.points]
    points += [work.entry for work in distinct_works(scene.works) if work.entry is not None]
    heights = {up for _, _, up in points}
    if scene.transit_altitude is not None:
        heights.add(scene.transit_altitude)
    known = [robot.kinematics for robot in scene.robots if robot.kinematics is not None]
    heights |= {each.floor for each in known if each.floor > -inf}
    widest = max((robot.clearance for robot in scene.robots), default=0.0)
    apart = (scene.minimum_separation or 0.0) + 2.0 * scene.position_error + widest + 1.0
    top = max(heights, default=0.0) + len(scene.robots) * apart
    ceiling = max((each.ceiling for each in known), default=inf)
    sides = [(east, north, 2.0 * apart) for east, north, _ in points]
    for area in scene.areas:
        if area.use is not AreaUse.EMERGENCY:
            aside = _ASIDE * (area.safety_distance + widest + 1.0)
            sides += [(east, north, aside) for east, north in area.shell]
            heights |= {each for each in (area.low - aside, area.high + aside) if -inf < each <= ceiling}
    for corridor in scene.corridors:
        sides += [(east, north, apart) for east, north in corridor.line]
        heights |= {
            each for each in (corridor.low + widest, corridor.high - widest) if -inf < each <= ceiling
        }
    easts = [east + sign * aside for east, _, aside in sides for sign in (-1.0, 1.0)]
    norths = [north + sign * aside for _, north, aside in sides for sign in (-1.0, 1.0)]
    if points:
        yield from product(
            (min(easts), max(easts)), (min(norths), max(norths)), (min(heights), max(top, *heights))
        )


def _crossings(one: _Disc, two: _Disc) -> Iterator[tuple[float, float]]:
    """Yield where the rims of two discs cross."""
    (x, y, r), (u, v, s) = one, two
    apart = hypot(u - x, v - y)
    if not abs(r - s) < apart < r + s:
        return
    along = (apart * apart + r * r - s * s) / (2.0 * apart)
    aside = sqrt(max(0.0, r * r - along * along))
    east, north = (u - x) / apart, (v - y) / apart
    for sign in (-1.0, 1.0):
        yield x + along * east - sign * aside * north, y + along * north + sign * aside * east


def in_range_of(reach: Reach, strokes: Iterable[Stroke]) -> bool:
    """Return whether a robot is in range all along strokes, wherever their objects are."""
    return all(reach.contains(each.points, unsure(each) - SLACK) for each in strokes)


def unsure(stroke: Stroke) -> float:
    """Return by how many metres an object at the end of a stroke may be elsewhere."""
    return 0.0 if stroke.object is None else stroke.object_tolerance or 0.0
