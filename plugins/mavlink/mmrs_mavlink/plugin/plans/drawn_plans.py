"""Plans of QGroundControl as drawings.

The format is described at https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property, Role
from mmrs_core.drawings.json_text import JsonObject, read_object
from mmrs_core.drawings.sheet import DrawnSubject, FeatureTraits, Sheet, property_of
from mmrs_mavlink.plugin.plans.waypoint_paths import AXES, DrawnItem, WaypointPath

WALKED = ("mission", "items", "geoFence", "polygons", "circles", "rallyPoints", "points")
SETTINGS = {
    "DistanceToSurface": ("altitude", 1.0),
    "ImageDensity": ("groundResolution", 0.01),
    "FrontalOverlap": ("frontOverlap", 0.01),
    "SideOverlap": ("sideOverlap", 0.01),
    "CorridorWidth": ("width", 1.0),
    "TurnAroundDistance": ("turnaroundDistance", 1.0),
    "angle": ("swathAngle", 1.0),
}
"""The attribute that a setting is, and what it is multiplied by."""
AROUND = {
    "DistanceToSurface": ("distance", 1.0),
    "ImageDensity": ("groundResolution", 0.01),
    "FrontalOverlap": ("sideOverlap", 0.01),
    "SideOverlap": ("frontOverlap", 0.01),
    "Layers": ("layers", 1),
}
"""The same for structure scans, whose layers are as far apart as photos are high."""
BOTTOM, LAYER = "ScanBottomAlt", "AdjustedFootprintFrontal"
"""Height of the bottom of a structure, and of a layer."""
FLAGS: Mapping[str, tuple[str, Property]] = {
    "Refly90Degrees": ("crossHatch", True),
    "flyAlternateTransects": ("alternateSwaths", True),
    "HoverAndCapture": ("capture", "AT_STOPS"),
    "StartFromTop": ("startFromTop", True),
}
"""The attribute that a setting is where it is on, and its value."""
ENTRY, ENTRIES = "entryLocation", (315.0, 45.0, 225.0, 135.0)
"""At which corner a survey begins: degrees from north, turned with its transects."""
CORNERS = ("NORTH_EAST", "SOUTH_EAST", "SOUTH_WEST", "NORTH_WEST")
CORRIDOR_ENTRY, AT_LAST_POINT = "EntryPoint", (2, 3)
"""Where a corridor begins, and that this is at its last point."""
ABOVE_SEA = 2
"""``DistanceMode`` of a height above mean sea level; 1 is above home, 3 and 4 are above the ground."""
COMPLEX = {
    "survey": (Geometry.AREA, Role.SURVEY, "polygon"),
    "CorridorScan": (Geometry.LINE, Role.CORRIDOR, "polyline"),
    "StructureScan": (Geometry.AREA, Role.STRUCTURE, "polygon"),
}
SHAPES = ("polygon", "polyline", "TransectStyleComplexItem", "type", "complexItemType", "CameraCalc")
TAKEN = {
    *SETTINGS,
    *AROUND,
    *FLAGS,
    BOTTOM,
    LAYER,
    CORRIDOR_ENTRY,
    ENTRY,
    "DistanceMode",
    "DistanceToSurfaceRelative",
    "version",
}
OURSELVES = "MMRS"
"""The ground station of plans that MMRS writes."""
MAIN = {"fileType", "version", "groundStation", "mission", "geoFence", "rallyPoints"}


def recognise_plan(data: bytes, file: str) -> bool:
    """Return whether it is a plan of QGroundControl."""
    beginning = data[:100_000]
    return beginning.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{" and bool(
        re.search(rb'"fileType"\s*:\s*"Plan"', beginning + data[-10_000:])
    )


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
        above_sea = None
        if isinstance(home, list) and len(home) == 3 and not isinstance(home[2], bool):
            above_sea = float(home[2]) if isinstance(home[2], int | float) else None
            home = home[:2] if home[2] is None else home  # the terrain there was not known yet
        if isinstance(home, list) and None not in home:
            self._add(
                Geometry.POINT, [[home]], "planned home", mission.line, Role.HOME, HeightReference.SEA_LEVEL
            )
        elif home is not None:
            self.sheet.leave_out("planned home", "it is without a position", mission.line)
        path = WaypointPath(self.sheet, role, above_sea)
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
                settings = {k: property_of(v) for k, v in _flat(item) if k not in SHAPES and v is not None}
                properties = {k: v for k, v in settings.items() if k not in TAKEN}
                properties |= _around(settings) if complex_role is Role.STRUCTURE else _attributes(settings)
                ring, what = self._list(item, key), f"{complex_role.value} {number}"
                reference = HeightReference.NONE
                if _above_sea(settings) and "altitude" in properties:
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


def _flat(item: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield the settings of a complex item, with those that are of its transects and its camera."""
    for key, value in item.items():
        if key in ("TransectStyleComplexItem", "CameraCalc") and isinstance(value, dict):
            yield from _flat(value)
        elif not isinstance(value, list | dict):
            yield key, value


def _attributes(settings: Mapping[str, Property]) -> dict[str, Property]:
    """Return settings of a survey or corridor as attributes of tasks, in SI units and fractions."""
    found = _converted(settings, SETTINGS)
    if settings.get(CORRIDOR_ENTRY) in AT_LAST_POINT:
        found["inverted"] = True
    entry, angle = settings.get(ENTRY), found.get("swathAngle", 0.0)
    if isinstance(entry, int) and 0 <= entry < len(ENTRIES) and isinstance(angle, int | float):
        turned = angle - 180.0 * round(angle / 180.0) if abs(angle) > 90.0 else angle
        found["startCorner"] = CORNERS[int((ENTRIES[entry] + turned) % 360.0 // 90.0)]
    return found


def _around(settings: Mapping[str, Property]) -> dict[str, Property]:
    """Return settings of a structure scan as attributes of a task around it."""
    found = _converted(settings, AROUND)
    bottom, layer, layers = (settings.get(key) for key in (BOTTOM, LAYER, "Layers"))
    if isinstance(bottom, int | float):
        rise = float(layer) if isinstance(layer, int | float) else 0.0
        found["altitude"] = lowest = round(bottom + rise / 2.0, 6)
        if isinstance(layers, int) and layers > 1 and rise > 0.0:
            found["topAltitude"] = round(lowest + (layers - 1) * rise, 6)
    return found


def _converted(
    settings: Mapping[str, Property], attributes: Mapping[str, tuple[str, float]]
) -> dict[str, Property]:
    """Return the settings that are attributes, and flags that are set."""
    numbers = {key: value for key in attributes if isinstance(value := settings.get(key), int | float)}
    found: dict[str, Property] = {
        attributes[key][0]: round(value * attributes[key][1], 6) for key, value in numbers.items()
    }
    return found | dict(FLAGS[key] for key in FLAGS if settings.get(key) is True)


def _above_sea(settings: Mapping[str, Property]) -> bool:
    """Return whether heights of a survey or corridor are above mean sea level, in newer or older plans."""
    mode, relative = settings.get("DistanceMode"), settings.get("DistanceToSurfaceRelative")
    return mode == ABOVE_SEA or (mode is None and relative is False)


def _side(fence: Mapping[str, object]) -> Role:
    return Role.INCLUSION if fence.get("inclusion") else Role.FORBIDDEN
