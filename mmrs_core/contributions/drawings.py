"""The formats of other map programs: what reads drawings, and what writes them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING

from mmrs_core.errors import UnreadableError

if TYPE_CHECKING:
    from mmrs_core.drawings.drawing import Drawing, HeightReference


_ADVICE = {
    **dict.fromkeys(
        (".shp", ".shx", ".dbf", ".gpkg", ".gdb", ".gml", ".fgb", ".tab", ".mif", ".dgn", ".sqlite", ".zip"),
        "save it as GeoJSON in WGS 84: in QGIS with Export > Save Features As, or with "
        "ogr2ogr -f GeoJSON -t_srs EPSG:4326 field.geojson FILE",
    ),
    ".dxf": "give it its coordinate system and save it as GeoJSON in WGS 84 in QGIS: Layer > Save As",
    ".dwg": "save it as DXF, and that as GeoJSON in WGS 84 in QGIS",
    **dict.fromkeys((".xls", ".xlsx", ".ods"), "save the sheet as CSV in UTF-8"),
}
"""What to do with files that other programs convert, by suffix."""


def _nothing_lost(drawing: Drawing) -> tuple[str, ...]:
    return ()


@dataclass(frozen=True, slots=True)
class DrawingReader:
    """A reader of one format.

    Attributes:
        name: of the format in messages, such as ``KML``.
        suffixes: of files in small letters, with the dot.
        recognise: (data, file) to whether the file is of this format; looks at its beginning at most. Decides
            where several formats share a suffix, and for files with other suffixes.
        read: (data, file) to its drawing; raises UnreadableError with the line of the first fault.
    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[bytes, str], bool]
    read: Callable[[bytes, str], Drawing]


def reader_for(data: bytes, file: str, readers: Sequence[DrawingReader]) -> DrawingReader:
    """Return the reader of a file: that of its suffix, or the one that recognises what it holds.

    Raises:
        UnreadableError: if none does, with the formats there are.
    """
    suffix = PurePath(file).suffix.lower()
    named = [reader for reader in readers if suffix in reader.suffixes]
    if len(named) == 1:
        return named[0]
    known = named or list(readers)
    recognised = [reader for reader in known if reader.recognise(data, file)]
    if len(recognised) == 1:
        return recognised[0]
    if (advice := _ADVICE.get(suffix)) and not recognised:
        raise UnreadableError.of("", f"{suffix} is not read; {advice}", file)
    shown = ", ".join(f"{reader.name} ({', '.join(reader.suffixes)})" for reader in recognised or known)
    if recognised:
        raise UnreadableError.of("", f"may be of several formats: {shown}", file)
    raise UnreadableError.of("", f"of no format that is known: {shown}", file)


@dataclass(frozen=True, slots=True)
class Exporter:
    """A writer of one format.

    Attributes:
        name: as typed after ``--format``, such as ``geojson``.
        description: one line.
        suffix: of files, with the dot.
        write: (drawing, title) to a file's content; the same drawing gives the same bytes.
        losses: what of a drawing the format cannot express, one message each.
        heights: what heights in the format are measured from, most usual first; a drawing gets the first of
            them that is known of its mission. Where none is, its heights are above the home position.
    """

    name: str
    description: str
    suffix: str
    write: Callable[[Drawing, str], bytes]
    losses: Callable[[Drawing], tuple[str, ...]] = _nothing_lost
    heights: tuple[HeightReference, ...] = ()
