"""KML 2.2 and KMZ (OGC 07-147r2), as Google Earth, QGIS and others read them."""

from __future__ import annotations

import io
import zipfile
from itertools import takewhile

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role, printable
from mmrs_core.drawings.extras import (
    COLOUR,
    FOLDERS,
    REFERENCE,
    above,
    degrees_text,
    extras_of,
    lost,
    metres_text,
    time_text,
)

KML, GX = "http://www.opengis.net/kml/2.2", "http://www.google.com/kml/ext/2.2"
NAMESPACES: dict[str, str] = {None: KML, "gx": GX}  # type: ignore[dict-item]  # lxml's default namespace
MODE_OF = {
    HeightReference.GROUND: "relativeToGround",
    HeightReference.HOME: "relativeToGround",
    HeightReference.SEA_LEVEL: "absolute",
}
"""Heights above the ellipsoid are written, but not used where a shape lies on the ground."""


def write(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as KML: a placemark for each feature, in folders; lines with times are tracks."""
    root = etree.Element(f"{{{KML}}}kml", nsmap=NAMESPACES)
    document = _added(root, "Document")
    _added(document, "name", printable(title))
    opened: list[tuple[str, etree._Element]] = [("", document)]
    for feature in drawing.features:
        pairs = zip(opened[1:], feature.folders, strict=False)
        same = sum(1 for _ in takewhile(lambda pair: pair[0][0] == pair[1], pairs))
        del opened[1 + same :]
        for name in feature.folders[len(opened) - 1 :]:
            folder = _added(opened[-1][1], "Folder")
            _added(folder, "name", name)
            opened.append((name, folder))
        _write_placemark(_added(opened[-1][1], "Placemark"), feature)
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True, pretty_print=True)


def _write_placemark(placemark: etree._Element, feature: MapFeature) -> None:
    if feature.name:
        _added(placemark, "name", feature.name)
    if feature.description:
        _added(placemark, "description", feature.description)
    if feature.times is not None and feature.geometry is Geometry.POINT:
        _added(_added(placemark, "TimeStamp"), "when", time_text(feature.times[0]))
    if feature.colour:
        red, green, blue = (feature.colour[at : at + 2] for at in (1, 3, 5))
        style = _added(placemark, "Style")
        kinds = {Geometry.POINT: ("IconStyle",), Geometry.LINE: ("LineStyle",)}
        for kind in kinds.get(feature.geometry, ("LineStyle", "PolyStyle")):
            opacity = "60" if kind == "PolyStyle" else "ff"
            _added(_added(style, kind), "color", f"{opacity}{blue}{green}{red}")
    native = {FOLDERS, COLOUR}
    if feature.reference in (HeightReference.GROUND, HeightReference.SEA_LEVEL):
        native.add(REFERENCE)
    data = {**feature.properties, **extras_of(feature, native)}
    if data:
        extended = _added(placemark, "ExtendedData")
        for key, value in data.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            _added(_added(extended, "Data", name=key), "value", text)
    _write_geometry(placemark, feature)


def _write_geometry(placemark: etree._Element, feature: MapFeature) -> None:
    mode = MODE_OF.get(feature.reference, "clampToGround")
    heights = feature.heights or tuple(np.full(len(ring), np.nan) for ring in feature.rings)
    if feature.geometry is Geometry.LINE and feature.times is not None:
        track = etree.SubElement(placemark, f"{{{GX}}}Track")
        _added(track, "altitudeMode", mode)
        for time in feature.times:
            _added(track, "when", time_text(time))
        for each in _tuples(feature.rings[0], heights[0], " "):
            etree.SubElement(track, f"{{{GX}}}coord").text = each
        return
    tag = {Geometry.POINT: "Point", Geometry.LINE: "LineString", Geometry.AREA: "Polygon"}[feature.geometry]
    shape = _added(placemark, tag)
    if feature.role is Role.OBSTACLE and feature.heights:
        _added(shape, "extrude", "1")
    if tag != "Point" and mode == "clampToGround":
        _added(shape, "tessellate", "1")
    _added(shape, "altitudeMode", mode)
    for number, (ring, height) in enumerate(zip(feature.rings, heights, strict=True)):
        owner, tuples = shape, _tuples(ring, height, ",")
        if tag == "Polygon":
            owner = _added(_added(shape, "innerBoundaryIs" if number else "outerBoundaryIs"), "LinearRing")
            tuples.append(tuples[0])
        _added(owner, "coordinates", " ".join(tuples))


def _tuples(ring: NDArray[np.float64], heights: NDArray[np.float64], comma: str) -> list[str]:
    return [
        comma.join(
            (degrees_text(longitude), degrees_text(latitude), *(() if np.isnan(h) else (metres_text(h),)))
        )
        for (latitude, longitude), h in zip(ring.tolist(), heights.tolist(), strict=True)
    ]


def _added(parent: etree._Element, tag: str, text: str | None = None, **attributes: str) -> etree._Element:
    child = etree.SubElement(parent, f"{{{KML}}}{tag}", attributes)
    child.text = text
    return child


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
