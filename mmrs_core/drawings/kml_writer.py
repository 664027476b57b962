"""KML 2.2 and KMZ (OGC 07-147r2), as Google Earth, QGIS and others read them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from html import escape
from itertools import takewhile

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role, printable
from mmrs_core.drawings.extras import (
    COLOUR,
    DEGREES,
    FOLDERS,
    METRES,
    REFERENCE,
    above,
    decimal_texts,
    extras_of,
    lost,
    property_text,
    time_texts,
)
from mmrs_core.drawings.xml_text import XML, tagged

_ROOT = """<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">"""
MODE_OF = {
    HeightReference.GROUND: "relativeToGround",
    HeightReference.HOME: "relativeToGround",
    HeightReference.SEA_LEVEL: "absolute",
}
"""Heights above the ellipsoid are written, but not used where a shape lies on the ground."""


def write(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as KML: a placemark for each feature, in folders; lines with times are tracks."""
    lines = [XML, _ROOT, "<Document>", tagged("name", printable(title))]
    opened: tuple[str, ...] = ()
    for feature in drawing.features:
        pairs = zip(opened, feature.folders, strict=False)
        same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
        lines += ["</Folder>"] * (len(opened) - same)
        lines += [f"<Folder>{tagged('name', name)}" for name in feature.folders[same:]]
        opened = feature.folders
        lines += _placemark(feature)
    return "\n".join([*lines, *["</Folder>"] * len(opened), "</Document>", "</kml>\n"]).encode()


def _placemark(feature: MapFeature) -> Iterator[str]:
    yield "<Placemark>"
    if feature.name:
        yield tagged("name", feature.name)
    if feature.description:
        yield tagged("description", feature.description)
    if feature.times is not None and feature.geometry is Geometry.POINT:
        yield f"<TimeStamp>{tagged('when', time_texts(feature.times)[0])}</TimeStamp>"
    if feature.colour:
        red, green, blue = (feature.colour[at : at + 2] for at in (1, 3, 5))
        kinds = {Geometry.POINT: ("IconStyle",), Geometry.LINE: ("LineStyle",)}
        yield "<Style>"
        for kind in kinds.get(feature.geometry, ("LineStyle", "PolyStyle")):
            opacity = "60" if kind == "PolyStyle" else "ff"
            yield f"<{kind}>{tagged('color', opacity + blue + green + red)}</{kind}>"
        yield "</Style>"
    native = {FOLDERS, COLOUR}
    if feature.reference in (HeightReference.GROUND, HeightReference.SEA_LEVEL):
        native.add(REFERENCE)
    data = {**feature.properties, **extras_of(feature, native)}
    if data:
        yield "<ExtendedData>"
        for key, value in data.items():
            yield f'<Data name="{escape(key)}">{tagged("value", property_text(value))}</Data>'
        yield "</ExtendedData>"
    yield from _shape(feature)
    yield "</Placemark>"


def _shape(feature: MapFeature) -> Iterator[str]:
    mode = tagged("altitudeMode", MODE_OF.get(feature.reference, "clampToGround"))
    if feature.geometry is Geometry.LINE and feature.times is not None:
        yield f"<gx:Track>{mode}"
        yield from (f"<when>{time}</when>" for time in time_texts(feature.times))
        yield from (f"<gx:coord>{each}</gx:coord>" for each in _tuples(feature, 0, " "))
        yield "</gx:Track>"
        return
    tag = {Geometry.POINT: "Point", Geometry.LINE: "LineString", Geometry.AREA: "Polygon"}[feature.geometry]
    yield f"<{tag}>"
    if feature.role is Role.OBSTACLE and feature.heights:
        yield "<extrude>1</extrude>"
    if tag != "Point" and "clampToGround" in mode:
        yield "<tessellate>1</tessellate>"
    yield mode
    for number in range(len(feature.rings)):
        tuples = _tuples(feature, number, ",")
        if tag == "Polygon":
            side, tuples = "innerBoundaryIs" if number else "outerBoundaryIs", [*tuples, tuples[0]]
            yield f"<{side}><LinearRing>{tagged('coordinates', ' '.join(tuples))}</LinearRing></{side}>"
        else:
            yield tagged("coordinates", " ".join(tuples))
    yield f"</{tag}>"


def _tuples(feature: MapFeature, number: int, comma: str) -> list[str]:
    """Return the positions of a ring, longitude first."""
    columns = [decimal_texts(column, DEGREES) for column in feature.rings[number].T[::-1]]
    if feature.heights:
        columns.append(decimal_texts(feature.heights[number], METRES))
    return [comma.join(each) for each in zip(*columns, strict=True)]


def write_archive(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as KMZ."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("doc.kml"), write(drawing, title), zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def losses(drawing: Drawing) -> tuple[str, ...]:
    """Return what other programs do not read, or read otherwise."""
    return lost(
        drawing,
        {
            "heights above the home position: drawn above the ground": above(HeightReference.HOME),
            "heights above the ellipsoid: drawn on the ground": above(HeightReference.ELLIPSOID),
            "times since the start: written as times on 1970-01-01": lambda each: (
                each.since_start and each.times is not None
            ),
            "times of the corners of areas: not written": lambda each: (
                each.geometry is Geometry.AREA and each.times is not None
            ),
            "circles: drawn as points": lambda each: each.radius is not None,
        },
    )
