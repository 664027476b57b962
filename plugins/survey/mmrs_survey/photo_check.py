"""Whether the photos that a behaviour takes cover the areas of its tasks, with the overlaps that these state.

Places of photos come from the moves alone, and what each shows from the camera's properties: nothing that the
planner laid out is looked at. Along a leg photos face the direction of travel; of one that is taken while the
robot holds, only what it shows whichever way the robot faces counts. Of a cross hatch, only what is shown in
both directions counts: those of legs across each other with which most is.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, dist, hypot, inf, pi

import shapely
from shapely.geometry.base import BaseGeometry

from mmrs_core.analysis.figures import MissingFigureError, half_diagonal_of, kinematics_of, type_of
from mmrs_core.analysis.motion import motions
from mmrs_core.behaviour.program import Action, RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Status, Verdict
from mmrs_core.scene import DISTANCE, AreaUse, Device, Part, Position
from mmrs_core.scene.attributes import flag, holes, number, ring, text
from mmrs_survey.names import PHOTO_GRID_TASK

NAME = "photos"

TOLERATED = 1e-3
"""Share of an area that photos may leave out."""

GRID = 1e-6
"""Metres to which overlays are rounded."""

ALIGNED = 0.02
"""Sine of the angle by which photos may deviate from a direction of a cross hatch."""

QUARTER = 16
"""Corners of a quarter of a circle around an area that robots keep away from."""


ONE_PLACE = 1e-3
"""Metres between two photos under which they are one: the last one, and that after the distance."""

NO_CAMERA = Device("", {}, {})


@dataclass(frozen=True, slots=True)
class _Photo:
    """Attributes: at: where; ahead: direction of travel, 0 where none; width, length: of what it shows."""

    at: Position
    ahead: tuple[float, float]
    width: float
    length: float


@dataclass(frozen=True, slots=True)
class _Camera:
    """Attributes: every: metres after which it is triggered again; since: those after it last was."""

    device: Device = NO_CAMERA
    every: float = inf
    since: float = 0.0

    def asked(self, action: Action, devices: Mapping[str, Device], *, repeats: bool) -> _Camera:
        """Return the camera that takes a photo, and repeats that from there on or ends it."""
        device = devices.get(action.device, NO_CAMERA)
        return _Camera(device, _distance(action)) if repeats else replace(self, device=device)


_OFF = _Camera()


def _run(given: CheckInput) -> Iterator[Verdict]:
    for name, task in given.tasks.items():
        if not task.is_a(PHOTO_GRID_TASK):
            continue
        serving = [robot for robot in given.program.robots if any(move.task == name for move in robot.moves)]
        if not serving:
            continue
        try:
            photos = [photo for robot in serving for photo in _photos(given, robot, name, task)]
            left, whole = _left(given, serving, task, photos)
        except MissingFigureError as missing:
            yield Verdict(NAME, Status.UNKNOWN, message=f"task '{name}': {missing}", place=task.place)
            continue
        bare = left > TOLERATED * whole
        found = f"{left:.1f} of {whole:.1f} m² are not in" if bare else f"{whole:.1f} m² are in"
        asked = "in both directions, " if flag(task, "crossHatch") else ""
        message = f"task '{name}': {found} its {len(photos)} photos {asked}with the overlaps that it states"
        yield Verdict(NAME, Status.VIOLATED if bare else Status.SAFE, message=message, place=task.place)


def _left(
    given: CheckInput, serving: Sequence[RobotProgram], task: Part, photos: Sequence[_Photo]
) -> tuple[float, float]:
    """Return the square metres that no photo shows, and those that were to be photographed."""
    asked = shapely.Polygon(ring(task, "shell"))
    inner = [shapely.Polygon(hole) for hole in holes(task)]
    closed = shapely.union_all([*inner, *_closed(given, serving, task, photos)], grid_size=GRID)
    target = shapely.difference(shapely.make_valid(asked), closed, grid_size=GRID)
    layers = _layers(photos) if flag(task, "crossHatch") else [[photos]]
    return min(_bare(target, each) for each in layers), target.area


def _bare(target: BaseGeometry, layers: Sequence[Sequence[_Photo]]) -> float:
    """Return the square metres that are not in photos of every layer."""
    shown = [shapely.union_all([_shown(photo) for photo in each], grid_size=GRID) for each in layers]
    return float(shapely.difference(target, shapely.intersection_all(shown), grid_size=GRID).area)


def _layers(photos: Sequence[_Photo]) -> Iterator[list[list[_Photo]]]:
    """Yield what may be the layers of a cross hatch: photos along a direction, and those across it."""
    found = {(round(x, 3), round(y, 3)) for x, y in (photo.ahead for photo in photos) if x or y}
    for x, y in sorted({max((x, y), (-x, -y)) for x, y in found} or {(0.0, 0.0)}):
        facing = [photo for photo in photos if any(photo.ahead)]
        along = [photo for photo in facing if abs(x * photo.ahead[1] - y * photo.ahead[0]) <= ALIGNED]
        across = [photo for photo in facing if abs(x * photo.ahead[0] + y * photo.ahead[1]) <= ALIGNED]
        yield [along, across]


def _shown(photo: _Photo) -> BaseGeometry:
    (east, north, _), (x, y) = photo.at, photo.ahead
    if not (x or y):
        return shapely.Point(east, north).buffer(min(photo.width, photo.length) / 2.0)
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    along, across = photo.length / 2.0, photo.width / 2.0
    return shapely.Polygon(
        [(east + a * along * x - b * across * y, north + a * along * y + b * across * x) for a, b in corners]
    )


def _closed(
    given: CheckInput, serving: Sequence[RobotProgram], task: Part, photos: Sequence[_Photo]
) -> Iterator[BaseGeometry]:
    """Yield where no robot may be that does the task, and what that closes in."""
    grown: list[list[BaseGeometry]] = []
    up = number(task, "altitude") or 0.0
    speeds = {move.speed or 0.0 for robot in given.program.robots for move in robot.moves}
    for robot in serving:  # planned to keep room for what tasks command, whoever does these
        kind = type_of(given, robot)
        room = kinematics_of(given, robot).room(*speeds)
        clearance = half_diagonal_of(kind) + given.program.position_error + room
        grown.append(
            [
                shapely.Polygon(area.shell).buffer(keep / cos(pi / (4 * QUARTER)), quad_segs=QUARTER)
                for area in given.areas or ()
                for keep in (area.safety_distance + clearance,)
                if area.use is not AreaUse.EMERGENCY
                and area.concerns(kind.name)
                and area.low - keep < up < area.high + keep
            ]
        )
    shut = shapely.intersection_all([shapely.union_all(each) for each in grown])
    places = shapely.MultiPoint([photo.at[:2] for photo in photos])
    for part in shapely.get_parts(shut):
        yield part
        for pocket in shapely.get_rings(part)[1:]:
            if not shapely.Polygon(pocket).intersects(places):
                yield shapely.Polygon(pocket)


def _photos(given: CheckInput, robot: RobotProgram, name: str, task: Part) -> Iterator[_Photo]:
    """Yield the photos of a task that a robot takes, whatever its Choices decide."""
    single, repeated = text(task, "actionName"), text(task, "triggerAction")
    devices = type_of(given, robot).devices
    sources = defaultdict[int, list[int]](list)
    for source, transition in robot.transitions.items():
        for following in transition.next_moves:
            sources[following].append(source)
    found = dict[int, _Camera]()
    for path in motions(given)[robot.id].paths:
        move, points = robot.moves[path.move], path.points
        before = [found.get(source, _OFF) for source in sources[path.move]]
        camera = before[0] if before and all(each == before[0] for each in before) else _OFF
        for action in move.before if move.task == name else ():
            if action.name in (single, repeated):
                camera = camera.asked(action, devices, repeats=action.name == repeated)
                yield _photo(task, camera.device, points[0], points[:2])
        for one, two in pairwise(points):
            begin, left = one, dist(one, two)
            while camera.since + left >= camera.every + ONE_PLACE:
                share = max(0.0, camera.every - camera.since) / left
                begin = tuple(a + share * (b - a) for a, b in zip(begin, two, strict=True))  # type: ignore[assignment]
                left, camera = left - (camera.every - camera.since), replace(camera, since=0.0)
                yield _photo(task, camera.device, begin, (one, two))
            camera = replace(camera, since=camera.since + left)
        for action in move.after if move.task == name else ():
            if action.name in (single, repeated):
                camera = camera.asked(action, devices, repeats=action.name == repeated)
                yield _photo(task, camera.device, points[-1], points[-2:])
        found[path.move] = camera


def _distance(action: Action) -> float:
    """Return after how many metres a camera is triggered again; inf: not."""
    return _figure(dict(action.parameters), DISTANCE) or inf


def _photo(task: Part, camera: Device, at: Position, leg: Sequence[Position]) -> _Photo:
    (east, north, _), (x, y, _) = leg[0], leg[-1]
    far = hypot(x - east, y - north)
    ahead = ((x - east) / far, (y - north) / far) if far > 0.0 else (0.0, 0.0)
    grid = number(task, "gridResolution")
    if grid is not None:
        return _Photo(at, ahead, grid, grid)
    side, front = (1.0 - (number(task, name) or 0.0) for name in ("sideOverlap", "frontOverlap"))
    width, length = _seen(task, camera, at[2])
    return _Photo(at, ahead, width * side, length * front)


def _seen(task: Part, camera: Device, up: float) -> tuple[float, float]:
    """Return the width and length of the ground that a photo shows from a height, metres."""
    width, length = number(task, "footprintWidth"), number(task, "footprintLength")
    if width is not None and length is not None:
        return width, length
    stated = camera.properties
    across, along, focal = (_figure(stated, key) for key in ("sensor.width", "sensor.height", "focal.length"))
    if across and along and focal and up > 0.0:
        return across * up / focal, along * up / focal
    pixel = number(task, "groundResolution")
    columns, rows = _figure(stated, "image.width"), _figure(stated, "image.height")
    if pixel is None or columns is None or rows is None:
        raise MissingFigureError(f"device '{camera.id}' does not state what a photo shows")
    return pixel * columns, pixel * rows


def _figure(stated: Mapping[str, str], key: str) -> float | None:
    try:
        found = float(stated.get(key, ""))
    except ValueError:
        return None
    return found if 0.0 < found < inf else None


PHOTOS_CHECK = Check(
    NAME,
    "Photos cover the areas of their tasks, with the overlaps that these state.",
    _run,
    hint="plan the mission again, or lay the photos nearer to each other",
)
