"""Rings and polygons that bound an area."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import shapely
from shapely.geometry import LinearRing, MultiPoint, Polygon

from mmrs_core.analysis.constraints.findings import CONTEXT, MISSION, finding
from mmrs_core.analysis.constraints.sketch import polygon_of, sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import children
from mmrs_core.languages.element import Element, path_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Ring

TOUCH = 1e-6
"""Square metres up to which two shapes only touch, or a ring bounds nothing."""


def _crossing(feature: str) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    def check(element: Element, models: ModelSet) -> Iterator[Finding]:
        ring = sketch_of(models).ring(element, feature)
        if ring is not None and not _is_flat(ring) and not LinearRing(ring).is_simple:
            place = _first_crossing(ring)
            yield finding(element, f"its border crosses or touches itself{place}")

    return check


def _flat(feature: str) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    def check(element: Element, models: ModelSet) -> Iterator[Finding]:
        ring = sketch_of(models).ring(element, feature)
        if ring is not None and _is_flat(ring):
            yield finding(
                element, f"its border holds no area: {len(ring)} different vertices, all on one line"
            )

    return check


def _repeating(feature: str) -> Callable[[Element, ModelSet], Iterator[Finding]]:
    def check(element: Element, models: ModelSet) -> Iterator[Finding]:
        ring, corners = sketch_of(models).ring(element, feature), children(element, feature)
        if ring is not None and len(ring) < len(corners):
            yield finding(
                element, f"its border repeats {len(corners) - len(ring)} of its {len(corners)} vertices"
            )

    return check


def _is_flat(ring: Ring) -> bool:
    return len(ring) < 3 or MultiPoint(ring).convex_hull.area <= TOUCH


def _first_crossing(ring: Ring) -> str:
    """Return which two sides meet first, in words; empty if only neighbours overlap."""
    sides = [shapely.LineString(pair) for pair in zip(ring, (*ring[1:], ring[0]), strict=True)]
    pairs = shapely.STRtree(sides).query(sides, predicate="intersects").T.tolist()
    apart = sorted((one, other) for one, other in pairs if 1 < other - one < len(sides) - 1)
    return ": the sides from vertices {} and {} meet".format(*apart[0]) if apart else ""


def _holes(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    shell = _polygon(sketch.ring(task, "shell"))
    for hole in children(task, "holes"):
        shape = _polygon(sketch.ring(hole, "points"))
        if shell is not None and shape is not None and shape.difference(shell).area > TOUCH:
            part = "lies" if shape.intersection(shell).area <= TOUCH else "lies in part"
            yield finding(hole, f"{part} outside the shell")


def _overlapping(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    drawn: list[tuple[Element, Polygon]] = []
    for hole in children(task, "holes"):
        shape = _polygon(sketch.ring(hole, "points"))
        if shape is None:
            continue
        other = next((each for each, area in drawn if shape.intersection(area).area > TOUCH), None)
        if other is not None:
            yield finding(hole, f"overlaps {path_of(other)}")
        drawn.append((hole, shape))


def _nothing_left(task: Element, models: ModelSet) -> Iterator[Finding]:
    sketch = sketch_of(models)
    shell = _polygon(sketch.ring(task, "shell"))
    rings = (sketch.ring(hole, "points") for hole in children(task, "holes"))
    holes = [shape for shape in map(_polygon, rings) if shape is not None]
    if shell is not None and holes and shell.difference(shapely.union_all(holes)).area <= TOUCH:
        yield finding(task, "its holes leave nothing of the area")


def _polygon(ring: Ring | None) -> Polygon | None:
    return polygon_of(ring) if ring is not None else None


_UNCROSS = "put the vertices in the order in which one meets them along the border"
_SPREAD = "draw at least three vertices that are not on one line"
_ONCE = "rings close implicitly: remove duplicate vertices"

CONSTRAINTS = (
    Constraint(
        "MML070",
        "The shell of an area task does not cross itself.",
        (MISSION, "PolygonTask"),
        _crossing("shell"),
        _UNCROSS,
    ),
    Constraint(
        "MML071",
        "The shell of an area task bounds an area.",
        (MISSION, "PolygonTask"),
        _flat("shell"),
        _SPREAD,
    ),
    Constraint(
        "MML072",
        "The shell of an area task has each vertex once.",
        (MISSION, "PolygonTask"),
        _repeating("shell"),
        _ONCE,
        Severity.WARNING,
    ),
    Constraint("MML073", "A hole does not cross itself.", (MISSION, "Ring"), _crossing("points"), _UNCROSS),
    Constraint("MML074", "A hole bounds an area.", (MISSION, "Ring"), _flat("points"), _SPREAD),
    Constraint(
        "MML075",
        "Holes lie inside the shell.",
        (MISSION, "PolygonTask"),
        _holes,
        "move the hole into the shell, or draw the shell without it",
    ),
    Constraint(
        "MML076",
        "Holes do not overlap.",
        (MISSION, "PolygonTask"),
        _overlapping,
        "draw one hole around both",
        Severity.WARNING,
    ),
    Constraint(
        "MML077",
        "Holes leave something to be done.",
        (MISSION, "PolygonTask"),
        _nothing_left,
        "make the holes smaller, or remove the task",
    ),
    Constraint(
        "CTX003",
        "The shell of an area does not cross itself.",
        (CONTEXT, "Area"),
        _crossing("shell"),
        _UNCROSS,
    ),
    Constraint("CTX004", "The shell of an area bounds an area.", (CONTEXT, "Area"), _flat("shell"), _SPREAD),
    Constraint(
        "CTX006",
        "The shell of an area has each vertex once.",
        (CONTEXT, "Area"),
        _repeating("shell"),
        _ONCE,
        Severity.WARNING,
    ),
)
