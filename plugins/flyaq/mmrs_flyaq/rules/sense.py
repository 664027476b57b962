"""What makes no sense in rules on the side of the source, though each key of them is spelt well."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import isfinite

from mmrs_core.languages.naming import nearest
from mmrs_flyaq.rules.mapping import Rule, Use
from mmrs_flyaq.rules.values import no_literal, said
from mmrs_flyaq.sources.structure import Sort, SourceFeature, Structure

WORD = re.compile(r"\{(\w+)\}")
"""What stands for a source feature in a text that a target gets."""
NUMBER = "number"
"""The word that stands for the position of an element among its siblings."""


def nonsense(rules: Mapping[str, Rule], structure: Structure) -> Iterator[str]:
    """Yield what no model could be migrated by, each with its place: class, feature and key."""
    variants = {rule.source.partition("/")[2] for rule in rules.values()}
    for rule in rules.values():
        kind, where = rule.source.partition("/")[0], rule.source.replace(".", ": ", 1)
        yield from (f"{where}: {fault}" for fault in _of_rule(rule, kind, structure))
        for name, use in rule.uses.items():
            feature = structure.feature(kind, name)
            assert feature is not None  # asked before
            for fault in _of_use(use, feature, kind, structure):
                yield f"{where}: {name}: {fault}"
            if use.rule not in variants:
                yield f"{where}: {name}: as: no rule has the variant {use.rule!r}"


def _of_rule(rule: Rule, kind: str, structure: Structure) -> Iterator[str]:
    if rule.set and rule.to is None:
        yield "set: means nothing without 'to'"
    named: list[tuple[str, str, Sort, str]] = []
    if rule.ring is not None:
        truth = ("clockwise", rule.ring.clockwise, "truth")
        numbers = ((key, getattr(rule.ring, key), "number") for key in ("radius", "height", "duration"))
        named += [(f"ring: {key}", name, Sort.ATTRIBUTE, type) for key, name, type in (*numbers, truth)]
    if rule.device is not None:
        named.append(("device: action", rule.device.action, Sort.ATTRIBUTE, "text"))
    if rule.wait is not None:
        named.append(("wait: slot", rule.wait.slot, Sort.REFERENCE, ""))
    for key, name, sort, type in named:
        needed = key not in ("ring: duration",)
        if name or needed:
            yield from _of_name(key, name, kind, structure, sort, type)
    holding = {feature.name for each in structure.classes for feature in structure.features(each)}
    for feature in rule.wait.at if rule.wait is not None else ():
        if feature not in holding:
            yield f"wait: at: {_unknown(feature, 'any declared class', holding)}"


def _of_name(
    key: str, name: str, kind: str, structure: Structure, sort: Sort | None = None, type: str = ""
) -> Iterator[str]:
    """Yield why a name is none of a declared feature of that sort and type, if it is none."""
    feature = structure.feature(kind, name)
    if feature is None:
        yield f"{key}: {_unknown(name, kind, {each.name for each in structure.features(kind)})}"
    elif sort is not None and feature.sort is not sort:
        yield f"{key}: {name} is no {sort.value}"
    elif type and feature.type != type:
        yield f"{key}: {name} holds no {type}"


def _unknown(name: str, kind: str, known: set[str]) -> str:
    hint = nearest(name, sorted(known))
    return f"{name!r} is not a declared feature of {kind}{hint and '; ' + hint}"


def _of_use(use: Use, feature: SourceFeature, kind: str, structure: Structure) -> Iterator[str]:
    if use.times == 0.0 or not isfinite(use.times):
        yield f"times: expected a number other than 0, not {use.times:g}"
    if use.widen < 0.0 or not isfinite(use.widen):
        yield f"widen: expected metres, not {use.widen:g}"
    if feature.sort is Sort.CONTAINED and len(use.to) > 1:
        yield f"to: an element has one place only, not {len(use.to)}: {', '.join(map(str, use.to))}"
    yield from _of_sort(use, feature)
    if "|" in feature.type:
        literals = [literal.strip() for literal in feature.type.split("|")]
        for key, olds in (("values", use.values), ("void", use.void)):
            for old in (old for old in olds if old not in literals):
                yield f"{key}: {no_literal(old, feature.name, literals)}"
    yield from _of_others(use, kind, structure)


def _of_sort(use: Use, feature: SourceFeature) -> Iterator[str]:
    """Yield the keys that mean nothing for what a feature holds."""
    of_texts = {
        "times": use.times != 1.0,
        "values": bool(use.values),
        "void": bool(use.void),
        "absent": use.absent is not None,
        "below": bool(use.below),
        "also": use.also is not None,
        "unique": use.unique,
        "robot_type": use.robot_type,
        "bearing": use.bearing is not None,
    }
    of_elements = {
        "as": bool(use.rule),
        "distinct": use.distinct,
        "widen": use.widen != 0.0,
        "make": use.make is not None,
        "first_of": bool(use.first_of),
    }
    wrong = of_elements if feature.sort is Sort.ATTRIBUTE else of_texts
    for key, given in wrong.items():
        if given:
            yield f"{key}: means nothing for {feature.name}, which is {_ARTICLE[feature.sort]}"
    if use.counterpart is not None and feature.sort is not Sort.REFERENCE:
        yield f"counterpart: means nothing for {feature.name}, which is {_ARTICLE[feature.sort]}"
    if feature.sort is Sort.REFERENCE:
        for key in (key for key, given in {**of_elements, "hoist": bool(use.hoist)}.items() if given):
            yield f"{key}: means nothing for {feature.name}, which is {_ARTICLE[feature.sort]}"
    if use.beside or use.bearing is not None:
        yield from _of_absent(use, "number" if use.bearing is not None else feature.type)


def _of_absent(use: Use, type: str) -> Iterator[str]:
    """Yield what is wrong with the value that stands for one that goes into no feature as it is."""
    if use.absent is None:
        return
    if type == "truth" and not isinstance(use.absent, bool):
        yield f"absent: expected true or false, not {use.absent!r}"
    if type == "number" and (isinstance(use.absent, bool | str) or not isfinite(use.absent)):
        yield f"absent: expected a number, not {said(use.absent)!r}"


_ARTICLE = {Sort.ATTRIBUTE: "an attribute", Sort.CONTAINED: "contained", Sort.REFERENCE: "a reference"}


def _of_others(use: Use, kind: str, structure: Structure) -> Iterator[str]:
    """Yield what is wrong with the other features of the source that a use names."""
    for key, name in (("with", use.beside), ("given", use.given)):
        if name:
            yield from _of_name(key, name, kind, structure)
    if use.below:
        yield from _of_name("below", use.below, kind, structure, Sort.ATTRIBUTE, "number")
    if use.first_of:
        yield from _of_name("first_of", use.first_of, kind, structure, Sort.CONTAINED)
    if use.counterpart is not None and use.counterpart.of:
        yield from _of_name("counterpart: of", use.counterpart.of, kind, structure, Sort.REFERENCE)
    for name in use.also.given if use.also is not None else ():
        yield from _of_name("also: given", name, kind, structure)
    for name in WORD.findall(use.absent) if isinstance(use.absent, str) else ():
        if name != NUMBER:
            yield from _of_name("absent", name, kind, structure, Sort.ATTRIBUTE)
