"""Tables of points as CSV: one position in a row, columns known by their names."""

from __future__ import annotations

import csv
import io
import re
from math import inf

import numpy as np

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Property
from mmrs_core.drawings.extras import take_extras
from mmrs_core.drawings.sheet import DrawnSubject, FeatureTraits, Sheet

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


def recognise(data: bytes, file: str) -> bool:
    """Return whether the first line names a latitude and a longitude."""
    line = data[:4000].decode("utf-8-sig", "replace").splitlines()[:1]
    return any(_columns(line[0].split(mark)) is not None for mark in DELIMITERS) if line else False


def _columns(cells: list[str]) -> dict[str, int] | None:
    """Return the columns of a header by their plain names; None if no position is among them."""
    plain = [
        re.split(r"[(\[]", cell, maxsplit=1)[0].strip(" \"'").lower().replace(" ", "_") for cell in cells
    ]
    columns = {name: at for at, name in reversed(list(enumerate(plain)))}
    position = [
        next((columns[name] for name in names if name in columns), None) for names in (LATITUDES, LONGITUDES)
    ]
    return columns if None not in position else None


def read(data: bytes, file: str) -> Drawing:
    """Return a point for each row; rows with the same value in a column ``area`` or ``line`` are one shape.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    sheet = Sheet(data, file, AXES)
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError as fault:
        sheet.refuse("not UTF-8; save it as such", data.count(b"\n", 0, fault.start) + 1)
    header = text.lstrip().splitlines()[0]
    mark = next((each for each in DELIMITERS if _columns(header.split(each)) is not None), None)
    if mark is None:
        sheet.refuse(
            "columns named latitude and longitude are expected, between commas, semicolons or tabs", 1
        )
    return _TableReader(
        sheet, csv.reader(io.StringIO(text, newline=""), delimiter=mark, strict=True), mark
    ).read()


class _TableReader:
    def __init__(self, sheet: Sheet, rows: csv._reader, mark: str) -> None:  # type: ignore[name-defined]
        self._sheet, self._rows, self._mark = sheet, rows, mark

    def read(self) -> Drawing:
        """Return what the rows show."""
        groups: dict[tuple[Geometry, str], list[tuple[list[float], int]]] = {}
        try:
            header = next(row for row in self._rows if any(row))
            columns = _columns(header) or {}
            for row in self._rows:
                if any(cell.strip() for cell in row):
                    self._row(row, header, columns, groups)
        except csv.Error as fault:
            self._sheet.refuse(f"not CSV: {fault}", self._rows.line_num)
        for (geometry, name), corners in groups.items():
            rows = [corner for corner, _ in corners]
            what, line = f"{geometry.value} '{name[:60]}'", corners[0][1]
            subject = DrawnSubject(what, Place(self._sheet.file, line), {"name": name})
            ring = self._sheet.positions(rows, what, line)
            self._sheet.add(geometry, [ring], subject, self._reference(columns))
        return self._sheet.drawing()

    def _reference(self, columns: dict[str, int]) -> HeightReference:
        return next((HEIGHTS[name] for name in HEIGHTS if name in columns), HeightReference.NONE)

    def _row(
        self,
        row: list[str],
        header: list[str],
        columns: dict[str, int],
        groups: dict[tuple[Geometry, str], list[tuple[list[float], int]]],
    ) -> None:
        line = self._rows.line_num
        if len(row) > len(header):
            self._sheet.refuse(f"{len(row)} cells, but {len(header)} columns", line)
        cells = {name: row[at].strip() for name, at in columns.items() if at < len(row)}
        height = next((name for name in HEIGHTS if name in columns), "")
        used = [next(name for name in names if name in columns) for names in (LATITUDES, LONGITUDES)]
        if height and cells.get(height):
            used.append(height)
        position = [self._number(cells.pop(name, ""), name, line) for name in used]
        cells.pop(height, None)
        for column, geometry in GROUPS.items():
            if group := cells.pop(column, ""):
                groups.setdefault((geometry, group), []).append((position, line))
                return
        name, description = (
            next((cells.pop(key) for key in keys if cells.get(key)), "") for keys in (NAMES, DESCRIPTIONS)
        )
        properties: dict[str, Property] = {
            header[columns[key]].strip(): value for key, value in cells.items() if value
        }
        traits: FeatureTraits
        traits, reference = take_extras(properties)
        traits |= {"name": name, "description": description, "properties": properties}
        what = f"row '{name[:60]}'" if name else "row"
        subject = DrawnSubject(what, Place(self._sheet.file, line), traits, reference)
        ring = np.array([position])
        self._sheet.add(Geometry.POINT, [ring], subject, self._reference(columns))

    def _number(self, text: str, name: str, line: int) -> float:
        plain = text.replace(",", ".") if self._mark != "," else text
        try:
            return float(plain) if "_" not in plain else float("x")
        except ValueError:
            self._sheet.refuse(f"{name} {text[:40]!r} is not a number in degrees or metres", line)
        return inf
