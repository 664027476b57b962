"""Borders as they were drawn: vertices that repeat, and borders that hold no area."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.grounding.features import number
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.drafts import placed
from mmrs_flyaq.building.shapes import Corner, border_of
from mmrs_flyaq.findings import Category
from mmrs_flyaq.recording import Record
from mmrs_flyaq.sources.nodes import SourceNode, Text


def without_repeats(vertices: Sequence[SourceNode], record: Record) -> tuple[SourceNode, ...]:
    """Return vertices without those that equal the one before; the first follows the last."""
    kept: list[SourceNode] = []
    left_out: list[SourceNode] = []
    for vertex in vertices:
        repeats = bool(kept) and _values(vertex) == _values(kept[-1])
        (left_out if repeats else kept).append(vertex)
    if len(kept) > 1 and _values(kept[0]) == _values(kept[-1]):
        left_out.append(kept.pop())
    for vertex in left_out:
        record.item(Category.CHANGED, "repeats the vertex beside it, so it is left out", vertex)
    return tuple(kept)


def _values(vertex: SourceNode) -> tuple[str, dict[str, tuple[str, ...]]]:
    return vertex.kind, {feature: vertex.texts(feature) for feature in vertex.values}


def _place(vertex: Element) -> Corner | None:
    """Return latitude and longitude in degrees; None where they are missing or not on the Earth."""
    north, east = number(vertex, "latitude"), number(vertex, "longitude")
    if north is None or east is None or not (abs(north) <= 90 and abs(east) <= 180):
        return None
    return north, east


def border_around(
    node: SourceNode,
    feature: str,
    vertices: Sequence[Element],
    metres: float,
    registry: Registry,
    record: Record,
) -> Sequence[Element]:
    """Return the vertices of a border; for one that bounds no area, those of a border that holds them all.

    A border with a vertex that has no place on the Earth stays as it is.
    """
    known = tuple(place for each in vertices if (place := _place(each)) is not None)
    mended = border_of(known, metres) if known and len(known) == len(vertices) else None
    if mended is None:
        return vertices
    key = metaclass_of(vertices[0]).key
    places = ", ".join(f"({north!r}, {east!r})" for north, east in known)
    record.value(Category.DOUBTFUL, f"{mended.reason}: draw it again", node, feature, Text(places, node.line))
    return [
        placed(registry.create(*key, latitude=north, longitude=east), node) for north, east in mended.corners
    ]
