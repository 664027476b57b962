"""KML 2.0 to 2.3 and KMZ (OGC 12-007r2), as Google Earth, QGIS and others write and read them."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import chain, takewhile

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import (
    Drawing,
    Geometry,
    HeightReference,
    MapFeature,
    Property,
    Role,
    printable,
)
from mmrs_core.drawings.extras import (
    COLOUR,
    FOLDERS,
    REFERENCE,
    above,
    degrees_text,
    extras_of,
    lost,
    metres_text,
    take_extras,
    time_text,
    times_of,
)
from mmrs_core.drawings.sheet import LARGEST_FILE, DrawnSubject, FeatureTraits, Sheet
from mmrs_core.drawings.xml_text import XmlNode, read_tree, root_tag

AXES = "KML has the longitude first"
KML, GX = "http://www.opengis.net/kml/2.2", "http://www.google.com/kml/ext/2.2"
NAMESPACES: dict[str, str] = {None: KML, "gx": GX}  # type: ignore[dict-item]  # lxml's default namespace
MOST_ENTRIES = 10_000
CONTAINERS = ("Document", "Folder")
KINDS = {
    "Point": Geometry.POINT,
    "LineString": Geometry.LINE,
    "Track": Geometry.LINE,
    "LinearRing": Geometry.AREA,
    "Polygon": Geometry.AREA,
}
MANY = ("MultiGeometry", "MultiTrack")
GEOMETRIES = (*KINDS, *MANY, "Model")
LOOKS = frozenset(
    (
        *(
            "name",
            "open",
            "visibility",
            "LookAt",
            "Camera",
            "Style",
            "StyleMap",
            "styleUrl",
            "Schema",
            "Region",
        ),
        *("author", "link", "Snippet", "balloonVisibility", "snippet"),
    )
)
"""How things look and who drew them, which is not read."""
WORDS = ("address", "phoneNumber")
REASONS = {
    "GroundOverlay": "a picture, not a shape",
    "PhotoOverlay": "a picture, not a shape",
    "ScreenOverlay": "a picture, not a shape",
    "NetworkLink": "links are not followed",
    "Tour": "a flight of the camera, not a shape",
    "Model": "a body, not a shape",
}
MODES = {
    "relativeToGround": HeightReference.GROUND,
    "relativeToSeaFloor": HeightReference.GROUND,
    "absolute": HeightReference.SEA_LEVEL,
}
MODE_OF = {
    HeightReference.GROUND: "relativeToGround",
    HeightReference.HOME: "relativeToGround",
    HeightReference.SEA_LEVEL: "absolute",
}
"""Heights above the ellipsoid are written, but not used where a shape lies on the ground."""
NUMBERS: Mapping[str, Callable[[str], Property]] = {
    **dict.fromkeys(("int", "uint", "short", "ushort"), int),
    **dict.fromkeys(("float", "double"), float),
    "bool": lambda text: {"true": True, "1": True, "false": False, "0": False}[text.lower()],
}


def recognise(data: bytes, file: str) -> bool:
    """Return whether it is KML, or a KMZ archive."""
    return root_tag(data) == "kml" or (data[:4] == b"PK\3\4" and file.lower().endswith((".kmz", ".kml")))


def read(data: bytes, file: str) -> Drawing:
    """Return the placemarks of a KML file, or of all KML files in a KMZ archive, ``doc.kml`` first.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    if data[:4] != b"PK\3\4":
        return _KmlReader(data, file).read()
    archive = Sheet(data, file, AXES)
    drawn = [_KmlReader(content, f"{file}/{name}").read() for name, content in _entries(data, archive)]
    features = tuple(chain.from_iterable(each.features for each in drawn))
    return Drawing(
        features, (*archive.left_out, *(out for each in drawn for out in each.left_out)), drawn[0].title
    )


def _entries(data: bytes, sheet: Sheet) -> list[tuple[str, bytes]]:
    """Return names and contents of the KML files of an archive; nothing is unpacked to the disk."""
    if data.count(b"PK\1\2") > MOST_ENTRIES:
        sheet.refuse(f"more than {MOST_ENTRIES} files in the archive")
    contents, left = [], LARGEST_FILE
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [entry for entry in archive.infolist() if not entry.is_dir()]
            drawn = [entry for entry in entries if entry.filename.lower().endswith(".kml")]
            for entry in sorted(drawn, key=lambda each: each.filename != "doc.kml"):
                if entry.flag_bits & 1:
                    sheet.refuse(f"'{printable(entry.filename)}' in the archive is encrypted")
                with archive.open(entry) as stream:
                    content = stream.read(left + 1)
                left -= len(content)
                if left < 0:
                    sheet.refuse(f"more than {LARGEST_FILE // (1024 * 1024)} MB of KML in the archive")
                contents.append((printable(entry.filename), content))
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        NotImplementedError,
        OSError,
        ValueError,
        RuntimeError,
    ) as fault:
        sheet.refuse(f"not readable as an archive: {fault}")
    if not drawn:
        sheet.refuse("an archive without a .kml file")
    if len(entries) > len(drawn):
        sheet.leave_out(f"other files in the archive: {len(entries) - len(drawn)}", "not KML")
    return contents


def _gather(node: XmlNode, parent: XmlNode) -> None:
    parent.gathered.setdefault(node.tag, []).append(node.text)


class _KmlReader:
    def __init__(self, data: bytes, file: str) -> None:
        self._sheet, self._data = Sheet(data, file, AXES), data
        self._types: dict[str, dict[str, str]] = {}
        self._count = 0

    def read(self) -> Drawing:
        folds = {"when": _gather, "coord": _gather, "angles": _gather}
        root = read_tree(self._data, self._sheet, folds)
        if root.tag != "kml":
            self._sheet.refuse(f"'{root.tag}' is not the root of a KML file", root.line)
        top = root.child("Document")
        if top is not None:
            self._schemas(top)
        for child in root.children:
            self._inside(child, child.children if child is top else [child], ())
        return self._sheet.drawing(top.of("name") if top is not None else "")

    def _schemas(self, top: XmlNode) -> None:
        for schema in top.all("Schema"):
            self._types[schema.attributes.get("id", "")] = {
                field.attributes.get("name", ""): field.attributes.get("type", "")
                for field in schema.all("SimpleField", "SimpleArrayField")
            }

    def _inside(self, owner: XmlNode, children: list[XmlNode], folders: tuple[str, ...]) -> None:
        for node in children:
            if node.tag in CONTAINERS:
                self._schemas(node)
                self._inside(node, node.children, (*folders, node.of("name")))
            elif node.tag == "Placemark":
                self._placemark(node, folders)
            elif node.tag not in LOOKS:
                reason = REASONS.get(node.tag, f"not read in a {owner.tag}")
                self._sheet.leave_out(_called(node), reason, node.line)

    def _placemark(self, node: XmlNode, folders: tuple[str, ...]) -> None:
        self._count += 1
        what = _called(node)
        properties = self._properties(node, what)
        traits, reference = take_extras(properties)
        style = node.child("Style")
        if style is not None and (colour := _colour(style)):
            traits["colour"] = colour
        times = self._time(node, what, properties)
        traits |= {"name": node.of("name"), "description": node.of("description")}
        traits |= {"folders": folders, "properties": properties}
        shapes = list(node.all(*GEOMETRIES))
        place = Place(self._sheet.file, node.line, f"/Placemark[{self._count}]")
        for shape in shapes:
            self._shape(shape, DrawnSubject(what, place, traits, reference, times))
        if not shapes:
            self._sheet.leave_out(what, "no geometry", node.line)

    def _shape(self, node: XmlNode, subject: DrawnSubject) -> None:
        what, kind = subject.what, KINDS.get(node.tag)
        if node.tag in MANY:
            for part in node.children:
                if part.tag in GEOMETRIES:
                    self._shape(part, subject)
                elif part.tag not in ("altitudeMode", "interpolate"):
                    self._sheet.leave_out(
                        f"{_called(part)} of {what}", f"not read in a {node.tag}", part.line
                    )
        elif kind is None:
            self._sheet.leave_out(f"{_called(node)} of {what}", REASONS[node.tag], node.line)
        elif node.tag == "Track":
            ring, times = self._track(node, what)
            traits: FeatureTraits = {"role": Role.TRACK, **subject.traits}
            track = replace(subject, traits=traits, times=times)
            self._sheet.add(kind, [ring], track, self._mode(node, [ring], subject))
        else:
            rings = [self._coordinates(ring, what) for ring in _boundaries(node)]
            self._sheet.add(kind, rings, subject, self._mode(node, rings, subject))

    def _track(self, node: XmlNode, what: str) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
        places, times = node.gathered.get("coord", []), node.gathered.get("when", [])
        rows = [str(each).split() for each in places]
        if "angles" in node.gathered or node.child("Model") is not None:
            self._sheet.leave_out(
                f"attitude of {what}", "only positions and times of a track are read", node.line
            )
        ring = self._degrees(rows, what, node.line)
        if len(times) != len(places):
            self._sheet.leave_out(f"times of {what}", "as many times as positions are needed", node.line)
            return ring, None
        return ring, self._times([str(each) for each in times], what, node.line)

    def _coordinates(self, ring: XmlNode, what: str) -> NDArray[np.float64]:
        node = ring.child("coordinates")
        text = node.text if node is not None else ""
        if ", " in text or " ," in text:
            text = ",".join(map(str.strip, text.split(",")))
        rows = [part.rstrip(",").split(",") for part in text.split()]
        return self._degrees(rows, what, (node or ring).line)

    def _degrees(self, rows: list[list[str]], what: str, line: int) -> NDArray[np.float64]:
        if not rows:
            return np.empty((0, 2))
        try:
            array = self._sheet.positions([list(map(float, row)) for row in rows], what, line)
        except ValueError as fault:
            self._sheet.refuse(f"{what}: coordinates: {fault}", line)
        return array[:, [1, 0, 2][: array.shape[1]]]

    def _mode(
        self, node: XmlNode, rings: list[NDArray[np.float64]], subject: DrawnSubject
    ) -> HeightReference:
        mode = node.of("altitudeMode")
        if mode in MODES:
            return MODES[mode]
        if subject.reference is None and any(ring.shape[1] == 3 and ring[:, 2].any() for ring in rings):
            shown = mode or "clampToGround"
            self._sheet.leave_out(
                f"heights of {subject.what}", f"not used with altitudeMode {shown}", node.line
            )
        return HeightReference.NONE

    def _time(self, node: XmlNode, what: str, properties: dict[str, Property]) -> NDArray[np.float64] | None:
        stamp, span = node.child("TimeStamp"), node.child("TimeSpan")
        if span is not None:
            properties |= {end: text for end in ("begin", "end") if (text := span.of(end))}
        if stamp is None:
            return None
        return self._times([str(each) for each in stamp.gathered.get("when", [])], what, stamp.line)

    def _times(self, texts: list[str], what: str, line: int) -> NDArray[np.float64] | None:
        try:
            return times_of(texts)
        except (ValueError, OverflowError) as fault:
            self._sheet.leave_out(f"times of {what}", str(fault).lower(), line)
            return None

    def _properties(self, node: XmlNode, what: str) -> dict[str, Property]:
        properties: dict[str, Property] = {tag: text for tag in WORDS if (text := node.of(tag))}
        if node.of("visibility") == "0":
            properties["visibility"] = False
        extended = node.child("ExtendedData")
        for name, value, line in self._data_of(extended) if extended is not None else ():
            if name in properties:
                self._sheet.leave_out(f"data '{name}' of {what}", "given twice", line)
            else:
                properties[name] = value
        read = (*GEOMETRIES, *LOOKS, *WORDS, "description", "ExtendedData", "TimeStamp", "TimeSpan")
        for child in node.children:
            if child.tag not in read:
                self._sheet.leave_out(f"{_called(child)} of {what}", "not read in a Placemark", child.line)
        return properties

    def _data_of(self, extended: XmlNode) -> Iterator[tuple[str, Property, int]]:
        for node in extended.children:
            if node.tag == "Data":
                yield node.attributes.get("name", ""), node.of("value"), node.line
            elif node.tag == "SchemaData":
                types = self._types.get(node.attributes.get("schemaUrl", "").rpartition("#")[2], {})
                for field in node.children:
                    name = field.attributes.get("name", "")
                    yield name, _typed(field.text, types.get(name, "")), field.line
            else:
                yield node.tag, node.text, node.line


def _typed(text: str, type: str) -> Property:
    try:
        return NUMBERS[type](text)
    except (KeyError, ValueError):
        return text


def _boundaries(node: XmlNode) -> list[XmlNode]:
    if node.tag != "Polygon":
        return [node]
    sides = [*node.all("outerBoundaryIs"), *node.all("innerBoundaryIs")]
    return [ring for side in sides for ring in side.all("LinearRing")]


def _called(node: XmlNode) -> str:
    """Return what an element is called in messages: ``ground overlay 'orchard'``."""
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", node.tag).lower()
    name = node.of("name")
    return f"{words} '{name[:60]}'" if name else words


def _colour(style: XmlNode) -> str:
    """Return the first colour of a style, which KML writes ``aabbggrr``."""
    for kind in style.all("LineStyle", "PolyStyle", "IconStyle"):
        if found := re.fullmatch(
            r"[0-9a-f]{2}([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})", kind.of("color").lower()
        ):
            return "#" + "".join(found.groups()[::-1])
    return ""


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
