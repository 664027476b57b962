"""Draws what every map has: grid, scale bar, north arrow, patterns."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.pictures.preview.markup import element, number, text
from mmrs_core.pictures.preview.projection import Projection


def grid(projection: Projection) -> Iterator[str]:
    """Yield the lines of a grid half as wide as the scale bar."""
    step = projection.bar_length() / 2
    first, last = int(projection.west // step) + 1, int(projection.east // step)
    lower, upper = int(projection.south // step) + 1, int(projection.north // step)
    columns = (((i * step, projection.south), (i * step, projection.north)) for i in range(first, last + 1))
    rows = (((projection.west, i * step), (projection.east, i * step)) for i in range(lower, upper + 1))
    for ends in (*columns, *rows):
        yield element("path", {"d": f"M{projection.line(ends)}"})


def furniture_places(projection: Projection) -> tuple[tuple[float, float, float, float], ...]:
    """Return what scale bar and north arrow cover: left, top, right, bottom in pixels."""
    width = projection.bar_length() * projection.scale
    bottom = projection.height
    return (10.0, bottom - 42, 26.0 + width, bottom), (projection.width - 44, 6.0, projection.width - 8, 62.0)


def furniture(projection: Projection) -> Iterator[str]:
    """Yield scale bar and north arrow."""
    metres = projection.bar_length()
    pixels = metres * projection.scale
    x, y = 18.0, projection.height - 18
    bar = f"M{number(x)} {number(y - 6)}v6h{number(pixels)}v-6"
    yield element("path", {"class": "scale", "d": bar})
    words = {"class": "label scale-words", "x": x + pixels / 2, "y": y - 8, "text_anchor": "middle"}
    yield element("text", words, text(f"{metres:g} m"))
    north = f"translate({number(projection.width - 26)} 34)"
    yield element(
        "g",
        {"class": "north", "transform": north},
        element("path", {"d": "M0-22L8 6L0 1L-8 6Z"}),
        element("text", {"class": "label", "y": 20, "text_anchor": "middle"}, "N"),
    )


def patterns() -> str:
    """Return the patterns that areas are filled with."""
    line = element("path", {"d": "M0 0V8", "stroke": "#b2182b", "stroke-width": 2})
    cross = element("path", {"d": "M0 5H10M5 0V10", "stroke": "#1b7837", "stroke-width": 1})
    common = {"patternUnits": "userSpaceOnUse"}
    return element(
        "defs",
        None,
        element(
            "pattern",
            {"id": "forbidden", "width": 8, "height": 8, "patternTransform": "rotate(45)", **common},
            line,
        ),
        element("pattern", {"id": "emergency", "width": 10, "height": 10, **common}, cross),
    )
