"""Everything that plug-ins contributed, by name, and who contributed it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from mmrs_core.contributions.checks import Check
from mmrs_core.contributions.commands import Command
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.execution import BackendFactory, Condition
from mmrs_core.contributions.rules import MoveKind, RobotKind, Rule
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.contributions.targets import Target
from mmrs_core.errors import PluginError
from mmrs_core.languages.registry import MetamodelSource, Registry
from mmrs_core.scene import Name

Key = TypeVar("Key")
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True)
class Contribution:
    """One thing that a plug-in contributed: for people."""

    plugin: str
    distribution: str
    sort: str
    name: str


@dataclass(frozen=True, slots=True)
class Contributions:
    """What the loaded plug-ins contributed; the core's own is among it.

    Attributes:
        languages: the registry of all metamodels.
        observers: called with (hook name, arguments) when a stage finishes or a step is executed.
        catalogue: who contributed what, sorted.
    """

    languages: Registry
    metamodels: tuple[MetamodelSource, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    rules: Mapping[Name, Rule] = field(default_factory=dict)
    robot_kinds: Mapping[Name, RobotKind] = field(default_factory=dict)
    move_kinds: Mapping[Name, MoveKind] = field(default_factory=dict)
    checks: tuple[Check, ...] = ()
    targets: Mapping[str, Target] = field(default_factory=dict)
    backends: Mapping[str, BackendFactory] = field(default_factory=dict)
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    map_symbols: Mapping[Name, MapSymbol] = field(default_factory=dict)
    commands: tuple[Command, ...] = ()
    catalogue: tuple[Contribution, ...] = ()


def by_key(sort: str, items: Iterable[tuple[str, Item]], key: Callable[[Item], Key]) -> dict[Key, Item]:
    """Return the items by key.

    Args:
        sort: what they are, for messages.
        items: each with the name of the plug-in that contributed it.
        key: of an item; must be unique over all plug-ins.

    Raises:
        PluginError: if two have the same key; names both plug-ins.
    """
    found: dict[Key, Item] = {}
    owners: dict[Key, str] = {}
    for plugin, item in items:
        name = key(item)
        if name in found:
            raise PluginError(f"{sort} {name}: contributed by both '{owners[name]}' and '{plugin}'")
        found[name], owners[name] = item, plugin
    return found
