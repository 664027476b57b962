"""Explains the signs of the map, for a picture that stands by itself."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.pictures.preview.labels import shortened, width_of
from mmrs_core.pictures.preview.map_places import badge
from mmrs_core.pictures.preview.markup import element, number, text
from mmrs_core.pictures.preview.palette import style_of
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.pictures.preview.projection import Projection
from mmrs_core.pictures.preview.signs import symbols_in

_ROW = 24.0
_SAMPLE = 34.0
_GAP = 22.0
_MARGIN = 18.0

Entry = tuple[str, str]


def legend_height(picture: Picture, projection: Projection) -> float:
    """Return how many pixels the legend needs beneath the map."""
    return _MARGIN + _ROW * len(list(_rows(picture, projection.width)))


def legend_markup(picture: Picture, projection: Projection) -> str:
    """Return the legend, placed right beneath the map."""
    top = projection.height
    height = legend_height(picture, projection)
    sheet = {"class": "sheet", "x": 0, "y": top, "width": projection.width, "height": height}
    rows = _rows(picture, projection.width)
    placed = ("".join(_placed(row, top + _MARGIN / 2 + (i + 0.5) * _ROW)) for i, row in enumerate(rows))
    return element("g", {"class": "legend"}, element("rect", sheet), placed)


def _rows(picture: Picture, width: float) -> Iterator[list[Entry]]:
    row: list[Entry] = []
    used = _MARGIN
    for entry in (*_robots(picture), *_signs(), *_symbols(picture)):
        needed = _SAMPLE + 8 + width_of(entry[1]) + _GAP
        if row and used + needed > width:
            yield row
            row, used = [], _MARGIN
        row.append(entry)
        used += needed
    yield row


def _placed(row: list[Entry], y: float) -> Iterator[str]:
    x = _MARGIN
    for sample, words in row:
        yield element("g", {"transform": f"translate({number(x)} {number(y)})"}, sample)
        yield element("text", {"class": "label", "x": x + _SAMPLE + 8, "y": y + 4}, text(words))
        x += _SAMPLE + 8 + width_of(words) + _GAP


def _robots(picture: Picture) -> Iterator[Entry]:
    for index, robot in enumerate(picture.robots):
        style = style_of(index)
        line = {"d": "M0 0H34", "stroke": style.colour, "stroke-width": 3, "fill": "none"}
        yield element("path", {**line, "stroke-dasharray": style.dashes or None}), shortened(robot.name)


def _signs() -> Iterator[Entry]:
    yield element("path", {"class": "leg work", "d": "M0 0H34", "stroke": "#333"}), "doing a task"
    yield element("path", {"class": "leg transit", "d": "M0 0H34", "stroke": "#333"}), "on the way"
    yield element("path", {"class": "zone forbidden", "d": "M0-7H34V7H0Z"}), "forbidden area"
    yield element("path", {"class": "zone obstacle", "d": "M0-7H34V7H0Z"}), "obstacle"
    yield element("path", {"class": "kept obstacle", "d": "M0-7H34V7H0Z"}), "kept clear"
    yield element("path", {"class": "zone emergency", "d": "M0-7H34V7H0Z"}), "emergency area"
    yield element("path", {"class": "home", "d": "M10 7v-8l7-6l7 6v8Z", "fill": "#333"}), "home"
    yield element("circle", {"class": "stay", "cx": 17, "r": 5.5, "stroke": "#333"}), "stays"


def _symbols(picture: Picture) -> Iterator[Entry]:
    for symbol in symbols_in(picture):
        yield badge(symbol, (17.0, 0.0)), shortened(symbol.label)
