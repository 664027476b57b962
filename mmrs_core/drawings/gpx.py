"""GPX 1.0 and 1.1 (https://www.topografix.com/gpx.asp): waypoints, routes and tracks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property, Role
from mmrs_core.drawings.extras import PREFIX, take_extras, times_of
from mmrs_core.drawings.sheet import DrawnSubject, Sheet
from mmrs_core.drawings.xml_text import XmlNode, read_tree, root_tag

AXES = "GPX names them lat and lon"
AREA = f"{PREFIX}area"
"""Marks a track whose segments are the rings of an area."""
POINT = ("@lat", "@lon", "ele", "time")
KINDS = {"wpt": Role.UNKNOWN, "rte": Role.UNKNOWN, "trk": Role.TRACK}
TEXTS = ("cmt", "src", "type", "sym", "number", "geoidheight", "fix", "sat", "hdop", "vdop", "pdop")
READ = ("name", "desc", "ele", "time", "trkseg", "link", "url", "urlname", "magvar")
ROOT = ("metadata", "name", "desc", "author", "email", "url", "urlname", "time", "keywords", "bounds")


def recognise(data: bytes, file: str) -> bool:
    """Return whether it is GPX."""
    return root_tag(data) == "gpx"


def read(data: bytes, file: str) -> Drawing:
    """Return waypoints as points, routes and the segments of tracks as lines.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    sheet = Sheet(data, file, AXES)
    root = read_tree(data, sheet, dict.fromkeys(("rtept", "trkpt"), POINT))
    if root.tag != "gpx":
        sheet.refuse(f"'{root.tag}' is not the root of a GPX file", root.line)
    reader = _GpxReader(sheet)
    counts = dict.fromkeys(KINDS, 0)
    for node in root.children:
        if node.tag in KINDS:
            counts[node.tag] += 1
            reader.feature(node, f"/{node.tag}[{counts[node.tag]}]")
        elif node.tag not in ROOT:
            sheet.leave_out(node.tag, "not read in GPX", node.line)
    metadata = root.child("metadata")
    return sheet.drawing((metadata or root).of("name"))


class _GpxReader:
    def __init__(self, sheet: Sheet) -> None:
        self._sheet = sheet

    def feature(self, node: XmlNode, path: str) -> None:
        """Add what a waypoint, a route or a track shows."""
        name = node.of("name")
        what = f"{node.tag} '{name[:60]}'" if name else path.lstrip("/")
        properties = self._properties(node, what)
        area = properties.pop(AREA, None) is not None
        traits, reference = take_extras(properties)
        traits |= {"name": name, "description": node.of("desc"), "properties": properties}
        traits.setdefault("role", Role.UNKNOWN if area else KINDS[node.tag])
        subject = DrawnSubject(what, Place(self._sheet.file, node.line, path), traits, reference)
        if node.tag == "wpt":
            position = (node.attributes.get(each, "") for each in ("lat", "lon"))
            node.gathered["wpt"] = [[each] for each in (*position, node.of("ele"), node.of("time"))]
        parts = [*node.all("trkseg")] if node.tag == "trk" else [node]
        kind = {"wpt": "wpt", "rte": "rtept", "trk": "trkpt"}[node.tag]
        segments = [self._segment(part, kind, subject) for part in parts if kind in part.gathered]
        if not segments:
            self._sheet.leave_out(what, "no positions", node.line)
        elif area:
            rings = [ring for ring, _ in segments]
            self._sheet.add(Geometry.AREA, rings, subject, HeightReference.SEA_LEVEL)
        else:
            geometry = Geometry.POINT if node.tag == "wpt" else Geometry.LINE
            for ring, times in segments:
                self._sheet.add(geometry, [ring], replace(subject, times=times), HeightReference.SEA_LEVEL)

    def _segment(
        self, part: XmlNode, kind: str, subject: DrawnSubject
    ) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
        """Return latitude, longitude and height where all positions have one, and their times."""
        what, line = subject.what, part.line
        latitudes, longitudes, heights, times = part.gathered[kind]
        try:
            columns = [[*map(float, each)] for each in (latitudes, longitudes, *([heights] * all(heights)))]
        except ValueError as fault:
            self._sheet.refuse(f"{what}: coordinates: {fault}", line)
        for word, given in (("heights", heights), ("times", times)):
            if any(given) and not all(given):
                self._sheet.leave_out(f"{word} of {what}", "some positions have none", line)
        ring = np.column_stack(columns)
        try:
            return ring, times_of(times) if all(times) else None
        except (ValueError, OverflowError) as fault:
            self._sheet.leave_out(f"times of {what}", str(fault).lower(), line)
            return ring, None

    def _properties(self, node: XmlNode, what: str) -> dict[str, Property]:
        properties: dict[str, Property] = {tag: text for tag in TEXTS if (text := node.of(tag))}
        for child in node.children:
            if child.tag == "extensions":
                for each in child.children:
                    properties[each.attributes.get("name", each.tag)] = each.text
            elif child.tag not in (*TEXTS, *READ):
                self._sheet.leave_out(f"{child.tag} of {what}", f"not read in a {node.tag}", child.line)
        return properties
