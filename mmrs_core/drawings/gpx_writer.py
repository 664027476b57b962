"""GPX 1.1 (https://www.topografix.com/gpx.asp), as receivers and map programs read it."""

from __future__ import annotations

from lxml import etree

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, MapFeature, Role, printable
from mmrs_core.drawings.extras import REFERENCE, ROLE, degrees_text, extras_of, lost, metres_text, time_text
from mmrs_core.drawings.gpx import AREA, KINDS

GPX, OWN = "http://www.topografix.com/GPX/1/1", "urn:mmrs:drawing:1.0"
NAMESPACES: dict[str, str] = {None: GPX, "mmrs": OWN}  # type: ignore[dict-item]  # lxml's default namespace


def write(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as GPX 1.1; an area is a closed track with a segment for each ring."""
    root = etree.Element(f"{{{GPX}}}gpx", {"version": "1.1", "creator": "MMRS"}, nsmap=NAMESPACES)
    _added(_added(root, "metadata"), "name", printable(title))
    written: dict[str, list[etree._Element]] = {tag: [] for tag in KINDS}
    for feature in drawing.features:
        tag = _tag_of(feature)
        element = etree.Element(f"{{{GPX}}}{tag}")
        written[tag].append(element)
        if tag == "wpt":
            _position(element, feature, 0, 0)
        _describe(element, feature)
        for ring in range(len(feature.rings)):
            owner = _added(element, "trkseg") if tag == "trk" else element
            indices = [*range(len(feature.rings[ring])), *([0] if feature.geometry is Geometry.AREA else [])]
            for at in indices if tag != "wpt" else ():
                _position(_added(owner, f"{tag}pt"), feature, ring, at)
    for elements in written.values():
        root.extend(elements)
    return etree.tostring(root, encoding="UTF-8", xml_declaration=True, pretty_print=True)


def _tag_of(feature: MapFeature) -> str:
    if feature.geometry is Geometry.POINT:
        return "wpt"
    return "rte" if feature.geometry is Geometry.LINE and feature.times is None else "trk"


def _position(point: etree._Element, feature: MapFeature, ring: int, at: int) -> None:
    latitude, longitude = feature.rings[ring][at]
    point.set("lat", degrees_text(latitude))
    point.set("lon", degrees_text(longitude))
    if feature.reference is HeightReference.SEA_LEVEL:
        _added(point, "ele", metres_text(feature.heights[ring][at]))
    if feature.times is not None and ring == 0:
        _added(point, "time", time_text(feature.times[at]))


def _describe(element: etree._Element, feature: MapFeature) -> None:
    if feature.name:
        _added(element, "name", feature.name)
    if feature.description:
        _added(element, "desc", feature.description)
    native = KINDS[_tag_of(feature)] if feature.geometry is not Geometry.AREA else Role.UNKNOWN
    data = {**feature.properties, **extras_of(feature, (REFERENCE,))}
    if feature.role is native:
        data.pop(ROLE, None)
    elif not feature.role:
        data[ROLE] = ""
    if feature.geometry is Geometry.AREA:
        data[AREA] = True
    if data:
        extensions = _added(element, "extensions")
        for key, value in data.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            etree.SubElement(extensions, f"{{{OWN}}}property", {"name": key}).text = text


def _added(parent: etree._Element, tag: str, text: str | None = None) -> etree._Element:
    child = etree.SubElement(parent, f"{{{GPX}}}{tag}")
    child.text = text
    return child


def losses(drawing: Drawing) -> tuple[str, ...]:
    """Return what GPX cannot hold, or what other programs read otherwise."""
    others = set(HeightReference) - {HeightReference.NONE, HeightReference.SEA_LEVEL}
    return lost(
        drawing,
        {
            "heights above something else than mean sea level: not written": lambda each: (
                each.reference in others
            ),
            "areas: written as closed tracks": lambda each: each.geometry is Geometry.AREA,
            "circles: drawn as points": lambda each: each.radius is not None,
            "times since the start: written as times on 1970-01-01": lambda each: (
                each.since_start and each.times is not None
            ),
        },
    )
