"""Missions of ground stations as drawings: plans of QGroundControl, and lists of waypoints.

The formats are described at https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html
and https://mavlink.io/en/file_formats/.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property, Role
from mmrs_core.drawings.json_text import JsonObject, read_object
from mmrs_core.drawings.sheet import DrawnSubject, FeatureTraits, Sheet, property_of
from mmrs_mavlink.plugin.plans.items import (
    ABSOLUTE,
    FENCE_EXCLUSION,
    LAND,
    LOITER_TIME,
    LOITER_UNLIMITED,
    RALLY_POINT,
    RELATIVE,
    TAKE_OFF,
    WAYPOINT,
)

AXES = "missions have the latitude first"
SPLINE, LOITER_TURNS, LOITER_TO_ALTITUDE, ARC, PLACE_PAYLOAD = 82, 18, 31, 36, 94
PASSED = frozenset(
    (
        *(WAYPOINT, SPLINE, ARC, LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, LOITER_TO_ALTITUDE),
        PLACE_PAYLOAD,
    )
)
"""Commands whose place a vehicle goes to; one at latitude and longitude 0 is where it is."""
WAITED = (LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, PLACE_PAYLOAD)
LAUNCHED = frozenset((TAKE_OFF, LAND, 84, 85, 20))
"""Commands to take off, to land, and to return; the first two as multicopters and as VTOL do it."""
FENCE_INCLUSION, CIRCLE_INCLUSION, CIRCLE_EXCLUSION = 5001, 5003, 5004
FRAMES = {
    **dict.fromkeys((ABSOLUTE, 5), HeightReference.SEA_LEVEL),
    **dict.fromkeys((RELATIVE, 6), HeightReference.HOME),
    **dict.fromkeys((10, 11), HeightReference.GROUND),
}
WALKED = ("mission", "items", "geoFence", "polygons", "circles", "rallyPoints", "points")
SETTINGS = {
    "DistanceToSurface": ("altitude", 1.0),
    "ImageDensity": ("groundResolution", 0.01),
    "FrontalOverlap": ("frontOverlap", 0.01),
    "SideOverlap": ("sideOverlap", 0.01),
    "CorridorWidth": ("width", 1.0),
}
"""The attribute that a setting is, and what it is multiplied by."""
ABOVE_SEA = 2
"""``DistanceMode`` of a height above mean sea level; 1 is above home, 3 and 4 are above the ground."""
COMPLEX = {
    "survey": (Geometry.AREA, Role.SURVEY, "polygon"),
    "CorridorScan": (Geometry.LINE, Role.CORRIDOR, "polyline"),
    "StructureScan": (Geometry.AREA, Role.STRUCTURE, "polygon"),
}
SHAPES = ("polygon", "polyline", "TransectStyleComplexItem", "type", "complexItemType", "CameraCalc")
FIELDS = 12
CIRCLES = (CIRCLE_INCLUSION, CIRCLE_EXCLUSION)
AROUND = {
    FENCE_INCLUSION: (Geometry.AREA, Role.INCLUSION),
    FENCE_EXCLUSION: (Geometry.AREA, Role.FORBIDDEN),
    CIRCLE_INCLUSION: (Geometry.POINT, Role.INCLUSION),
    CIRCLE_EXCLUSION: (Geometry.POINT, Role.FORBIDDEN),
    RALLY_POINT: (Geometry.POINT, Role.RALLY_POINT),
}
HEADER = "QGC WPL 110"
OURSELVES = "MMRS"
"""The ground station of plans that MMRS writes."""
MAIN = {"fileType", "version", "groundStation", "mission", "geoFence", "rallyPoints"}


def recognise_plan(data: bytes, file: str) -> bool:
    """Return whether it is a plan of QGroundControl."""
    beginning = data[:100_000]
    return beginning.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{" and bool(
        re.search(rb'"fileType"\s*:\s*"Plan"', beginning + data[-10_000:])
    )


def recognise_list(data: bytes, file: str) -> bool:
    """Return whether it is a list of waypoints."""
    return data.removeprefix(b"\xef\xbb\xbf").startswith(b"QGC WPL")


def read_plan(data: bytes, file: str) -> Drawing:
    """Return areas and corridors to survey, waypoints as a path, the geofence, rally points and home.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    reader = _PlanReader(Sheet(data, file, AXES))
    return reader.read(read_object(data, reader.sheet, WALKED))


class _PlanReader:
    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet

    def read(self, plan: JsonObject) -> Drawing:
        if plan.get("fileType") != "Plan":
            self.sheet.refuse("no plan of QGroundControl: its 'fileType' is not 'Plan'", plan.line)
        if plan.get("version") != 1:
            self.sheet.refuse(
                f"plans of version {str(plan.get('version'))[:20]} are not read, but of 1", plan.line
            )
        own = plan.get("groundStation") == OURSELVES
        self._mission(self._part(plan, "mission"), Role.PATH if own else Role.WAYPOINT)
        self._fence(self._part(plan, "geoFence"))
        rally = self._part(plan, "rallyPoints")
        for number, point in enumerate(self._list(rally, "points"), start=1):
            what = f"rally point {number}"
            self._add(Geometry.POINT, [[point]], what, rally.line, Role.RALLY_POINT, HeightReference.HOME)
        for member in sorted(plan.keys() - MAIN):
            self.sheet.leave_out(f"member '{member}'", "not of a plan", plan.line)
        return self.sheet.drawing()

    def _part(self, plan: JsonObject, key: str) -> JsonObject:
        found = plan.get(key, JsonObject())
        return (
            found
            if isinstance(found, JsonObject)
            else self.sheet.refuse(f"'{key}' is not an object", plan.line)
        )

    def _list(self, owner: JsonObject, key: str) -> list[object]:
        found = owner.get(key, [])
        return found if isinstance(found, list) else self.sheet.refuse(f"'{key}' is not an array", owner.line)

    def _add(
        self,
        geometry: Geometry,
        rings: Sequence[object],
        what: str,
        line: int,
        role: Role,
        reference: HeightReference = HeightReference.NONE,
        **more: object,
    ) -> None:
        arrays = [self.sheet.positions(ring, what, line) for ring in rings]
        traits: FeatureTraits = {"name": what, "role": role}
        traits |= more  # type: ignore[typeddict-item]
        self.sheet.add(geometry, arrays, DrawnSubject(what, Place(self.sheet.file, line), traits), reference)

    def _mission(self, mission: JsonObject, role: Role) -> None:
        home = mission.get("plannedHomePosition")
        if isinstance(home, list) and None not in home:
            self._add(
                Geometry.POINT, [[home]], "planned home", mission.line, Role.HOME, HeightReference.SEA_LEVEL
            )
        elif home is not None:
            self.sheet.leave_out("planned home", "it is without a position", mission.line)
        path = WaypointPath(self.sheet, role)
        for number, item in enumerate(self._list(mission, "items"), start=1):
            if not isinstance(item, JsonObject):
                self.sheet.refuse(f"item {number} is not an object", mission.line)
            kind = str(item.get("complexItemType") or "")
            if item.get("type") == "SimpleItem":
                path.add(self._simple(item, number))
                continue
            path.end()
            if kind in COMPLEX:
                geometry, complex_role, key = COMPLEX[kind]
                properties = {k: property_of(v) for k, v in _flat(item) if k not in SHAPES and v is not None}
                properties |= _attributes(properties)
                ring, what = self._list(item, key), f"{complex_role.value} {number}"
                reference = HeightReference.NONE
                if _above_sea(properties) and "altitude" in properties:
                    reference, height = HeightReference.SEA_LEVEL, properties.pop("altitude")
                    ring = [[*each[:2], height] if isinstance(each, list) else each for each in ring]
                self._add(geometry, [ring], what, item.line, complex_role, reference, properties=properties)
            else:
                reason = f"'{str(kind or item.get('type'))[:40]}' is not a kind of item that is read"
                self.sheet.leave_out(f"item {number}", reason, item.line)
        path.end()

    def _simple(self, item: JsonObject, number: int) -> DrawnItem:
        params, command, frame = item.get("params"), item.get("command"), item.get("frame")
        if not isinstance(params, list) or len(params) != 7 or not isinstance(command, int):
            self.sheet.refuse(f"item {number}: a command and seven parameters are expected", item.line)
        place = [0.0 if each is None else each for each in params[4:]]
        if any(isinstance(each, bool) or not isinstance(each, int | float) for each in place):
            self.sheet.refuse(f"item {number}: a parameter is not a number", item.line)
        first = params[0] if isinstance(params[0], int | float) else 0.0
        return DrawnItem(command, frame if isinstance(frame, int) else -1, place, number, item.line, first)

    def _fence(self, fence: JsonObject) -> None:
        for number, polygon in enumerate(self._list(fence, "polygons"), start=1):
            if not isinstance(polygon, JsonObject):
                self.sheet.refuse(f"fence {number} is not an object", fence.line)
            ring = self._list(polygon, "polygon")
            self._add(Geometry.AREA, [ring], f"fence {number}", polygon.line, _side(polygon))
        for number, each in enumerate(self._list(fence, "circles"), start=1):
            circle = each.get("circle") if isinstance(each, JsonObject) else None
            if not isinstance(each, JsonObject) or not isinstance(circle, dict):
                self.sheet.refuse(f"fence circle {number} is not an object with a 'circle'", fence.line)
            radius = circle.get("radius")
            if isinstance(radius, bool) or not isinstance(radius, int | float) or not 0 < radius < 1e6:
                self.sheet.refuse(f"fence circle {number}: its radius is not a length", each.line)
            what = f"fence circle {number}"
            self._add(
                Geometry.POINT, [[circle.get("center")]], what, each.line, _side(each), radius=float(radius)
            )
        if fence.get("breachReturn") is not None:
            self.sheet.leave_out("breach return point", "not of a mission here", fence.line)


class DrawnItem(NamedTuple):
    """An item of a mission: `place` is latitude, longitude and height, `first` its first parameter."""

    command: int
    frame: int
    place: list[float]
    number: int
    line: int
    first: float = 0.0


def _flat(item: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield the settings of a complex item, with those that are of its transects and its camera."""
    for key, value in item.items():
        if key in ("TransectStyleComplexItem", "CameraCalc") and isinstance(value, dict):
            yield from _flat(value)
        elif not isinstance(value, list | dict):
            yield key, value


def _attributes(settings: Mapping[str, Property]) -> dict[str, Property]:
    """Return settings of a survey or corridor as attributes of tasks, in SI units and fractions."""
    numbers = {key: value for key in SETTINGS if isinstance(value := settings.get(key), int | float)}
    return {SETTINGS[key][0]: round(value * SETTINGS[key][1], 6) for key, value in numbers.items()}


def _above_sea(settings: Mapping[str, Property]) -> bool:
    """Return whether heights of a survey or corridor are above mean sea level, in newer or older plans."""
    mode, relative = settings.get("DistanceMode"), settings.get("DistanceToSurfaceRelative")
    return mode == ABOVE_SEA or (mode is None and relative is False)


def _side(fence: Mapping[str, object]) -> Role:
    return Role.INCLUSION if fence.get("inclusion") else Role.FORBIDDEN


class WaypointPath:
    """Adds the places that a vehicle goes to one after the other; another height reference begins a path.

    Args:
        role: of the paths: those that MMRS planned, or waypoints that people drew.
    """

    def __init__(self, sheet: Sheet, role: Role) -> None:
        self._sheet, self._role = sheet, role
        self._part: list[DrawnItem] = []

    def add(self, row: DrawnItem) -> None:
        """Continue the path, or note why an item does not belong to one."""
        if row.command in LAUNCHED:
            reason = "robots take off, return and land without a task"
            self._sheet.leave_out(f"item {row.number}", reason, row.line)
        elif row.command not in PASSED or row.place[:2] == [0.0, 0.0]:
            what = "states no position" if row.command in PASSED else "does not move a vehicle to a place"
            self._sheet.leave_out(f"item {row.number}", f"{_command(row.command)} {what}", row.line)
        else:
            if self._part and FRAMES.get(self._part[-1].frame) is not FRAMES.get(row.frame):
                self.end()
            self._part.append(row)
            if row.command in WAITED or (row.command in (WAYPOINT, SPLINE) and row.first > 0.0):
                reason = "what a robot does there is a task of its own"
                self._sheet.leave_out(f"waiting at item {row.number}", reason, row.line)

    def end(self) -> None:
        """Add the path so far; one in the same place throughout is a point."""
        part, self._part = self._part, []
        if not part:
            return
        first = part[0]
        reference = FRAMES.get(first.frame, HeightReference.NONE)
        many = len({tuple(row.place[:2]) for row in part}) > 1
        what = f"waypoints {first.number} to {part[-1].number}" if many else f"waypoint {first.number}"
        if reference is HeightReference.NONE:
            self._sheet.leave_out(f"heights of {what}", f"frame {first.frame} is not read", first.line)
        shape = Geometry.LINE if many else Geometry.POINT
        _add(self._sheet, shape, part if many else part[:1], what, self._role, reference)
        if not many and len(part) > 1:
            where = f"items {part[1].number} to {part[-1].number}"
            self._sheet.leave_out(where, f"at the same position as {what}", part[1].line)


def _command(number: int) -> str:
    from mmrs_mavlink.services.commands import name_of

    name = name_of(number)
    return name if str(number) in name else f"command {number} ({name})"


def _add(
    sheet: Sheet,
    shape: Geometry,
    rows: Sequence[DrawnItem],
    what: str,
    role: Role,
    reference: HeightReference = HeightReference.NONE,
    radius: float | None = None,
) -> None:
    traits: FeatureTraits = {"name": what, "role": role, "radius": radius}
    subject = DrawnSubject(what, Place(sheet.file, rows[0].line), traits)
    ring = np.array([row.place for row in rows], dtype=np.float64)
    sheet.add(shape, [ring if reference is not HeightReference.NONE else ring[:, :2]], subject, reference)


def read_list(data: bytes, file: str) -> Drawing:
    """Return home (row 0, as ArduPilot has it), waypoints as a path, and fences and rally points.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    sheet = Sheet(data, file, AXES)
    lines = data.decode("utf-8-sig", "replace").splitlines()
    if lines[0].strip() != HEADER:
        sheet.refuse(f"the first line is not '{HEADER}'", 1)
    rows = [_row_of(line, number, sheet) for number, line in enumerate(lines[1:], start=2) if _holds(line)]
    if rows and rows[0].number == 0 and rows[0].command == WAYPOINT:
        home = rows.pop(0)
        _refuse_swapped(home, rows, sheet)
        _add(sheet, Geometry.POINT, [home], "home", Role.HOME, HeightReference.SEA_LEVEL)
    path = WaypointPath(sheet, Role.WAYPOINT)
    for row in rows:
        if row.command not in AROUND:
            path.add(row)
    path.end()
    around = [row for row in rows if row.command in AROUND]
    while around:
        row = around[0]
        shape, role = AROUND[row.command]
        what = f"{role.value} {row.number}"
        count = int(row.first) if shape is Geometry.AREA and 0 < row.first < 1e6 else 1
        corners, around = around[:count], around[count:]
        if len(corners) < count or any(
            (each.command, each.first) != (row.command, row.first) for each in corners
        ):
            sheet.refuse(f"{what}: {count} corners of it are expected one after the other", row.line)
        radius = row.first if row.command in CIRCLES and 0.0 < row.first < 1e6 else None
        rally = (
            FRAMES.get(row.frame, HeightReference.NONE) if role is Role.RALLY_POINT else HeightReference.NONE
        )
        _add(sheet, shape, corners, what, role, rally, radius)
    return sheet.drawing()


def _refuse_swapped(home: DrawnItem, rows: Sequence[DrawnItem], sheet: Sheet) -> None:
    """Refuse waypoints that are near home if latitude and longitude are exchanged."""
    at = np.array(home.place[:2])
    for row in rows:
        place = np.array(row.place[:2])
        if place.any() and np.abs(place - at).max() > 1.0 and np.abs(place[::-1] - at).max() < 0.1:
            sheet.refuse(
                f"item {row.number}: latitude and longitude seem to be swapped against home", row.line
            )


def _row_of(text: str, line: int, sheet: Sheet) -> DrawnItem:
    cells = text.split()
    if len(cells) != FIELDS:
        sheet.refuse(f"{len(cells)} values instead of {FIELDS}", line)
    try:
        number, _, frame, command = (int(float(cell)) for cell in cells[:4])
        first, _, _, _, *place = (float(cell) for cell in cells[4:11])
    except (ValueError, OverflowError) as fault:
        sheet.refuse(f"not a row of numbers: {str(fault)[:60]}", line)
    return DrawnItem(command, frame, place, number, line, first)


def _holds(line: str) -> bool:
    return bool(line.strip()) and not line.startswith("#")
