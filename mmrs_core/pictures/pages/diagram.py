"""Draws a language: its classes, what they inherit from and what they hold, as SVG."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mmrs_core.languages.metaclass import Feature, Metaclass, Package
from mmrs_core.pictures.pages.layout import Box, Placed, layout
from mmrs_core.pictures.preview.markup import element, number, style_sheet, text

_ROW = 17.0
_TITLE = 24.0
_LETTER = 6.7
_TITLE_LETTER = 7.9
_MARGIN = 20.0

ClassKey = tuple[str, str]


@dataclass(frozen=True, slots=True)
class _Link:
    """A line of the diagram: inheritance (no feature), or containment by a feature."""

    start: ClassKey
    end: ClassKey
    feature: Feature | None = None


def diagram(package: Package) -> str:
    """Return a class diagram of a language, left to right, as one ``svg`` element.

    Classes of other languages are drawn in grey where classes of this one inherit from them.
    """
    classes = {metaclass.key: metaclass for metaclass in (*package.metaclasses, *_foreign(package))}
    links = list(_links(package, classes))
    boxes = [_box(metaclass, package) for metaclass in classes.values()]
    placed = layout(boxes, [("#".join(link.start), "#".join(link.end)) for link in links])
    lines = (_line(i, link, placed, classes, package) for i, link in enumerate(links))
    drawn = (_class(metaclass, placed, package) for metaclass in classes.values())
    width, height = placed.width + 2 * _MARGIN, placed.height + 2 * _MARGIN
    view = {"viewBox": f"0 0 {number(width)} {number(height)}", "width": width, "height": height}
    return element(
        "svg",
        {"xmlns": "http://www.w3.org/2000/svg", "class": "diagram", "role": "img", **view},
        element("title", None, text(f"classes of {package.name}")),
        element("style", None, style_sheet("diagram.css", "mmrs_core.pictures.pages")),
        _defs(),
        element("rect", {"class": "sheet", "width": width, "height": height}),
        element("g", {"transform": f"translate({number(_MARGIN)} {number(_MARGIN)})"}, lines, drawn),
    )


def own_features(metaclass: Metaclass) -> tuple[Feature, ...]:
    """Return the features that a class itself declares."""
    return tuple(feature for feature in metaclass.features if feature.owner is metaclass)


def multiplicity(feature: Feature) -> str:
    """Return how many values a feature has, as UML writes it.

    An upper bound of -1 is written as a star, and equal bounds once.
    """
    upper = "*" if feature.most < 0 else str(feature.most)
    return upper if upper == str(feature.lower) else f"{feature.lower}..{upper}"


def type_name(feature: Feature, package: Package) -> str:
    """Return the name of a feature's type, with its language where that is another one."""
    found = feature.type
    name = found.name
    if name.startswith("E") and not isinstance(found, Metaclass):
        return {"EString": "text", "EDouble": "real", "EInt": "integer", "EBoolean": "boolean"}.get(
            name, name
        )
    same = getattr(found, "ns_uri", package.ns_uri) == package.ns_uri
    return name if same else f"{_language(found.ns_uri)}.{name}"


def _language(ns_uri: str) -> str:
    parts = ns_uri.split(":")
    return parts[2] if len(parts) > 2 else ns_uri


def _foreign(package: Package) -> Iterator[Metaclass]:
    known = {metaclass.key for metaclass in package.metaclasses}
    found = {
        parent.key: parent
        for metaclass in package.metaclasses
        for parent in metaclass.supertypes
        if parent.key not in known
    }
    yield from found.values()


def _links(package: Package, classes: dict[ClassKey, Metaclass]) -> Iterator[_Link]:
    for metaclass in package.metaclasses:
        for parent in metaclass.supertypes:
            yield _Link(parent.key, metaclass.key)
        for feature in own_features(metaclass):
            if feature.containment and isinstance(feature.type, Metaclass) and feature.type.key in classes:
                yield _Link(metaclass.key, feature.type.key, feature)


def _rows(metaclass: Metaclass, package: Package) -> list[str]:
    if metaclass.ns_uri != package.ns_uri:
        return []
    return [_row(feature, package) for feature in own_features(metaclass)]


def _row(feature: Feature, package: Package) -> str:
    arrow = "→ " if feature.is_reference and not feature.containment else ""
    return f"{feature.name}: {arrow}{type_name(feature, package)} [{multiplicity(feature)}]"


def _title(metaclass: Metaclass, package: Package) -> str:
    foreign = metaclass.ns_uri != package.ns_uri
    return f"{_language(metaclass.ns_uri)}.{metaclass.name}" if foreign else metaclass.name


def _box(metaclass: Metaclass, package: Package) -> Box:
    rows = _rows(metaclass, package)
    width = max([len(_title(metaclass, package)) * _TITLE_LETTER, *(len(row) * _LETTER for row in rows)]) + 20
    return Box("#".join(metaclass.key), width, _TITLE + len(rows) * _ROW + (6 if rows else 0))


def _class(metaclass: Metaclass, placed: Placed, package: Package) -> str:
    box = _box(metaclass, package)
    x, y = placed.corners[box.name]
    foreign = metaclass.ns_uri != package.ns_uri
    kind = "class" + (" foreign" if foreign else "") + (" abstract" if metaclass.abstract else "")
    frame = {"x": x, "y": y, "width": box.width, "height": box.height, "rx": 3}
    title = {"class": "title", "x": x + box.width / 2, "y": y + 16, "text_anchor": "middle"}
    rows = _rows(metaclass, package)
    rule = element("line", {"x1": x, "x2": x + box.width, "y1": y + _TITLE, "y2": y + _TITLE}) if rows else ""
    return element(
        "g",
        {"class": kind},
        element("title", None, text(metaclass.documentation)) if metaclass.documentation else "",
        element("rect", frame),
        element("text", title, text(_title(metaclass, package))),
        rule,
        (
            element("text", {"x": x + 9, "y": y + _TITLE + 15 + i * _ROW}, text(row))
            for i, row in enumerate(rows)
        ),
    )


def _line(
    index: int, link: _Link, placed: Placed, classes: dict[ClassKey, Metaclass], package: Package
) -> str:
    start, end = classes[link.start], classes[link.end]
    if link.start == link.end:
        return ""
    box, target = _box(start, package), _box(end, package)
    x, y = placed.corners[box.name]
    to_x, to_y = placed.corners[target.name]
    row = _TITLE / 2
    if link.feature is not None:
        row = _TITLE + 11 + own_features(start).index(link.feature) * _ROW
    points = [(placed.rights[box.name], y + row), *placed.ways.get(index, ()), (to_x, to_y + _TITLE / 2)]
    kind = "contains" if link.feature is not None else "inherits"
    way = f"M{number(x + box.width)} {number(y + row)}H{number(points[0][0])}{_curve(points)}"
    return element("path", {"class": kind, "d": way, "marker-start": f"url(#{kind})"})


def _curve(points: Sequence[tuple[float, float]]) -> str:
    drawn = []
    for (x1, y1), (x2, y2) in pairwise(points):
        bend = max((x2 - x1) / 2, 24.0)
        drawn.append(
            f"C{number(x1 + bend)} {number(y1)} {number(x2 - bend)} {number(y2)} {number(x2)} {number(y2)}"
        )
    return "".join(drawn)


def _defs() -> str:
    triangle = element("path", {"class": "head", "d": "M1 6L13 1V11Z"})
    diamond = element("path", {"class": "diamond", "d": "M1 5L8 1L15 5L8 9Z"})
    common = {"orient": "auto", "markerUnits": "userSpaceOnUse"}
    inherits = {"id": "inherits", "markerWidth": 14, "markerHeight": 12, "refX": 1, "refY": 6, **common}
    contains = {"id": "contains", "markerWidth": 16, "markerHeight": 10, "refX": 1, "refY": 5, **common}
    return element("defs", None, element("marker", inherits, triangle), element("marker", contains, diamond))
