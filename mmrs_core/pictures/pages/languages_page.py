"""The page about the languages: every class and feature, with a diagram of each language."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package
from mmrs_core.languages.registry import Registry
from mmrs_core.pictures.pages.diagram import diagram, multiplicity, own_features, type_name

PAGE = "languages.md"
DIAGRAMS = "diagrams"

_INTRODUCTION = (
    "This page is made from the metamodels by `mmrs metamodel docs`; do not edit it.",
    "In the diagrams, a hollow triangle stands at the class that is inherited from, a filled diamond at "
    "the class that holds the other; names of abstract classes are slanted, classes of other languages "
    "are grey. An arrow before a type means a reference to an element that is held elsewhere. "
    "Multiplicities are written as in UML: `1` exactly one, `0..1` at most one, `0..*` any number, "
    "`1..*` at least one.",
)


def pages(registry: Registry) -> dict[str, str]:
    """Return the contents by path below the documentation's folder."""
    drawings = {f"{DIAGRAMS}/{package.name}.svg": diagram(package) + "\n" for package in registry.packages}
    return {PAGE: "\n".join(_page(registry)) + "\n"} | drawings


def _page(registry: Registry) -> Iterator[str]:
    yield "# The languages\n"
    for paragraph in _INTRODUCTION:
        yield f"{paragraph}\n"
    for package in registry.packages:
        yield f"- [{package.name}](#{package.name}), `{package.ns_uri}`: {_cell(package.documentation)}"
    for package in registry.packages:
        yield ""
        yield from _language(package)


def _language(package: Package) -> Iterator[str]:
    yield f"## {package.name}\n"
    yield f"`{package.ns_uri}`. {_cell(package.documentation)}\n"
    yield f"![Classes of {package.name}]({DIAGRAMS}/{package.name}.svg)\n"
    for metaclass in package.metaclasses:
        yield from _class(metaclass, package)
    for enumeration in package.enumerations:
        yield from _enumeration(enumeration, package)


def _class(metaclass: Metaclass, package: Package) -> Iterator[str]:
    yield f"### {package.name}.{metaclass.name}\n"
    parents = ", ".join(f"`{_full(parent, package)}`" for parent in metaclass.supertypes)
    kind = "Abstract. " if metaclass.abstract else ""
    extends = f" Extends {parents}." if parents else ""
    yield f"{kind}{_cell(metaclass.documentation)}{extends}\n"
    features = own_features(metaclass)
    if features:
        yield "| feature | type | multiplicity | default | meaning |"
        yield "| --- | --- | --- | --- | --- |"
        yield from (_row(feature, package) for feature in features)
        yield ""


def _full(metaclass: Metaclass, package: Package) -> str:
    return metaclass.name if metaclass.ns_uri == package.ns_uri else f"{metaclass.ns_uri}#{metaclass.name}"


def _row(feature: Feature, package: Package) -> str:
    held = "" if not feature.is_reference else ("holds " if feature.containment else "refers to ")
    default = "" if feature.default is None or feature.many else f"`{_default(feature.default)}`"
    cells = (
        f"`{feature.name}`",
        f"{held}{type_name(feature, package)}",
        multiplicity(feature),
        default,
        _cell(feature.documentation),
    )
    return f"| {' | '.join(cells)} |"


def _default(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _enumeration(enumeration: Enumeration, package: Package) -> Iterator[str]:
    yield f"### {package.name}.{enumeration.name}\n"
    yield f"Enumeration. {_cell(enumeration.documentation)}\n"
    yield "| literal | meaning |"
    yield "| --- | --- |"
    yield from (f"| `{each.name}` | {_cell(each.documentation)} |" for each in enumeration.literals)
    yield ""


def _cell(words: str) -> str:
    """Return words as they may stand in a table of Markdown."""
    one_line = " ".join(words.split())
    return one_line.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")
