"""A metamodel as a tree of its packages, classes and features."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.output import answer
from mmrs_core.cli.settings import settings_of
from mmrs_core.cli.tree_words import value_words
from mmrs_core.languages.evolution.versions import version_of

if TYPE_CHECKING:
    from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package

_Branch = tuple[str, list["_Branch"]]
"""A line, and what stands below it."""


def show_metamodel(call: typer.Context, file: Path, depth: int, json: bool) -> int:
    """Print the packages of an .ecore file; errors as in `version_of`."""
    version = version_of(str(file), settings_of(call).plugins().contributions.languages)
    lines = (line for package in version.packages for line in _lines(_package(package), depth))
    answer(
        {"file": file, "packages": [_as_json(package) for package in version.packages]}, lines, as_json=json
    )
    return 0


def validate_metamodel(call: typer.Context, file: Path, json: bool) -> int:
    """Print that models can be read by an .ecore file; errors as in `version_of` if they cannot."""
    version = version_of(str(file), settings_of(call).plugins().contributions.languages)
    count = sum(len(package.metaclasses) for package in version.packages)
    line = f"{file}: a sound metamodel ({_classes(count)})"
    answer({"valid": True, "diagnostics": []}, [line], as_json=json)
    return 0


def _lines(branch: _Branch, depth: int) -> Iterator[str]:
    words, below = branch
    yield words
    yield from _below(below, "", depth, 1)


def _below(branches: Sequence[_Branch], lead: str, depth: int, level: int) -> Iterator[str]:
    if depth and level > depth:
        return
    for number, (words, below) in enumerate(branches, 1):
        last = number == len(branches)
        yield f"{lead}{'└─' if last else '├─'} {words}"
        yield from _below(below, f"{lead}{'   ' if last else '│  '}", depth, level + 1)


def _package(package: Package) -> _Branch:
    inside = [_class(kind) for kind in package.metaclasses] + [_enum(each) for each in package.enumerations]
    return f"{package.name} {package.ns_uri} ({_classes(len(package.metaclasses))})", inside


def _classes(count: int) -> str:
    return f"{count} class{'' if count == 1 else 'es'}"


def _class(kind: Metaclass) -> _Branch:
    above = ", ".join(each.name for each in kind.supertypes)
    words = f"{'abstract class' if kind.abstract else 'class'} {kind.name}{above and f' of {above}'}"
    return words, [(_feature(each), []) for each in kind.features if each.owner is kind]


def _enum(enumeration: Enumeration) -> _Branch:
    return f"enumeration {enumeration.name}: {', '.join(each.literal for each in enumeration.literals)}", []


def _feature(feature: Feature) -> str:
    most = "*" if feature.most < 0 else str(feature.most)
    default = "" if feature.default is None else f" = {value_words(feature.default)}"
    how = "contains " if feature.containment else "→ " if feature.is_reference else ""
    return f"{feature.name}: {how}{feature.type.name} [{feature.lower}..{most}]{default}"


def _as_json(package: Package) -> dict[str, object]:
    classes = [
        {
            "name": kind.name,
            "abstract": kind.abstract,
            "supertypes": [f"{each.ns_uri}#{each.name}" for each in kind.supertypes],
            "documentation": kind.documentation,
            "features": [_feature_as_json(each) for each in kind.features if each.owner is kind],
        }
        for kind in package.metaclasses
    ]
    enumerations = [
        {"name": each.name, "literals": [literal.literal for literal in each.literals]}
        for each in package.enumerations
    ]
    return {"name": package.name, "ns_uri": package.ns_uri, "classes": classes, "enumerations": enumerations}


def _feature_as_json(feature: Feature) -> dict[str, object]:
    return {
        "name": feature.name,
        "type": f"{feature.type.ns_uri}#{feature.type.name}",
        "reference": feature.is_reference,
        "containment": feature.containment,
        "lower": feature.lower,
        "upper": feature.most,
        "default": feature.default,
        "documentation": feature.documentation,
    }
