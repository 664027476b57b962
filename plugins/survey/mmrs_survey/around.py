"""Rules for photos from the side: along the border of an area, layer by layer, and round a point."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import atan2, ceil, cos, dist, hypot, pi, sin

import shapely
from shapely.geometry.polygon import orient

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.polygons import parts, polygon
from mmrs_core.geometry.stretches import LEAST
from mmrs_core.planning.devices import carried
from mmrs_core.planning.open_lines import work_along
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Gap, Look, Part, Point, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import flag, number, position, ring, text
from mmrs_survey.lines import off_leg, without_dense
from mmrs_survey.names import ORBIT_TASK, PERIMETER_TASK
from mmrs_survey.spacing import photographed, shots_of

UNEVEN = 0.3
"""Metres by which a side may be off the straight line between its ends, however short it is."""

BENT = 0.044
"""Share of that line by which it may be so: bent by 20 degrees, so that a camera is 10 off at its ends."""

SMOOTH = pi / 8
"""Turns between sides, radians, up to which one photo serves both where they meet."""

CORNERS = 36
"""Corners of an orbit: its path is nearer to the point by 0.4 % of the radius at most."""

MITRE = 2.0
"""Distances from the border by which a path around a sharp corner may stick out."""

FACED = 1.5
"""Distances of a path from the border within which it faces the border."""

FAR = 30.0
"""Lengths of a side at which a camera aims beyond it, so that it keeps its direction within a degree."""


def perimeter_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return a stroke along the border for each layer; with the camera aside, one along each side of it.

    Where no path at its distance faces the border, as in a narrow courtyard, that is a gap.
    """
    part, aside = task.part, flag(task.part, "faceBorder")
    altitude, distance = number(part, "altitude"), number(part, "distance") or 0.0
    if altitude is None:
        raise InfeasibleError("altitude is missing")
    initial = position(part, "initialPosition")
    entry = (initial[0], initial[1], altitude)
    shots = shots_of(part, robot, abs(distance) if aside else altitude, sideways=aside)
    heights = _layers(part, altitude, shots.strip)
    refuse_heights(robot, [entry, *((*entry[:2], up) for up in heights)])
    refuse_blocked(robot, scene, (entry,), "the initial position")
    paths = _paths_along(part, distance, entry[:2])
    parted = [list(_sides(path)) if aside else [path] for path in paths]
    sides = [side for each in parted for side in each]
    kind = "side" if aside else "path" if len(paths) > 1 else ""
    lines = [
        (
            " of ".join(
                filter(None, (kind and f"{kind} {number}", f"layer {layer}" if len(heights) > 1 else ""))
            )
            or "the path",
            tuple((east, north, up) for east, north in side),
        )
        for layer, up in enumerate(heights, 1)
        for number, side in enumerate(sides, 1)
    ]
    device = shots.camera.id if shots.camera else carried(robot.type, text(part, "deviceId"))
    right = 1.0 if flag(part, "clockwise") == (distance >= 0.0) else -1.0

    followed = {(*two[0], *two[1]) for each in parted for one, two in pairwise(each) if _is_smooth(one, two)}

    def stroke(_: str, line: tuple[Position, ...]) -> Stroke:
        made = photographed(part, line, shots, begun=(*line[0][:2], *line[1][:2]) in followed)
        return replace(made, look=Look(_beside(line, right * FAR), device)) if aside else made

    work = work_along(scene, robot, lines, stroke, rule="perimeter")
    gaps = *work.gaps, *_unfaced(part, distance, paths, altitude)
    return replace(work, entry=entry, notes=shots.capture.notes, gaps=gaps)


def _layers(part: Part, lowest: float, strip: float | None) -> list[float]:
    """Return the heights of layers, in the order in which they are flown."""
    highest, wanted = number(part, "topAltitude"), number(part, "layers")
    rise = 0.0 if highest is None else max(0.0, highest - lowest)
    count = int(wanted) if wanted is not None else 1 + ceil(rise / (strip or rise or 1.0) - 1e-9)
    step = rise / max(1, count - 1)
    heights = [lowest + index * step for index in range(count)]
    return heights[::-1] if flag(part, "startFromTop") else heights


def _paths_along(part: Part, distance: float, start: Point) -> list[list[Point]]:
    """Return the closed paths at a distance outside of a border, each from its corner nearest to the last.

    There are several around a courtyard with a narrow mouth, or inside of rooms that a narrow neck joins. On
    all of them, the border is on the same side. Others than the first of up to a metre are left out, and so
    are corners that are dense, as on a border drawn freehand.
    """
    grown = shapely.buffer(polygon(ring(part, "shell")), distance, join_style="mitre", mitre_limit=MITRE)
    found = [orient(each, -1.0 if flag(part, "clockwise") else 1.0) for each in parts(grown)]
    rings = [each for shape in found for each in (shape.exterior, *shape.interiors)]
    left = [each.coords[:-1] for each in rings if each is rings[0] or each.length > LEAST]
    if not left:
        raise InfeasibleError(f"nothing of the area is {-distance:g} m from its border")
    paths = list[list[Point]]()
    while left:
        _, path, first = min(
            (dist(corner, start), path, first)
            for path, corners in enumerate(left)
            for first, corner in enumerate(corners)
        )
        corners = left.pop(path)
        start = corners[first]
        paths.append(without_dense([*corners[first:], *corners[: first + 1]]))
    return paths


def _unfaced(part: Part, distance: float, paths: Sequence[Sequence[Point]], up: float) -> Iterator[Gap]:
    """Yield where a border is farther from all paths along it than where two sides meet at a right angle."""
    shell = polygon(ring(part, "shell"))
    border = shapely.LinearRing(shell.exterior.coords)
    seen = shapely.buffer(
        [shapely.LineString([*path, path[0]]) for path in paths], FACED * abs(distance) + UNEVEN
    )
    left = shapely.difference(shapely.LineString(border.coords), shapely.union_all(seen))
    for each in shapely.get_parts(shapely.line_merge(left)):
        if each.length > LEAST:
            begin = shapely.line_locate_point(border, shapely.Point(each.coords[0]))
            east, north = shapely.line_interpolate_point(each, 0.5, normalized=True).coords[0]
            yield Gap("the border", float(begin), each.length, (east, north, up), "other sides of it")


def _sides(path: Sequence[Point]) -> Iterator[list[Point]]:
    """Yield the parts of a path along which a camera may look in one direction, each from where one ends."""
    first = 0
    for last in range(2, len(path)):
        chord = path[first], path[last]
        if off_leg(chord, path[first + 1 : last]) > max(UNEVEN, BENT * dist(*chord)):
            yield list(path[first:last])
            first = last - 1
    yield list(path[first:])


def _is_smooth(one: Sequence[Point], two: Sequence[Point]) -> bool:
    """Return whether photos where one side ends and the other begins would show nearly the same."""
    (x, y), (east, north) = ((side[-1][0] - side[0][0], side[-1][1] - side[0][1]) for side in (one, two))
    return abs(atan2(x * north - y * east, x * east + y * north)) <= SMOOTH


def _beside(line: tuple[Position, ...], far: float) -> Position:
    """Return a point right of the middle of a line, so many of its lengths away; left: negative."""
    (x, y, up), (east, north, _) = line[0], line[-1]
    return ((x + east) / 2 + far * (north - y), (y + north) / 2 - far * (east - x), up)


def orbit_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return circles around the point, which the camera looks at."""
    part, centre = task.part, position(task.part, "point")
    up, radius = number(part, "altitude"), number(part, "radius") or 0.0
    up = centre[2] if up is None else up
    if not radius > 0.0:
        raise InfeasibleError("a radius above zero is missing")
    shots = shots_of(part, robot, hypot(radius, up - centre[2]), sideways=True)
    home = scene.robots[0].home if scene.robots else robot.home
    line = tuple(_circle(part, centre, radius, up, home))
    refuse_heights(robot, line[:1])
    device = shots.camera.id if shots.camera else carried(robot.type, text(part, "deviceId"))

    def stroke(_: str, line: tuple[Position, ...]) -> Stroke:
        return replace(photographed(part, line, shots), look=Look(centre, device))

    work = work_along(scene, robot, [("the orbit", line)], stroke, rule="orbit")
    return replace(work, notes=shots.capture.notes)


def _circle(part: Part, centre: Position, radius: float, up: float, home: Position) -> Iterator[Position]:
    """Yield the corners of orbits, beginning on the side of the team's home."""
    away = complex(home[0] - centre[0], home[1] - centre[1]) or 1j
    begin, turn = away / abs(away), -1.0 if flag(part, "clockwise") else 1.0
    for index in range(int(number(part, "turns") or 1) * CORNERS + 1):
        angle = turn * index * 2.0 * pi / CORNERS
        place = radius * begin * complex(cos(angle), sin(angle))
        yield (centre[0] + place.real, centre[1] + place.imag, up)


PERIMETER_RULE = Rule("perimeter", PERIMETER_TASK, perimeter_work)
ORBIT_RULE = Rule("orbit", ORBIT_TASK, orbit_work)
