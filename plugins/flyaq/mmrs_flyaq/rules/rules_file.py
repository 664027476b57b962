"""Reads the rules of a mapping file: what becomes of each class."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.rules.mapping import DeviceLookup, Ring, Rule, Use, Wait
from mmrs_flyaq.rules.paths import Classes, FeaturePath
from mmrs_flyaq.rules.sense import WORD, nonsense
from mmrs_flyaq.rules.toml_tables import Table
from mmrs_flyaq.rules.uses_file import for_class, read_constants, read_paths, read_use
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


ROBOT_TYPE = ("urn:mmrs:robot:1.0", "Robot")


def read_rules(packages: Table, classes: Classes, structure: Structure) -> dict[str, Rule]:
    """Return the rules by ``package.Class`` and ``package.Class/variant``.

    Raises:
        UnreadableError: if a key is misspelt, a class, feature or literal does not exist on either side, a
            value is not of the type it goes to, or a rule makes no sense.
    """
    rules: dict[str, Rule] = {}
    for package, kinds in packages.tables().items():
        for name, table in kinds.tables().items():
            rule = _rule(f"{package}.{name}", table, classes)
            _check_source(rule, table, structure)
            rules[rule.source] = rule
    for fault in nonsense(rules, structure):
        raise packages.fault(fault)
    rules = {name: _with_inherited(rule, rules, packages, classes, structure) for name, rule in rules.items()}
    for fault in unfitting(rules, classes.registry, structure):
        raise packages.fault(fault)
    return rules


def _rule(source: str, table: Table, classes: Classes) -> Rule:
    to = table.take("to", str, "")
    metaclass = _metaclass(to, table, classes) if to else None
    rule = Rule(
        source=source,
        to=metaclass.key if metaclass is not None else None,
        robot_type=metaclass is not None and metaclass.is_kind(*ROBOT_TYPE),
        **table.plain(Rule, "source", "robot_type"),
        set=read_constants(table.table("set"), metaclass, classes),
        uses=_uses(table, metaclass, classes),
        wait=_wait(table.table("wait")) if "wait" in table else None,
        ring=_ring(table.table("ring")) if "ring" in table else None,
        device=_device(table.table("device"), metaclass, classes) if "device" in table else None,
    )
    table.done()
    return rule


def _metaclass(to: str, table: Table, classes: Classes) -> Metaclass:
    try:
        return classes.named(to)
    except ValueError as fault:
        raise table.fault(f"to: {fault}") from None


def _uses(rule: Table, metaclass: Metaclass | None, classes: Classes) -> Mapping[str, Use]:
    inner = rule.table("features")
    found = {}
    for name in inner.keys:
        value = inner.take(name, object, "")
        table = Table(f"{rule.where}: {name}", {"to": value} if isinstance(value, str | list) else value)
        found[name] = read_use(table, metaclass, classes)
    return found


def _wait(table: Table) -> Wait:
    at = table.table("at")
    found = Wait(at={feature: at.texts(feature) for feature in at.keys}, **table.plain(Wait))
    table.done()
    return found


def _device(table: Table, metaclass: Metaclass | None, classes: Classes) -> DeviceLookup:
    action, to = table.take("action", str, ""), read_paths(table, "to", metaclass, classes)
    if len(to) != 1:
        raise table.fault("to: expected one path, which gets the device's id")
    table.done()
    return DeviceLookup(action, to[0])


def _ring(table: Table) -> Ring:
    found = Ring(**table.plain(Ring))
    if found.points < 3:
        raise table.fault("points: needs at least 3")
    table.done()
    return found


def _with_inherited(
    rule: Rule, rules: Mapping[str, Rule], packages: Table, classes: Classes, structure: Structure
) -> Rule:
    """Return a rule with the supertypes' rules for further features."""
    if rule.to is None:
        return rule
    metaclass, uses = classes.registry.metaclass(*rule.to), dict(rule.uses)
    for name in structure.ancestry(rule.source.partition("/")[0]):
        for feature, use in rules[name].uses.items() if name in rules else ():
            if feature in uses:
                continue
            try:
                uses[feature] = for_class(use, metaclass, classes)
            except ValueError as fault:
                where = f"{rule.source.replace('.', ': ', 1)}: {feature}, as {name} says"
                raise packages.fault(f"{where}: {fault}") from None
    return replace(rule, uses=uses)


def _check_source(rule: Rule, table: Table, structure: Structure) -> None:
    """Require that a rule is for a declared class and its declared features."""
    kind = rule.source.partition("/")[0]
    if not structure.has(kind):
        raise table.fault(f"{kind} is not among the declared classes")
    for feature in rule.uses:
        if structure.feature(kind, feature) is None:
            raise table.fault(f"{feature}: no declared feature of {kind}")
