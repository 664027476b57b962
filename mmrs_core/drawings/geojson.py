"""GeoJSON (RFC 7946), and the member ``crs`` of its predecessor, as QGIS, GDAL and others use it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, printable
from mmrs_core.drawings.extras import (
    COLOUR,
    REFERENCE,
    SINCE_START,
    above,
    extras_of,
    lost,
    take_extras,
    time_texts,
    times_of,
)
from mmrs_core.drawings.json_text import JsonObject, read_object
from mmrs_core.drawings.sheet import DrawnSubject, Sheet, property_of

AXES = "GeoJSON has the longitude first"
DEEPEST = 20
"""Geometry collections in geometry collections."""

_TYPES = "FeatureCollection|Feature|GeometryCollection|(?:Multi)?(?:Point|LineString|Polygon)"
_BEGINNING = re.compile(rb'\s*\{.{0,20000}"type"\s*:\s*"(?:' + _TYPES.encode() + rb')"', re.DOTALL)
_CRS = re.compile(r"(?:urn:ogc:def:crs:)?(?P<authority>EPSG|OGC|ESRI):(?:[\d.]*:)?(?P<code>\w{1,20})")
WGS84 = ("OGC:CRS84", "OGC:CRS84h", "EPSG:4326", "EPSG:4979")
PARTS = {
    "Point": (Geometry.POINT, 0),
    "MultiPoint": (Geometry.POINT, 1),
    "LineString": (Geometry.LINE, 0),
    "MultiLineString": (Geometry.LINE, 1),
    "Polygon": (Geometry.AREA, 0),
    "MultiPolygon": (Geometry.AREA, 1),
}
NAMES, DESCRIPTIONS = ("name", "title", "label"), ("description", "desc")
COLOURS = {Geometry.POINT: "marker-color", Geometry.LINE: "stroke", Geometry.AREA: "stroke"}
"""Names of https://github.com/mapbox/simplestyle-spec."""
TIMES = "coordinateProperties"
FEATURE_MEMBERS = {"type", "geometry", "properties", "id", "bbox", "crs"}
Transform = Callable[[NDArray[np.float64], NDArray[np.float64]], Sequence[NDArray[np.float64]]]


def recognise(data: bytes, file: str) -> bool:
    """Return whether it is GeoJSON."""
    return bool(_BEGINNING.match(data.removeprefix(b"\xef\xbb\xbf")[:20100]))


def read(data: bytes, file: str) -> Drawing:
    """Return the features of a GeoJSON file; a bare geometry is one without a name.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    reader = _GeoJsonReader(Sheet(data, file, AXES))
    return reader.read(read_object(data, reader.sheet, ("features", "geometries")))


class _GeoJsonReader:
    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet
        self._transform: Transform | None = None

    def read(self, root: JsonObject) -> Drawing:
        if "crs" in root:
            self._read_crs(root["crs"], root.line)
        if root.get("type") != "FeatureCollection":
            self._feature(root, "")
            return self.sheet.drawing()
        features = root.get("features")
        if not isinstance(features, list):
            self.sheet.refuse("a FeatureCollection without an array 'features'", root.line)
        for number, feature in enumerate(features):
            if not isinstance(feature, JsonObject):
                self.sheet.refuse(f"features[{number}] is not an object", root.line)
            self._feature(feature, f"/features[{number}]")
        for member in sorted(root.keys() - {"type", "features", "crs", "bbox", "name"}):
            self.sheet.leave_out(f"member '{member}'", "not of GeoJSON", root.line)
        title = root.get("name")
        return self.sheet.drawing(title if isinstance(title, str) else "")

    def _feature(self, feature: JsonObject, path: str) -> None:
        place = Place(self.sheet.file, feature.line, path)
        label = path.lstrip("/") or "feature"
        if feature.get("type") != "Feature":
            self._geometry(feature, DrawnSubject(path.lstrip("/") or "geometry", place, {}))
            return
        given, geometry = feature.get("properties"), feature.get("geometry")
        if given is not None and not isinstance(given, dict):
            self.sheet.refuse(f"{label}: 'properties' is not an object", feature.line)
        values = {key: value for key, value in (given or {}).items() if value is not None}
        if (identifier := feature.get("id")) is not None:
            values.setdefault("id", identifier)
        name, description = _taken(values, NAMES), _taken(values, DESCRIPTIONS)
        what = f"feature '{name[:60]}'" if name else label
        for member in sorted(feature.keys() - FEATURE_MEMBERS):
            self.sheet.leave_out(f"member '{member}' of {what}", "not of GeoJSON", feature.line)
        colour = next((values.pop(key) for key in COLOURS.values() if _is_colour(values.get(key))), None)
        times = _times_taken(values)
        properties = {key: property_of(value) for key, value in values.items()}
        traits, reference = take_extras(properties)
        traits |= {"name": name, "description": description, "properties": properties}
        if colour is not None:
            traits["colour"] = str(colour).lower()
        if geometry is None:
            self.sheet.leave_out(what, "no geometry", feature.line)
        elif not isinstance(geometry, dict):
            self.sheet.refuse(f"{what}: 'geometry' is not an object", feature.line)
        else:
            self._geometry(geometry, DrawnSubject(what, place, traits, reference, times))

    def _geometry(self, geometry: Mapping[str, object], subject: DrawnSubject, depth: int = 0) -> None:
        type, what, line = geometry.get("type"), subject.what, subject.place.line
        member = "geometries" if type == "GeometryCollection" else "coordinates"
        parts = geometry.get(member)
        if member == "coordinates" and type not in PARTS:
            kind = "no 'type'" if type is None else f"{str(type)[:40]!r} is not a type of geometry"
            self.sheet.refuse(f"{what}: {kind} of GeoJSON", line)
        if not isinstance(parts, list) or depth > DEEPEST:
            self.sheet.refuse(
                f"{what}: no array '{member}', or collections in more than {DEEPEST} others", line
            )
        if not parts:
            self.sheet.leave_out(what, f"no {member}", line)
        elif member == "geometries":
            for part in parts:
                if not isinstance(part, dict):
                    self.sheet.refuse(f"{what}: a geometry is not an object", line)
                self._geometry(part, subject, depth + 1)
        else:
            shape, many = PARTS[str(type)]
            for part in parts if many else [parts]:
                self._part(shape, part, subject)

    def _part(self, shape: Geometry, part: object, subject: DrawnSubject) -> None:
        rings = {Geometry.POINT: [[part]], Geometry.LINE: [part]}.get(shape, part)
        if not isinstance(rings, list):
            self.sheet.refuse(f"{subject.what}: a polygon is not an array of rings", subject.place.line)
        arrays = [self._degrees(ring, subject) if ring != [] else np.empty((0, 2)) for ring in rings]
        self.sheet.add(shape, arrays, subject, HeightReference.ELLIPSOID)

    def _degrees(self, ring: object, subject: DrawnSubject) -> NDArray[np.float64]:
        """Return latitude and longitude, and height where given."""
        array = self.sheet.positions(ring, subject.what, subject.place.line)
        if self._transform is not None:
            array[:, 0], array[:, 1] = self._transform(array[:, 0], array[:, 1])
        return array[:, [1, 0, 2][: array.shape[1]]]

    def _read_crs(self, crs: object, line: int) -> None:
        """Let positions be transformed from the coordinate reference system that a file names.

        Coordinates are easting and northing, or longitude and latitude, whatever order it defines.
        """
        properties = crs.get("properties") if isinstance(crs, dict) else None
        name = properties.get("name") if isinstance(properties, dict) else None
        found = _CRS.fullmatch(name) if isinstance(name, str) else None
        if crs is not None and found is None:
            called = f"crs '{name[:60]}'" if isinstance(name, str) else "a crs without a name"
            self.sheet.refuse(f"{called}: not understood; save the file in WGS 84", line)
        if found is None or (code := f"{found['authority']}:{found['code']}") in WGS84:
            return
        from pyproj import Transformer
        from pyproj.exceptions import ProjError

        try:
            self._transform = Transformer.from_crs(code, "OGC:CRS84", always_xy=True).transform
        except ProjError:
            self.sheet.refuse(f"crs {code}: not known; save the file in WGS 84", line)


def _taken(values: dict[str, object], names: tuple[str, ...]) -> str:
    """Remove the first of some properties from values, however its key is written, and return it."""
    keys = {key.lower(): key for key in reversed(values)}
    for name in names:
        if name in keys and isinstance(values[keys[name]], str | int | float):
            return str(values.pop(keys[name]))
    return ""


def _is_colour(value: object) -> bool:
    return isinstance(value, str) and bool(re.fullmatch("#[0-9a-fA-F]{6}", value))


def _times_taken(values: dict[str, object]) -> NDArray[np.float64] | None:
    """Remove the times of positions from values, and return them as seconds; None if there are none."""
    many = values.get(TIMES)
    key = "time" if many is None else TIMES
    times = many.get("times") if isinstance(many, dict) and len(many) == 1 else [values.get(key)]
    try:
        counted = values.get(SINCE_START) is True
        found = np.array(times, dtype=np.float64) if counted else times_of(times)
    except (ValueError, TypeError, OverflowError):
        return None
    if found.ndim != 1 or not np.isfinite(found).all():
        return None
    del values[key]
    return found


def write(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as GeoJSON, a feature on each line."""
    features = ",\n".join(_json(_feature_of(feature)) for feature in drawing.features)
    head = f'{{"type":"FeatureCollection","name":{_json(printable(title))},"features":['
    return f"{head}\n{features}\n]}}\n".encode()


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _feature_of(feature: MapFeature) -> dict[str, object]:
    properties: dict[str, object] = {"name": feature.name, "description": feature.description}
    properties = {key: value for key, value in properties.items() if value}
    properties |= {key: property_of(value) for key, value in feature.properties.items()}
    if feature.colour:
        properties[COLOURS[feature.geometry]] = feature.colour
    if feature.times is not None:
        times = feature.times.tolist() if feature.since_start else time_texts(feature.times)
        one = feature.geometry is Geometry.POINT
        properties |= {"time": times[0]} if one else {TIMES: {"times": times}}
    native = (COLOUR, REFERENCE) if feature.reference is HeightReference.ELLIPSOID else (COLOUR,)
    properties |= extras_of(feature, native)
    rings = [_ring_of(feature, number) for number in range(len(feature.rings))]
    type, coordinates = {
        Geometry.POINT: ("Point", rings[0][0]),
        Geometry.LINE: ("LineString", rings[0]),
        Geometry.AREA: ("Polygon", [[*ring, ring[0]] for ring in rings]),
    }[feature.geometry]
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": type, "coordinates": coordinates},
    }


def _ring_of(feature: MapFeature, number: int) -> list[list[float]]:
    """Return a ring with the longitude first: outer rings anticlockwise, holes clockwise.

    Longitudes continue beyond 180 degrees, since most programs would draw a jump back around the Earth.
    """
    ring = feature.rings[number]
    columns = [np.unwrap(ring[:, 1], period=360.0).round(8), ring[:, 0].round(8)]
    if feature.heights:
        columns.append(feature.heights[number].round(3))
    if feature.geometry is Geometry.AREA:
        x, y = columns[:2]
        area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
        if (area < 0.0) == (number == 0):
            columns = [np.roll(column[::-1], 1) for column in columns]
    rows: list[list[float]] = np.column_stack(columns).tolist()
    return rows


def losses(drawing: Drawing) -> tuple[str, ...]:
    """Return what other programs do not read, or read otherwise."""
    references = (HeightReference.GROUND, HeightReference.HOME, HeightReference.SEA_LEVEL)
    taken = {
        f"heights above {each.value}: taken for heights above the ellipsoid": above(each)
        for each in references
    }
    return lost(drawing, {**taken, "circles: drawn as points": lambda each: each.radius is not None})
