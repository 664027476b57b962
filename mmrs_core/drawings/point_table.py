"""Tables of points as CSV: one position in a row, columns known by their names."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.angles import LATITUDE, LONGITUDE, angle_of
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property
from mmrs_core.drawings.extras import take_extras
from mmrs_core.drawings.sheet import DrawnSubject, Sheet

AXES = "the columns tell latitude and longitude"
DELIMITERS = (",", ";", "\t")
LATITUDES, LONGITUDES = ("latitude", "lat", "y"), ("longitude", "lon", "lng", "long", "x")
HEIGHTS = {
    **dict.fromkeys(("altitude", "alt", "elevation", "ele", "amsl", "z"), HeightReference.SEA_LEVEL),
    **dict.fromkeys(("height", "agl"), HeightReference.GROUND),
    "relative_altitude": HeightReference.HOME,
    "ellipsoidal_height": HeightReference.ELLIPSOID,
}
NAMES, DESCRIPTIONS = ("name", "label", "id"), ("description", "desc")
GROUPS = {"area": Geometry.AREA, "polygon": Geometry.AREA, "line": Geometry.LINE, "path": Geometry.LINE}
SHAPES = ("wkt", "geometry", "geom", "the_geom", "wkt_geom")


def recognise(data: bytes, file: str) -> bool:
    """Return whether the first line names a latitude and a longitude."""
    line = data[:4000].decode("utf-8-sig", "replace").splitlines()[:1]
    return bool(line) and _mark_of(line[0]) is not None


def _plain(cell: str) -> str:
    """Return the name of a column in small letters, without its unit."""
    return re.split(r"[(\[]", cell, maxsplit=1)[0].strip(" \"'").lower().replace(" ", "_")


def _mark_of(header: str) -> str | None:
    """Return what stands between the columns of a header; None if no position is among them."""
    for mark in DELIMITERS:
        names = [*map(_plain, header.split(mark))]
        if all(any(name in names for name in axis) for axis in (LATITUDES, LONGITUDES)):
            return mark
    return None


def read(data: bytes, file: str) -> Drawing:
    """Return a point for each row; rows with the same value in a column ``area`` or ``line`` are one shape.

    Raises:
        UnreadableError: with the line of the first fault; a row that states no position is left out.
    """
    sheet = Sheet(data, file, AXES, lenient=True)
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError as fault:
        sheet.refuse("not UTF-8; save it as such", data.count(b"\n", 0, fault.start) + 1)
    header = next(iter(text.lstrip().splitlines()), "")
    mark = _mark_of(header)
    if mark is None:
        if {_plain(cell) for cell in re.split("[,;\t]", header)} & {*SHAPES}:
            sheet.refuse("shapes as text (WKT) are not read; export the layer as GeoJSON", 1)
        sheet.refuse(
            "columns named latitude and longitude are expected, between commas, semicolons or tabs", 1
        )
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=mark, strict=True)
    try:
        written = ((row, rows.line_num) for row in rows if any(map(str.strip, row)))
        _Table(sheet, next(written)[0], mark).read(written)
    except csv.Error as fault:
        sheet.refuse(f"not CSV: {fault}", rows.line_num)
    return sheet.drawing()


@dataclass(slots=True)
class _Group:
    """The rows of one area or line.

    Attributes:
        fault: of the first row that states no position.
        cells: the different values in each column.
    """

    line: int
    fault: str = ""
    positions: list[list[float]] = field(default_factory=list)
    cells: dict[str, dict[str, None]] = field(default_factory=dict)


class _Table:
    def __init__(self, sheet: Sheet, header: Sequence[str], mark: str) -> None:
        self._sheet, self._header, self._decimal_comma = sheet, header, mark != ","
        names = [*map(_plain, header)]
        self._columns = {name: at for at, name in reversed([*enumerate(names)]) if name}
        known = {*LATITUDES, *LONGITUDES, *HEIGHTS, *NAMES, *GROUPS}
        for at, name in enumerate(names):
            if self._columns.get(name, at) != at:
                if name in known:
                    sheet.refuse(f"column {header[at].strip()!r} is there twice", 1)
                sheet.leave_out(f"column {at + 1}, '{header[at].strip()[:60]}'", "its name is there twice", 1)
            elif not name and any(names[at:]):
                sheet.leave_out(f"column {at + 1}", "it has no name", 1)
        first = [next((name for name in axis if name in names), "") for axis in (LATITUDES, LONGITUDES)]
        if not all(first):
            sheet.refuse("the first line cannot be divided into columns", 1)
        self._position = [self._columns[name] for name in first]
        height = next((name for name in HEIGHTS if name in self._columns), "")
        self._height = self._columns.get(height, -1)
        self._reference = HEIGHTS.get(height, HeightReference.NONE)
        used = {*first, height}
        self._further = {name: at for name, at in self._columns.items() if name not in used}

    def read(self, rows: Iterator[tuple[list[str], int]]) -> None:
        """Add what the rows show."""
        groups: dict[tuple[Geometry, str], _Group] = {}
        for row, line in rows:
            cells = {
                name: text
                for name, at in self._further.items()
                if (text := "".join(row[at : at + 1]).strip())
            }
            column = next((name for name in GROUPS if name in cells), "")
            if column:
                group = groups.setdefault((GROUPS[column], cells.pop(column)), _Group(line))
                for name, text in cells.items():
                    group.cells.setdefault(name, {})[text] = None
            else:
                group = _Group(line, cells={name: {text: None} for name, text in cells.items()})
            try:
                group.positions.append(self._position_of(row))
            except ValueError as fault:
                group.fault = group.fault or (f"row {line}: {fault}" if column else str(fault))
            if not column:
                self._add(Geometry.POINT, "", group)
        for (geometry, name), group in groups.items():
            self._add(geometry, name, group)

    def _position_of(self, row: Sequence[str]) -> list[float]:
        """Return latitude and longitude, and the height where the row has one."""
        if any(map(str.strip, row[len(self._header) :])):
            raise ValueError(f"{len(row)} cells, but {len(self._header)} columns")
        cells = [row[at].strip() if at < len(row) else "" for at in (*self._position, self._height)]
        texts = [text.replace(",", ".") if self._decimal_comma else text for text in cells]
        position = []
        for text, axis, word in zip(
            texts, (LATITUDE, LONGITUDE, ""), ("latitude", "longitude", "height"), strict=True
        ):
            if axis or (text and self._height >= 0):
                try:
                    position.append(angle_of(text, axis) if axis else float(text))
                except ValueError as fault:
                    why = fault if axis else "not a number of metres"
                    raise ValueError(f"{word} {text[:40]!r}: {why}") from None
        return position

    def _add(self, geometry: Geometry, name: str, group: _Group) -> None:
        """Add a feature, with what all of its rows state."""
        text: dict[bool, str] = {}
        for is_name, keys in ((True, () if name else NAMES), (False, DESCRIPTIONS)):
            key = next((key for key in keys if len(group.cells.get(key, ())) == 1), None)
            text[is_name] = next(iter(group.cells.pop(key))) if key else ""
        name = name or text[True]
        what = f"{geometry.value} '{name[:60]}'" if name else "row"
        properties: dict[str, Property] = {}
        for key, values in group.cells.items():
            shown = self._header[self._columns[key]].strip()
            if len(values) > 1:
                self._sheet.leave_out(f"column '{shown[:60]}' of {what}", "its rows differ", group.line)
            else:
                properties[shown] = next(iter(values))
        traits, reference = take_extras(properties)
        traits |= {"name": name, "description": text[False], "properties": properties}
        subject = DrawnSubject(what, Place(self._sheet.file, group.line), traits, reference)
        if group.fault:
            self._sheet.leave_out(what, group.fault, group.line, subject)
            return
        ring = self._sheet.positions(group.positions, what, group.line)
        self._sheet.add(geometry, [ring], subject, self._reference)
