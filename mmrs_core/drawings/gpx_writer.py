"""GPX 1.1 (https://www.topografix.com/gpx.asp), as receivers and map programs read it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

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
    DEGREES,
    METRES,
    REFERENCE,
    ROLE,
    above,
    decimal_texts,
    extras_of,
    lost,
    property_text,
    time_texts,
)
from mmrs_core.drawings.gpx import AREA, KINDS
from mmrs_core.drawings.xml_text import XML, tagged

_ROOT = """<gpx version="1.1" creator="MMRS" xmlns="http://www.topografix.com/GPX/1/1" \
xmlns:mmrs="urn:mmrs:drawing:1.0">"""


def write(drawing: Drawing, title: str) -> bytes:
    """Return a drawing as GPX 1.1; an area is a closed track with a segment for each ring."""
    lines: dict[str, list[str]] = {tag: [] for tag in KINDS}
    for feature in drawing.features:
        tag = _tag_of(feature)
        lines[tag] += _lines(feature, tag)
    head = f"<metadata>{tagged('name', printable(title))}</metadata>"
    return "\n".join([XML, _ROOT, head, *chain(*lines.values()), "</gpx>\n"]).encode()


def _tag_of(feature: MapFeature) -> str:
    if feature.geometry is Geometry.POINT:
        return "wpt"
    return "rte" if feature.geometry is Geometry.LINE and feature.times is None else "trk"


def _lines(feature: MapFeature, tag: str) -> Iterator[str]:
    if tag == "wpt":
        yield from _points(feature, 0, tag)
        yield from _described(feature, tag)
    else:
        yield f"<{tag}>"
        yield from _described(feature, tag)
        segment = tag == "trk"
        for number in range(len(feature.rings)):
            points = [f"{point}</{tag}pt>" for point in _points(feature, number, f"{tag}pt")]
            yield from ["<trkseg>"] * segment
            yield from points
            yield from points[:1] if feature.geometry is Geometry.AREA else ()
            yield from ["</trkseg>"] * segment
    yield f"</{tag}>"


def _points(feature: MapFeature, number: int, tag: str) -> Iterator[str]:
    """Yield the positions of a ring as elements that are not closed yet."""
    latitudes, longitudes = (decimal_texts(column, DEGREES) for column in feature.rings[number].T)
    heights = decimal_texts(feature.heights[number], METRES) if feature.heights else ()
    times = time_texts(feature.times) if feature.times is not None and number == 0 else ()
    for at, (latitude, longitude) in enumerate(zip(latitudes, longitudes, strict=True)):
        ele = f"<ele>{heights[at]}</ele>" if heights else ""
        time = f"<time>{times[at]}</time>" if times else ""
        # GPX has no 180 degrees east
        yield f'<{tag} lat="{latitude}" lon="{"-180" if longitude == "180" else longitude}">{ele}{time}'


def _described(feature: MapFeature, tag: str) -> Iterator[str]:
    if feature.name:
        yield tagged("name", feature.name)
    if feature.description:
        yield tagged("desc", feature.description)
    is_area = feature.geometry is Geometry.AREA
    native = (REFERENCE,) if feature.reference is HeightReference.SEA_LEVEL else ()
    data: dict[str, Property] = {**feature.properties, **extras_of(feature, native)}
    if feature.role is (Role.UNKNOWN if is_area else KINDS[tag]):
        data.pop(ROLE, None)
    elif not feature.role:
        data[ROLE] = ""
    if is_area:
        data[AREA] = True
    if data:
        yield "<extensions>"
        for key, value in data.items():
            yield tagged("mmrs:property", property_text(value), name=key)
        yield "</extensions>"


def losses(drawing: Drawing) -> tuple[str, ...]:
    """Return what GPX cannot hold, or what other programs read otherwise."""
    references = (HeightReference.GROUND, HeightReference.HOME, HeightReference.ELLIPSOID)
    taken = {
        f"heights above {each.value}: taken for heights above mean sea level": above(each)
        for each in references
    }
    return lost(
        drawing,
        {
            **taken,
            "areas: written as closed tracks": lambda each: each.geometry is Geometry.AREA,
            "circles: drawn as points": lambda each: each.radius is not None,
            "times since the start: written as times on 1970-01-01": lambda each: (
                each.since_start and each.times is not None
            ),
        },
    )
