"""What in the rules of a mapping file does not fit the languages that they lead to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.rules.mapping import Rule, Use, Wait
from mmrs_flyaq.rules.paths import FeaturePath
from mmrs_flyaq.rules.sense import WORD
from mmrs_flyaq.rules.values import misfit
from mmrs_flyaq.sources.structure import Sort, SourceFeature, Structure


def unfitting(rules: Mapping[str, Rule], registry: Registry, structure: Structure) -> Iterator[str]:
    """Yield every value or element that does not fit where a rule takes it, with class, feature and key."""
    made = {rule.to: registry.metaclass(*rule.to) for rule in rules.values() if rule.to is not None}
    for rule in rules.values():
        where = rule.source.replace(".", ": ", 1)
        for fault in _of_names(rule, tuple(made.values())):
            yield f"{where}: {fault}"
        if rule.to is None:
            continue
        kind = rule.source.partition("/")[0]
        for name, use in rule.uses.items():
            feature = structure.feature(kind, name)
            for fault in _of_use(use, feature, made[rule.to], registry) if feature is not None else ():
                yield f"{where}: {name}: {fault}"
        yield from (f"{where}: {fault}" for fault in _twice(rule, made[rule.to]))
        if rule.device is not None and (fault := misfit(rule.device.to.end(made[rule.to]), "id")):
            yield f"{where}: device: to: {fault}"


def _of_names(rule: Rule, made: tuple[Metaclass, ...]) -> Iterator[str]:
    """Yield the names of features that no class has which a rule makes."""
    named = [(f"{name}: hoist", use.hoist, True) for name, use in rule.uses.items() if use.hoist]
    named += [
        (f"{name}: counterpart: within", use.counterpart.within, True)
        for name, use in rule.uses.items()
        if use.counterpart is not None
    ]
    if rule.wait is not None:
        named.append(("wait: among", rule.wait.among, True))
        ends = dict.fromkeys(end for at in rule.wait.at.values() for end in at)
        named += [("wait: at", end, False) for end in ends]
        yield from _of_transitions(rule.wait, made)
    for key, name, holds in named:
        found = [each.by_name[name] for each in made if name in each.by_name]
        if not any(feature.is_reference and (feature.containment or not holds) for feature in found):
            such = "feature that contains elements" if holds else "reference"
            yield f"{key}: {name!r}: no class that a rule leads to has such a {such}"


def _of_transitions(wait: Wait, made: tuple[Metaclass, ...]) -> Iterator[str]:
    kinds = [each.by_name[wait.among].type for each in made if wait.among in each.by_name]
    transitions = [kind for kind in kinds if isinstance(kind, Metaclass)]
    if not all(wait.add in kind.by_name and kind.by_name[wait.add].is_reference for kind in transitions):
        yield f"wait: add: {wait.add!r}: no transition has such a reference"


def _of_use(use: Use, source: SourceFeature, metaclass: Metaclass, registry: Registry) -> Iterator[str]:
    if use.bearing is not None:
        return
    for path in (*use.to, *(use.also.to if use.also is not None else ())):
        target = path.end(metaclass)
        if source.sort is Sort.ATTRIBUTE and target.is_reference:
            yield f"to: {path} holds elements, and {source.name} is an attribute"
        elif source.sort is not Sort.ATTRIBUTE and not target.is_reference:
            yield f"to: {path} holds values, and {source.name} holds elements"
        elif source.sort is Sort.CONTAINED and target.containment == bool(use.hoist):
            reason = "contains, so nothing is to be hoisted" if use.hoist else "only refers: needs 'hoist'"
            yield f"to: {path} {reason}"
        elif source.sort is Sort.REFERENCE and target.containment:
            yield f"to: {path} contains, and {source.name} is a reference"
        elif source.sort is Sort.ATTRIBUTE:
            yield from _of_values(use, path, metaclass)
        if use.make is not None and target.is_reference:
            made = registry.metaclass(*use.make.to)
            if isinstance(target.type, Metaclass) and not made.is_kind(*target.type.key):
                yield f"make: to: {made.name} is no {target.type.name}, which {path} takes"


def _of_values(use: Use, path: FeaturePath, metaclass: Metaclass) -> Iterator[str]:
    target = path.end(metaclass)
    for new in use.values.values():
        if fault := misfit(target, new):
            yield f"values: {fault}"
    if use.absent is None or (isinstance(use.absent, str) and WORD.search(use.absent)):
        return
    if fault := misfit(target, use.absent):
        yield f"absent: {fault}"


def _twice(rule: Rule, metaclass: Metaclass) -> Iterator[str]:
    """Yield the places for one value only that two features, or a constant and a feature, go to."""
    taken: dict[tuple[object, ...], str] = {path.place: f"set: {path}" for path in rule.set}
    for name, use in rule.uses.items():
        if use.bearing is not None:
            continue
        paths = (*use.to, *(use.also.to if use.also is not None else ()))
        for path in paths:
            other = taken.setdefault(path.place, name)
            if other != name and not path.end(metaclass).many:
                yield f"{name}: to: {path} takes one value only, and {other} goes there already"
