"""What makes no sense in the rules of a mapping file, though each key of them is spelt well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite

from mmrs_core.languages.metaclass import Enumeration, Metaclass
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.registry import Registry
from mmrs_core.migration.rules.mapping import Rule, Use
from mmrs_core.migration.rules.paths import feature_at
from mmrs_core.migration.sources.structure import Sort, SourceFeature, Structure


def nonsense(rules: Mapping[str, Rule], registry: Registry, structure: Structure) -> Iterator[str]:
    """Yield what no model could be migrated by, each with its place: class, feature and key.

    The paths of the rules must lead somewhere.
    """
    for rule in rules.values():
        kind = rule.source.partition("/")[0]
        for name, use in rule.uses.items():
            where = f"{kind.replace('.', ': ')}: {name}"
            feature = structure.feature(kind, name)
            for fault in _of_use(use, feature) if feature is not None else ():
                yield f"{where}: {fault}"
        metaclass = registry.metaclass(*rule.to) if rule.to is not None else None
        for name, use in _uses(rule, rules, structure) if metaclass is not None else ():
            for fault in _of_target(use, metaclass) if metaclass is not None else ():
                yield f"{kind.replace('.', ': ')}: {name}: {fault}"


def _of_use(use: Use, feature: SourceFeature) -> Iterator[str]:
    if use.times == 0.0 or not isfinite(use.times):
        yield f"times: expected a number other than 0, not {use.times:g}"
    if feature.sort is Sort.CONTAINED and len(use.to) > 1:
        yield f"to: an element has one place only, not {len(use.to)}: {', '.join(use.to)}"
    if "|" in feature.type:
        literals = [literal.strip() for literal in feature.type.split("|")]
        for old in use.values:
            if old not in literals:
                yield f"values: {_no_literal(old, feature.name, literals)}"


def _uses(rule: Rule, rules: Mapping[str, Rule], structure: Structure) -> Iterator[tuple[str, Use]]:
    """Yield what is done with each feature, as the nearest rule of class and supertypes says."""
    above = (rules[kind] for kind in structure.ancestry(rule.source.partition("/")[0]) if kind in rules)
    found: dict[str, Use] = {}
    for each in (rule, *above):
        found = {**each.uses, **found}
    yield from found.items()


def _of_target(use: Use, metaclass: Metaclass) -> Iterator[str]:
    for path in use.to if use.bearing is None else ():
        target = feature_at(metaclass, path).type
        if isinstance(target, Enumeration):
            literals = [literal.literal for literal in target.literals]
            for new in use.values.values():
                if new not in literals:
                    yield f"values: {_no_literal(new, target.name, literals)}"


def _no_literal(text: str, of: str, literals: list[str]) -> str:
    hint = nearest(text, literals)
    return f"{text!r} is no literal of {of} ({', '.join(literals)}){hint and '; ' + hint}"
