"""Reads the rules for a feature in a mapping file: the targets and conversions of its values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

from mmrs_core.languages.metaclass import Metaclass
from mmrs_flyaq.rules.mapping import Also, Bearing, Constant, Counterpart, Make, Use
from mmrs_flyaq.rules.paths import Classes, FeaturePath, parse_path, path_from
from mmrs_flyaq.rules.toml_tables import Table
from mmrs_flyaq.rules.values import misfit


def read_use(table: Table, metaclass: Metaclass | None, classes: Classes) -> Use:
    """Return what becomes of a feature.

    Args:
        metaclass: the class that the rule leads to; None for one that only serves subtypes.

    Raises:
        UnreadableError: if a key is misspelt or ill-typed, or a path leads nowhere.
    """
    use = Use(
        **table.plain(Use, rule="as", beside="with"),
        values=table.table("values").text_by_key(),
        absent=_absent(table),
        make=_make(table.table("make"), classes) if "make" in table else None,
        counterpart=_counterpart(table.table("counterpart")) if "counterpart" in table else None,
        bearing=_bearing(table.table("bearing")) if "bearing" in table else None,
    )
    hoisted = bool(use.hoist)
    elsewhere = use.bearing is not None and use.bearing.base == "self"
    own = None if elsewhere else metaclass
    also = _also(table.table("also"), metaclass, classes, hoisted) if "also" in table else None
    use = replace(use, to=read_paths(table, "to", own, classes, hoisted=hoisted), also=also)
    table.done()
    if sum(map(bool, (use.to, use.drop, use.beside))) != 1:
        raise table.fault("needs one of 'to', 'drop' and 'with': where it goes, or why it does not")
    return use


def for_class(use: Use, metaclass: Metaclass, classes: Classes) -> Use:
    """Return a supertype's rule for a feature, adapted to elements of another class.

    Raises:
        ValueError: if a path leads nowhere from there.
    """
    if use.bearing is not None and use.bearing.base == "self":
        return use

    def found(paths: tuple[FeaturePath, ...]) -> tuple[FeaturePath, ...]:
        return tuple(path_from(metaclass, path.written, classes, hoisted=bool(use.hoist)) for path in paths)

    also = replace(use.also, to=found(use.also.to)) if use.also is not None else None
    return replace(use, to=found(use.to), also=also)


def read_paths(
    table: Table, key: str, metaclass: Metaclass | None, classes: Classes, *, hoisted: bool = False
) -> tuple[FeaturePath, ...]:
    """Return the paths under a key, which lead somewhere from a class; none where the key is missing.

    Raises:
        UnreadableError: if one is not a path, or leads nowhere.
    """
    return tuple(_path(text, table, metaclass, classes, hoisted) for text in table.texts(key))


def _path(
    text: str, table: Table, metaclass: Metaclass | None, classes: Classes, hoisted: bool = False
) -> FeaturePath:
    try:
        if metaclass is not None:
            return path_from(metaclass, text, classes, hoisted=hoisted)
        *way, last = parse_path(text)
    except ValueError as fault:
        raise table.fault(str(fault)) from None
    return FeaturePath(tuple(way), last.name, text)


def read_constants(
    table: Table, metaclass: Metaclass | None, classes: Classes
) -> Mapping[FeaturePath, Constant]:
    """Return constants by path.

    Raises:
        UnreadableError: if a path leads nowhere, or its feature does not hold such a value.
    """
    values = {text: table.take(text, object, "") for text in table.keys}
    found = {_path(text, table, metaclass, classes): value for text, value in values.items()}
    for path, value in found.items():
        if not isinstance(value, str | float | bool | int):
            raise table.fault(f"{path}: expected a text, number or truth value")
        if metaclass is not None and (fault := misfit(path.end(metaclass), value)):
            raise table.fault(f"{path}: {fault}")
    return cast(Mapping[FeaturePath, Constant], found)


def _absent(table: Table) -> Constant | None:
    absent = table.take("absent", object, None)
    if not isinstance(absent, str | float | bool | int | None):
        raise table.fault("absent: expected a text, number or truth value")
    return absent


def _make(table: Table, classes: Classes) -> Make:
    try:
        metaclass = classes.named(table.take("to", str, ""))
    except ValueError as fault:
        raise table.fault(f"to: {fault}") from None
    found = Make(metaclass.key, read_constants(table.table("set"), metaclass, classes))
    table.done()
    return found


def _also(table: Table, metaclass: Metaclass | None, classes: Classes, hoisted: bool) -> Also:
    found = Also(table.texts("given"), read_paths(table, "to", metaclass, classes, hoisted=hoisted))
    table.done()
    return found


def _counterpart(table: Table) -> Counterpart:
    found = Counterpart(**table.plain(Counterpart))
    table.done()
    return found


def _bearing(table: Table) -> Bearing:
    found = Bearing(**table.plain(Bearing))
    if found.base not in ("self", "home") or found.distance <= 0:
        raise table.fault("needs base = 'self' or 'home', and a distance above 0 in metres")
    table.done()
    return found
