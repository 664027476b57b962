"""Reads the rules of a mapping file: what becomes of each class and of each feature."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.registry import Registry
from mmrs_core.migration.rules.mapping import (
    Also,
    Bearing,
    Constant,
    Counterpart,
    DeviceLookup,
    Ring,
    Rule,
    Use,
    Wait,
)
from mmrs_core.migration.rules.paths import feature_at
from mmrs_core.migration.rules.sense import nonsense
from mmrs_core.migration.rules.toml_tables import Table
from mmrs_core.migration.sources.structure import Structure

ROBOT_TYPE = ("urn:mmrs:robot:1.0", "Robot")


def read_rules(
    packages: Table, languages: Mapping[str, str], registry: Registry, structure: Structure
) -> dict[str, Rule]:
    """Return the rules by ``package.Class`` and ``package.Class/variant``.

    Raises:
        UnreadableError: if a key is misspelt, a class, feature or literal does not exist on either side, or
            a rule makes no sense.
    """
    rules: dict[str, Rule] = {}
    for package, classes in packages.tables().items():
        for name, table in classes.tables().items():
            rule = _rule(f"{package}.{name}", table, languages, registry)
            _check_source(rule, table, structure)
            rules[rule.source] = rule
    for rule in rules.values():
        _check_inherited(rule, rules, packages, registry, structure)
    for fault in nonsense(rules, registry, structure):
        raise packages.fault(fault)
    return rules


def _rule(source: str, table: Table, languages: Mapping[str, str], registry: Registry) -> Rule:
    to = table.take("to", str, "")
    metaclass = _metaclass(to, table, languages, registry) if to else None
    rule = Rule(
        source=source,
        to=metaclass.key if metaclass is not None else None,
        robot_type=metaclass is not None and metaclass.is_kind(*ROBOT_TYPE),
        drop=table.take("drop", str, ""),
        unreferred=table.take("unreferred", str, ""),
        merge=table.take("merge", bool, False),
        set=_constants(table.table("set"), metaclass),
        changed=table.take("changed", str, ""),
        uses={name: _use(table, name, value, metaclass) for name, value in _features(table)},
        wait=_wait(table.table("wait")) if "wait" in table else None,
        ring=_ring(table.table("ring")) if "ring" in table else None,
        device=_device(table.table("device")) if "device" in table else None,
    )
    table.done()
    return rule


def _metaclass(to: str, table: Table, languages: Mapping[str, str], registry: Registry) -> Metaclass:
    prefix, _, name = to.partition(":")
    if prefix not in languages:
        raise table.fault(f"to: {to!r}: {prefix!r} is none of the languages ({', '.join(languages)})")
    try:
        metaclass = registry.metaclass(languages[prefix], name)
    except ValueError as fault:
        raise table.fault(f"to: {fault}") from None
    if metaclass.abstract:
        raise table.fault(f"to: {to} is abstract")
    return metaclass


def _features(table: Table) -> list[tuple[str, object]]:
    inner = table.table("features")
    return [(name, inner.take(name, object, "")) for name in inner.keys]


def _constants(table: Table, metaclass: Metaclass | None) -> dict[str, Constant]:
    found = {path: table.take(path, object, "") for path in table.keys}
    for path, value in found.items():
        if not isinstance(value, str | float | bool | int):
            raise table.fault(f"{path}: expected a text, number or truth value")
        _check_path(path, table, metaclass)
    return cast(dict[str, Constant], found)


def _check_path(path: str, table: Table, metaclass: Metaclass | None) -> None:
    if metaclass is None:
        return
    try:
        feature_at(metaclass, path)
    except ValueError as fault:
        raise table.fault(str(fault)) from None


def _use(rule: Table, name: str, value: object, metaclass: Metaclass | None) -> Use:
    table = Table(f"{rule.where}: {name}", {"to": value} if isinstance(value, str | list) else value)
    absent = table.take("absent", object, None)
    if not isinstance(absent, str | float | bool | int | None):
        raise table.fault("absent: expected a text, number or truth value")
    use = Use(
        to=table.texts("to"),
        also=_also(table.table("also"), metaclass) if "also" in table else None,
        drop=table.take("drop", str, ""),
        times=table.take("times", float, 1.0),
        values=table.table("values").text_by_key(),
        absent=absent,
        void=table.texts("void"),
        changed=table.take("changed", str, ""),
        rule=table.take("as", str, ""),
        beside=table.take("with", str, ""),
        given=table.take("given", str, ""),
        below=table.take("below", str, ""),
        distinct=table.take("distinct", bool, False),
        widen=table.take("widen", float, 0.0),
        hoist=table.take("hoist", str, ""),
        unique=table.take("unique", bool, False),
        robot_type=table.take("robot_type", bool, False),
        otherwise=table.take("otherwise", str, ""),
        counterpart=_counterpart(table.table("counterpart")) if "counterpart" in table else None,
        bearing=_bearing(table.table("bearing")) if "bearing" in table else None,
    )
    table.done()
    if sum(map(bool, (use.to, use.drop, use.beside))) != 1:
        raise table.fault("needs one of 'to', 'drop' and 'with': where it goes, or why it does not")
    for path in use.to if use.bearing is None or use.bearing.base == "home" else ():
        _check_path(path, table, metaclass)
    return use


def _also(table: Table, metaclass: Metaclass | None) -> Also:
    found = Also(table.texts("given"), table.texts("to"))
    table.done()
    for path in found.to:
        _check_path(path, table, metaclass)
    return found


def _counterpart(table: Table) -> Counterpart:
    found = Counterpart(
        table.take("of", str, ""), table.take("within", str, ""), table.take("make", bool, False)
    )
    table.done()
    return found


def _bearing(table: Table) -> Bearing:
    found = Bearing(table.take("base", str, "home"), table.take("distance", float, 0.0))
    if found.base not in ("self", "home") or found.distance <= 0:
        raise table.fault("needs base = 'self' or 'home', and a distance above 0 in metres")
    table.done()
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


def _device(table: Table) -> DeviceLookup:
    found = DeviceLookup(table.take("action", str, ""), table.take("to", str, ""))
    table.done()
    return found


def _ring(table: Table) -> Ring:
    radius, height, clockwise = (table.take(name, str, "") for name in ("radius", "height", "clockwise"))
    points = table.take("points", int, 12)
    if points < 3:
        raise table.fault("points: needs at least 3")
    found = Ring(radius, height, clockwise, points)
    table.done()
    return found


def _check_inherited(
    rule: Rule, rules: Mapping[str, Rule], packages: Table, registry: Registry, structure: Structure
) -> None:
    """Do nothing if what rules of supertypes say of features suits the class that a rule leads to."""
    kind = rule.source.partition("/")[0]
    above = [rules[name] for name in structure.ancestry(kind) if name in rules]
    metaclass = registry.metaclass(*rule.to) if rule.to is not None else None
    for other in above:
        for feature, use in other.uses.items():
            table = Table(f"{packages.where}: {rule.source}: {feature}, as {other.source} says", {})
            for path in use.to if feature not in rule.uses and use.bearing is None else ():
                _check_path(path, table, metaclass)


def _check_source(rule: Rule, table: Table, structure: Structure) -> None:
    """Do nothing if the rule is for a declared class and its declared features."""
    kind = rule.source.partition("/")[0]
    if not structure.has(kind):
        raise table.fault(f"{kind} is not among the declared classes")
    for feature in rule.uses:
        if structure.feature(kind, feature) is None:
            raise table.fault(f"{feature}: no declared feature of {kind}")
