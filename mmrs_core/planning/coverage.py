"""Works over areas: what a robot may cover of a polygon, and the strokes that cover it.

The entry point for rules is `work_over`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise
from math import floor

import numpy as np
import shapely
from shapely.geometry import GeometryCollection, Polygon
from shapely.geometry.base import BaseGeometry

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.polygons import parts, polygon, rings
from mmrs_core.planning.footprints import GRID
from mmrs_core.planning.in_passing import MOST_CUTS, in_passing
from mmrs_core.planning.limits import MOST
from mmrs_core.planning.lines import APART, Swath
from mmrs_core.planning.patterns import Pattern, layers_of
from mmrs_core.planning.pockets import pockets_of
from mmrs_core.planning.swaths import hatch_angle, swaths
from mmrs_core.planning.turnarounds import turned_around
from mmrs_core.scene import ActionAt, Area, Coverage, Point, Ring, Robot, Scene, Stroke, Work

_SMALLEST = 1e-6
"""Square metres under which a part of a target is rounding."""

_POCKETS = 5e-4
"""Share of a target that walled-in pockets may have to be left alone."""

_REMEMBERED = 32
"""Targets at most whose swaths are kept for the next robot."""


@dataclass(frozen=True, slots=True)
class Sweep:
    """How a polygon is to be covered.

    Attributes:
        altitude: height above the origin, metres.
        width: of the strip that a stroke covers, metres, overlap taken off.
        rule: name of the rule that asks.
        length: of what one action covers along the stroke, metres, overlap taken off; 0: no actions.
        action: name of the device action; needs a `length`.
        device: identifier of its device; empty: the only one that supports the action.
        parameters: of the action.
        speed: largest speed on the strokes, metres per second; None: see `Stroke`.
        slow_down: see `Stroke`.
        passing: name of the device's action that does the same in passing; None: the robot stops for each.
        interval: seconds between two of them in passing, at least.
        start: where the first stroke should be near, such as the task's initial position; None: anywhere.
        pattern: in which the strokes are laid and ordered.
    """

    altitude: float
    width: float
    rule: str
    length: float = 0.0
    action: str | None = None
    device: str = ""
    parameters: tuple[tuple[str, str], ...] = ()
    speed: float | None = None
    slow_down: float | None = None
    passing: str | None = None
    interval: float = 0.0
    start: Point | None = None
    pattern: Pattern = field(default_factory=Pattern)

    @property
    def along(self) -> float:
        """Return what an action covers along the stroke, metres; 0 where there is none."""
        return self.length if self.action is not None else 0.0


def work_over(scene: Scene, robot: Robot, shell: Ring, sweep: Sweep, holes: Sequence[Ring] = ()) -> Work:
    """Return the work that covers a polygon at one height: strokes in a good order, and the coverage.

    What is covered is the shell less its holes less what the robot's clearance forbids it at that
    height. Strokes keep out of the latter, but may leave the shell or cross a narrow hole where that is
    shorter. With an `action`, it is done along the strokes so that rectangles `length` along and
    `width` across the stroke, centred on the actions' points, cover the same; the strokes then go no
    further than their first and last action, and one with a single action may be a single point, about
    which all that is asked for lies within half of `length` and of `width`, whichever way the robot faces.

    Args:
        scene: for its areas.
        robot: for its clearance. Robots of one clearance get equal works and so can share them.
        shell: of the polygon, (east, north) in metres.
        sweep: how it is covered.
        holes: of the polygon.

    Raises:
        ValueError: a width or length is not positive where it must be, or a ring is unsound.
        InfeasibleError: clearance leaves nothing of the polygon, or it takes more than `MOST` actions.
    """
    action, width, length = sweep.action, sweep.width, sweep.length
    if action is not None and not length > 0:
        raise ValueError(f"action {action!r} needs a length to cover along the stroke, {length} is none")
    target = target_of(scene, robot, shell, holes, sweep.altitude)
    area = sum(piece.area for piece in target)
    if not target:
        asked = shapely.difference(polygon(shell), _union(holes), grid_size=GRID).area
        raise InfeasibleError(
            f"polygon of {asked:.1f} m² lies within the clearance of areas or is closed in by them"
        )
    if length > 0 and width > 0 and area > MOST * length * width:
        wanted = area / length / width
        raise InfeasibleError(
            f"takes about {wanted:,.0f} photos or samples, of which {MOST:,} can be planned"
        )
    closed = closed_at(scene, robot, sweep.altitude)
    worth = shapely.to_wkb(GeometryCollection(_worth(target, closed)))
    shut = shapely.to_wkb(closed)
    pattern = sweep.pattern
    if pattern.cross_hatch and pattern.angle is None:  # the same for all robots, which do parts of it each
        pattern = replace(pattern, angle=hatch_angle([polygon(shell), *map(polygon, holes)]))
    layers = layers_of(
        pattern,
        sweep.start,
        lambda angle, start: _lines(worth, shut, width, sweep.along, angle, start, pattern.cross_hatch),
    )
    covered = Coverage(
        shell=tuple(shell),
        holes=tuple(tuple(hole) for hole in holes),
        target=tuple(rings(piece) for piece in target),
        width=width,
        length=sweep.along,
    )
    strokes = (
        replace(stroke, part="across" if layer else "")
        for layer, lines in enumerate(layers)
        for line in lines
        for stroke in _strokes(line, sweep)
    )
    extended = turned_around(strokes, sweep.pattern.turnaround, closed)
    return Work(strokes=tuple(extended), divisible=True, rule=sweep.rule, ordered=False, coverage=covered)


def target_of(
    scene: Scene, robot: Robot, shell: Ring, holes: Sequence[Ring], altitude: float
) -> tuple[Polygon, ...]:
    """Return the shell less its holes less what the robot must keep from at a height, largest first.

    What areas close in at all heights is not part of it either.
    """
    taken = [polygon(hole) for hole in holes] + grown_areas(scene, robot, altitude)
    taken += (pocket for pocket, _ in pockets_of(robot, scene))
    whole = polygon(shell)
    left = shapely.difference(whole, shapely.union_all(taken, grid_size=GRID), grid_size=GRID)
    return parts(left, smallest=_SMALLEST)


def grown_areas(scene: Scene, robot: Robot, altitude: float) -> list[Polygon]:
    """Return the areas that a robot keeps from at a height, grown by its clearance."""
    return [
        grow(area.shell, area.safety_distance + robot.clearance)
        for area in scene.kept_from(robot)
        if blocks_at(area, robot.clearance, altitude)
    ]


def blocks_at(area: Area, clearance: float, height: float) -> bool:
    """Return whether an area, grown up and down by its distance and a clearance, reaches a height."""
    c = area.safety_distance + clearance
    return area.low - c < height < area.high + c


def _union(holes: Sequence[Ring]) -> shapely.Geometry:
    return shapely.union_all([polygon(hole) for hole in holes], grid_size=GRID)


def closed_at(scene: Scene, robot: Robot, altitude: float) -> BaseGeometry:
    """Return what a robot keeps from at a height, as one shape."""
    return shapely.union_all(grown_areas(scene, robot, altitude), grid_size=GRID)


def _worth(target: tuple[Polygon, ...], closed: BaseGeometry) -> tuple[Polygon, ...]:
    whole = sum(piece.area for piece in target)
    pockets = [Polygon(hole) for part in parts(closed) for hole in part.interiors]
    walled = [piece for piece in target if any(pocket.covers(piece) for pocket in pockets)]
    if sum(piece.area for piece in walled) > _POCKETS * whole:
        return target
    return tuple(piece for piece in target if piece not in walled)


@lru_cache(maxsize=_REMEMBERED)
def _lines(
    target: bytes,
    closed: bytes,
    width: float,
    length: float,
    angle: float | None,
    start: Point | None,
    strict: bool,
) -> tuple[Swath, ...]:
    """Return the swaths over a target, both geometries as WKB: robots of one clearance share them."""
    pieces = parts(shapely.from_wkb(target))
    shut = shapely.from_wkb(closed)
    return tuple(swaths(pieces, width, length=length, closed=shut, angle=angle, strict=strict, start=start))


def _stroke(line: Swath, sweep: Sweep) -> Stroke:
    at, action = line.spots, sweep.action
    done = (ActionAt(where, action, sweep.device, sweep.parameters) for where in at) if action else ()
    return Stroke(
        points=tuple((float(east), float(north), sweep.altitude) for east, north in line.points),
        actions=tuple(done),
        speed=sweep.speed,
        slow_down=sweep.slow_down,
        cuts=_between(at) if action is not None else _even(line.length, sweep.width),
        reversible=True,
    )


def _strokes(line: Swath, sweep: Sweep) -> Iterator[Stroke]:
    """Yield the stroke along a swath; without stops one along each leg, from its first action to its last."""
    if sweep.passing is None or len(line.spots) < 2:
        yield _stroke(line, sweep)
        return
    for leg in _legs(line):
        stroke = _stroke(leg, sweep)
        photos = sweep.length, sweep.passing, sweep.device, sweep.interval
        yield in_passing(stroke, *photos) if len(leg.spots) > 1 else stroke


def _legs(line: Swath) -> Iterator[Swath]:
    """Yield the part of each leg from its first to its last spot, or the leg with its only spot."""
    for (begin, end), spots in line.by_leg():
        first, last = spots[0], spots[-1]
        ahead = (end - begin) / np.hypot(*(end - begin))
        if last - first > APART:
            yield Swath(
                np.array([begin + first * ahead, begin + last * ahead]), tuple(x - first for x in spots)
            )
        elif first > APART:
            yield Swath(np.array([begin, begin + first * ahead]), (first,))
        else:
            yield Swath(np.array([begin, end]), (0.0,))


def _between(at: Sequence[float]) -> tuple[float, ...]:
    """Return cuts midway between neighbouring actions, evenly thinned."""
    middles = [(one + two) / 2 for one, two in pairwise(at)]
    if len(middles) <= MOST_CUTS:
        return tuple(middles)
    picks = np.unique(np.linspace(0, len(middles) - 1, MOST_CUTS + 2).round().astype(int)[1:-1])
    return tuple(middles[i] for i in picks)


def _even(length: float, width: float) -> tuple[float, ...]:
    """Return cuts at even distances, not nearer to each other than twice the strip's width."""
    count = min(MOST_CUTS, floor(length / (2 * width)))
    return tuple(length * i / (count + 1) for i in range(1, count + 1)) if count else ()
