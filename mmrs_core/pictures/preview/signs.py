"""The symbols that a picture shows, for its key."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.preview.map_places import BADGE, badge
from mmrs_core.pictures.preview.markup import element
from mmrs_core.pictures.preview.picture import Picture

_HEIGHT = 2 * BADGE + 3


def symbols_in(picture: Picture) -> tuple[MapSymbol, ...]:
    """Return the symbols of the tasks and things that have a place, each once, tasks' first."""
    return tuple(dict.fromkeys(_symbols(picture)))


def _symbols(picture: Picture) -> Iterator[MapSymbol]:
    for task in picture.tasks:
        if task.rings or task.line or task.point is not None:
            yield task.symbol
    for thing in picture.things:
        if thing.points:
            yield thing.symbol


def sign(symbol: MapSymbol) -> str:
    """Return a symbol's sign as a small picture of its own, as wide as the other samples of the key."""
    size = {"class": "sign", "width": 34, "height": _HEIGHT, "viewBox": f"0 0 34 {_HEIGHT:g}"}
    return element("svg", size, badge(symbol, (17.0, _HEIGHT / 2)))
