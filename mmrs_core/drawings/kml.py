"""KML 2.0 to 2.3 and KMZ (OGC 12-007r2), as Google Earth, QGIS and others write them."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property, Role, printable
from mmrs_core.drawings.extras import take_extras, times_of
from mmrs_core.drawings.sheet import LARGEST_FILE, DrawnSubject, FeatureTraits, Sheet
from mmrs_core.drawings.xml_text import XmlNode, read_tree, root_tag

AXES = "KML has the longitude first"
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
                parts = re.split(r"[\\/:]", printable(entry.filename))
                contents.append(("/".join(part for part in parts if part.strip(". ")), content))
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


class _KmlReader:
    def __init__(self, data: bytes, file: str) -> None:
        self._sheet, self._data = Sheet(data, file, AXES), data
        self._types: dict[str, dict[str, str]] = {}
        self._count = 0

    def read(self) -> Drawing:
        root = read_tree(self._data, self._sheet, dict.fromkeys(("when", "coord", "angles"), ("",)))
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
        named = (str(value) for key, value in properties.items() if key.lower() == "name")
        traits |= {"name": node.of("name") or next(named, ""), "description": node.of("description")}
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
        ((places,), (times,)) = (node.gathered.get(tag, [[]]) for tag in ("coord", "when"))
        rows = [*map(str.split, places)]
        if "angles" in node.gathered or node.child("Model") is not None:
            self._sheet.leave_out(
                f"attitude of {what}", "only positions and times of a track are read", node.line
            )
        ring = self._degrees(rows, what, node.line)
        if len(times) != len(places):
            self._sheet.leave_out(f"times of {what}", "as many times as positions are needed", node.line)
            return ring, None
        return ring, self._times(times, what, node.line)

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
        return self._times(stamp.gathered.get("when", [[]])[0], what, stamp.line)

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
