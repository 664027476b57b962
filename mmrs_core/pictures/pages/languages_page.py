"""The page about the languages: every class and feature, with a diagram of each language."""

from __future__ import annotations

from mmrs_core.languages.metaclass import Feature, Metaclass, Package
from mmrs_core.languages.registry import Registry
from mmrs_core.pictures.documents import render
from mmrs_core.pictures.pages.diagram import diagram, multiplicity, own_features, type_name

PAGE = "languages.md"
DIAGRAMS = "diagrams"


def pages(registry: Registry) -> dict[str, str]:
    """Return the contents by path below the documentation's folder."""
    drawings = {f"{DIAGRAMS}/{package.name}.svg": diagram(package) + "\n" for package in registry.packages}
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
    return [_row(feature, package) for feature in own_features(metaclass)]


def _row(feature: Feature, package: Package) -> tuple[str, ...]:
    held = "" if not feature.is_reference else ("holds " if feature.containment else "refers to ")
    return (
        f"`{feature.name}`",
        f"{held}{type_name(feature, package)}",
        multiplicity(feature),
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
