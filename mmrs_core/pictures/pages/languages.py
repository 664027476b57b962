"""Makes the page about the languages: every class and feature, with a diagram of each language."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from markupsafe import Markup

from mmrs_core.languages.metaclass import Feature, Metaclass, Package
from mmrs_core.languages.registry import Registry
from mmrs_core.pictures.documents import number, render, style_sheets
from mmrs_core.pictures.pages.layout import Box, Placed, layout

_ROW = 17.0
_TITLE = 24.0
_LETTER = 6.7
_TITLE_LETTER = 7.9
_MARGIN = 20.0

PAGE = "languages.md"
DIAGRAMS = "diagrams"

ClassKey = tuple[str, str]


@dataclass(frozen=True, slots=True)
class _Link:
    """A line of the diagram: inheritance (no feature), or containment by a feature."""

    start: ClassKey
    end: ClassKey
    feature: Feature | None = None


def pages(registry: Registry) -> dict[str, str]:
    """Return the contents by path below the documentation's folder."""
    drawings = {f"{DIAGRAMS}/{package.name}.svg": _diagram(package) + "\n" for package in registry.packages}
    page = render(
        PAGE, packages=registry.packages, diagrams=DIAGRAMS, cell=_cell, features=_features, extends=_extends
    )
    return {PAGE: str(page)} | drawings


def _extends(metaclass: Metaclass, package: Package) -> str:
    parents = (
        parent.name if parent.ns_uri == package.ns_uri else f"{parent.ns_uri}#{parent.name}"
        for parent in metaclass.supertypes
    )
    names = ", ".join(f"`{name}`" for name in parents)
    return f" Extends {names}." if names else ""


def _features(metaclass: Metaclass, package: Package) -> list[tuple[str, ...]]:
    """Return the cells of the row of each feature that a class does not inherit."""
    return [_cells(feature, package) for feature in _own_features(metaclass)]


def _cells(feature: Feature, package: Package) -> tuple[str, ...]:
    held = "" if not feature.is_reference else ("holds " if feature.containment else "refers to ")
    return (
        f"`{feature.name}`",
        f"{held}{_type_name(feature, package)}",
        _multiplicity(feature),
        "" if feature.default is None or feature.many else f"`{_default(feature.default)}`",
        _cell(feature.documentation),
    )


def _default(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _cell(words: str) -> str:
    """Return words as they may stand in a table of Markdown."""
    one_line = " ".join(words.split())
    return one_line.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")


def _diagram(package: Package) -> Markup:
    """Return a class diagram of a language, left to right, as one ``svg`` element.

    Superclasses in other languages are drawn in grey.
    """
    classes = {metaclass.key: metaclass for metaclass in (*package.metaclasses, *_foreign(package))}
    links = list(_links(package, classes))
    boxes = {key: _box(metaclass, package) for key, metaclass in classes.items()}
    placed = layout(tuple(boxes.values()), [(boxes[link.start].name, boxes[link.end].name) for link in links])
    return render(
        "diagram.svg",
        name=package.name,
        sheet=style_sheets("diagram", standalone=True),
        margin=_MARGIN,
        title_height=_TITLE,
        row_height=_ROW,
        width=placed.width + 2 * _MARGIN,
        height=placed.height + 2 * _MARGIN,
        lines=[
            ("contains" if link.feature is not None else "inherits", _line(i, link, placed, classes, boxes))
            for i, link in enumerate(links)
            if link.start != link.end
        ],
        classes=[
            (
                _kind(each, package),
                _title(each, package),
                _rows(each, package),
                box,
                *placed.corners[box.name],
                each.documentation,
            )
            for each, box in ((each, boxes[key]) for key, each in classes.items())
        ],
    )


def _own_features(metaclass: Metaclass) -> tuple[Feature, ...]:
    """Return the features that a class itself declares."""
    return tuple(feature for feature in metaclass.features if feature.owner is metaclass)


def _multiplicity(feature: Feature) -> str:
    """Return how many values a feature has, as UML writes it.

    An upper bound of -1 is written as a star, and equal bounds once.
    """
    upper = "*" if feature.most < 0 else str(feature.most)
    return upper if upper == str(feature.lower) else f"{feature.lower}..{upper}"


def _type_name(feature: Feature, package: Package) -> str:
    """Return the name of a feature's type, with its language if that is another one."""
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


def _links(package: Package, classes: Mapping[ClassKey, Metaclass]) -> Iterator[_Link]:
    for metaclass in package.metaclasses:
        for parent in metaclass.supertypes:
            yield _Link(parent.key, metaclass.key)
        for feature in _own_features(metaclass):
            if feature.containment and isinstance(feature.type, Metaclass) and feature.type.key in classes:
                yield _Link(metaclass.key, feature.type.key, feature)


def _rows(metaclass: Metaclass, package: Package) -> list[str]:
    if metaclass.ns_uri != package.ns_uri:
        return []
    return [_row(feature, package) for feature in _own_features(metaclass)]


def _row(feature: Feature, package: Package) -> str:
    arrow = "→ " if feature.is_reference and not feature.containment else ""
    return f"{feature.name}: {arrow}{_type_name(feature, package)} [{_multiplicity(feature)}]"


def _title(metaclass: Metaclass, package: Package) -> str:
    foreign = metaclass.ns_uri != package.ns_uri
    return f"{_language(metaclass.ns_uri)}.{metaclass.name}" if foreign else metaclass.name


def _box(metaclass: Metaclass, package: Package) -> Box:
    rows = _rows(metaclass, package)
    width = max([len(_title(metaclass, package)) * _TITLE_LETTER, *(len(row) * _LETTER for row in rows)]) + 20
    return Box("#".join(metaclass.key), width, _TITLE + len(rows) * _ROW + (6 if rows else 0))


def _kind(metaclass: Metaclass, package: Package) -> str:
    """Return the classes of a metaclass in the style sheet."""
    foreign = " foreign" if metaclass.ns_uri != package.ns_uri else ""
    return f"class{foreign}{' abstract' if metaclass.abstract else ''}"


def _line(
    index: int,
    link: _Link,
    placed: Placed,
    classes: Mapping[ClassKey, Metaclass],
    boxes: Mapping[ClassKey, Box],
) -> str:
    """Return the data of a path from one class to the other."""
    box, target = boxes[link.start], boxes[link.end]
    x, y = placed.corners[box.name]
    to_x, to_y = placed.corners[target.name]
    row = _TITLE / 2
    if link.feature is not None:
        row = _TITLE + 11 + _own_features(classes[link.start]).index(link.feature) * _ROW
    points = [(placed.rights[box.name], y + row), *placed.ways.get(index, ()), (to_x, to_y + _TITLE / 2)]
    return f"M{number(x + box.width)} {number(y + row)}H{number(points[0][0])}{_curve(points)}"


def _curve(points: Sequence[tuple[float, float]]) -> str:
    drawn = []
    for (x1, y1), (x2, y2) in pairwise(points):
        bend = max((x2 - x1) / 2, 24.0)
        drawn.append(
            f"C{number(x1 + bend)} {number(y1)} {number(x2 - bend)} {number(y2)} {number(x2)} {number(y2)}"
        )
    return "".join(drawn)
