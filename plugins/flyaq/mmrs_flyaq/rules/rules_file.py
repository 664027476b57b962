"""Reads the rules of a mapping file: what becomes of each class."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from mmrs_core.languages.metaclass import Metaclass
from mmrs_flyaq.rules.classes import Classes
from mmrs_flyaq.rules.fitting import unfitting
from mmrs_flyaq.rules.mapping import DeviceLookup, Ring, Rule, Use, Wait
from mmrs_flyaq.rules.sense import nonsense
from mmrs_flyaq.rules.toml_tables import Table
from mmrs_flyaq.rules.uses_file import for_class, read_constants, read_paths, read_use
from mmrs_flyaq.sources.structure import Structure

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
        drop=table.take("drop", str, ""),
        unreferred=table.take("unreferred", str, ""),
        merge=table.take("merge", bool, False),
        set=read_constants(table.table("set"), metaclass, classes),
        changed=table.take("changed", str, ""),
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
    found = Wait(
        table.take("slot", str, ""),
        {feature: at.texts(feature) for feature in at.keys},
        table.take("among", str, ""),
        table.take("add", str, ""),
    )
    table.done()
    return found


def _device(table: Table, metaclass: Metaclass | None, classes: Classes) -> DeviceLookup:
    action, to = table.take("action", str, ""), read_paths(table, "to", metaclass, classes)
    if len(to) != 1:
        raise table.fault("to: expected one path, which gets the device's id")
    table.done()
    return DeviceLookup(action, to[0])


def _ring(table: Table) -> Ring:
    names = ("radius", "height", "clockwise", "duration")
    radius, height, clockwise, duration = (table.take(name, str, "") for name in names)
    points = table.take("points", int, 12)
    if points < 3:
        raise table.fault("points: needs at least 3")
    table.done()
    return Ring(radius, height, clockwise, duration, points)


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
    """Do nothing if the rule is for a declared class and its declared features."""
    kind = rule.source.partition("/")[0]
    if not structure.has(kind):
        raise table.fault(f"{kind} is not among the declared classes")
    for feature in rule.uses:
        if structure.feature(kind, feature) is None:
            raise table.fault(f"{feature}: no declared feature of {kind}")
