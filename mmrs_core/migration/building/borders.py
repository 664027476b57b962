"""Borders as they were drawn: vertices that repeat, and borders that hold no area."""

from __future__ import annotations

from collections.abc import Sequence

from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.grounding.values import number
from mmrs_core.languages.registry import Registry
from mmrs_core.migration.building.shapes import Corner, widened
from mmrs_core.migration.findings import Category
from mmrs_core.migration.recording import Record
from mmrs_core.migration.sources.nodes import SourceNode, Text


def without_repeats(
    node: SourceNode, feature: str, vertices: Sequence[SourceNode], record: Record
) -> tuple[SourceNode, ...]:
    """Return vertices without those that equal the one before; the first follows the last."""
    kept: list[SourceNode] = []
    for vertex in vertices:
        if not kept or _values(vertex) != _values(kept[-1]):
            kept.append(vertex)
    if len(kept) > 1 and _values(kept[0]) == _values(kept[-1]):
        kept.pop()
    if len(kept) < len(vertices):
        left_out = Text(f"{len(vertices) - len(kept)} of {len(vertices)}", node.line)
        reason = "vertices that repeat the one before are left out"
        record.value(Category.CHANGED, reason, node, feature, left_out)
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
    """Return the vertices of a border; for one that holds no area, those of a border around it."""
    known = tuple(place for each in vertices if (place := _place(each)) is not None)
    ring = widened(known, metres) if known else None
    if ring is None:
        return vertices
    key = metaclass_of(vertices[0]).key
    reason = f"the border holds no area, so it is drawn {metres:g} m around its vertices: draw it anew"
    record.value(Category.DOUBTFUL, reason, node, feature, Text(f"of {len(known)} vertices", node.line))
    return [registry.create(*key, latitude=north, longitude=east) for north, east in ring]
