"""Everything that plug-ins contributed, by name, and who contributed it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

from mmrs_core.contributions.commands import CORE_NAMES, Command
from mmrs_core.contributions.hooks import Hook
from mmrs_core.errors import PluginError, UnreadableError

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Check
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.drawings import DrawingReader, Exporter
    from mmrs_core.contributions.execution import Condition
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.hooks import Extensions
    from mmrs_core.contributions.robot_types import RobotTypeFile
    from mmrs_core.contributions.rules import ElementKind, MoveKind, RobotKind, Rule
    from mmrs_core.contributions.symbols import MapSymbol
    from mmrs_core.contributions.targets import Target
    from mmrs_core.contributions.timing import VehicleTiming
    from mmrs_core.contributions.vehicles import VehicleFactory
    from mmrs_core.languages.classes import ElementClass
    from mmrs_core.languages.evolution.migration import Migration
    from mmrs_core.languages.importers import Importer
    from mmrs_core.languages.registry import Registry
    from mmrs_core.languages.sources import MetamodelSource
    from mmrs_core.scene import Name

Key = TypeVar("Key")
Item = TypeVar("Item")

_CODE = re.compile("[A-Z]{2,}[0-9]{3}")

Declared = Callable[[str], "Iterable[tuple[str, Any]]"]

CORE_HOOKS: Mapping[str, Hook] = {
    sort: Hook(f"mmrs_{sort}", "", f"mmrs_core.{descriptor}", key)
    for sort, descriptor, key in (
        ("metamodels", "languages.sources:MetamodelSource", "ns_uri"),
        ("element_classes", "languages.classes:ElementClass", "metaclass"),
        ("migrations", "languages.evolution.migration:Migration", "step"),
        ("importers", "languages.importers:Importer", "name"),
        ("constraints", "contributions.constraints:Constraint", "code"),
        ("fixes", "contributions.fixes:Fix", "code"),
        ("rules", "contributions.rules:Rule", "name"),
        ("robot_kinds", "contributions.rules:RobotKind", "name"),
        ("vehicle_timings", "contributions.timing:VehicleTiming", "vehicle"),
        ("move_kinds", "contributions.rules:MoveKind", "metaclass"),
        ("element_kinds", "contributions.rules:ElementKind", "metaclass"),
        ("checks", "contributions.checks:Check", "name"),
        ("targets", "contributions.targets:Target", "name"),
        ("vehicles", "contributions.vehicles:VehicleFactory", "name"),
        ("conditions", "contributions.execution:Condition", "identifier"),
        ("map_symbols", "contributions.symbols:MapSymbol", "metaclass"),
        ("robot_types", "contributions.robot_types:RobotTypeFile", "name"),
        ("drawing_readers", "contributions.drawings:DrawingReader", "name"),
        ("exporters", "contributions.drawings:Exporter", "name"),
        ("hooks", "contributions.hooks:Hook", "name"),
        ("commands", "contributions.commands:Command", "name"),
    )
}
"""The hooks of the core, by sort of what they declare; their descriptions are in `hookspecs`."""


@dataclass(frozen=True, slots=True)
class Contribution:
    """One contribution of a plug-in, for lists and messages."""

    plugin: str
    sort: str
    name: str


class Contributions:
    """What the loaded plug-ins contributed; the core's own is among it.

    Each sort is asked for when it is first needed, so that a command pays only for what it uses.
    Every attribute raises PluginError if two plug-ins contribute the same thing; it names both.

    Args:
        declared: the (plug-in, descriptor) pairs of a sort, such as ``rules``, sorted by plug-in.
        distributions: where each plug-in comes from.
        quiet_migration: do not list what is not just as it was in models of other tools.
    """

    def __init__(
        self,
        declared: Declared,
        distributions: Mapping[str, str] | None = None,
        *,
        quiet_migration: bool = False,
    ) -> None:
        self._declared = declared
        self._distributions = distributions or {}
        self._quiet_migration = quiet_migration

    @cached_property
    def metamodels(self) -> tuple[MetamodelSource, ...]:
        """Return the metamodels of plug-ins."""
        return tuple(self._by("metamodels", lambda source: source.ns_uri).values())

    @cached_property
    def languages(self) -> Registry:
        """Return the registry of all metamodels, the core's included.

        Raises:
            PluginError: if a metamodel is broken; names its distribution.
        """
        from mmrs_core.languages.registry import registry_with  # the help needs plug-ins, but no language

        try:
            return registry_with(self.metamodels, self.migrations, self.element_classes, self.importers)
        except UnreadableError as error:
            raise PluginError(str(error)) from error

    @cached_property
    def element_classes(self) -> tuple[ElementClass, ...]:
        """Return the Python classes of elements; the registry refuses two for a metaclass."""
        return tuple(
            given if given.provider else replace(given, provider=self._whose(plugin))
            for plugin, given in self._declared("element_classes")
        )

    @cached_property
    def migrations(self) -> tuple[Migration, ...]:
        """Return the steps from older versions of languages."""
        from mmrs_core.languages.evolution.migration import chains

        found = tuple(self._by("migrations", lambda migration: migration.from_uri).values())
        chains(found, ())  # they must not form a cycle
        return found

    @cached_property
    def importers(self) -> tuple[Importer, ...]:
        """Return the importers of other tools' models."""
        found: Iterable[Importer] = self._by("importers", lambda importer: importer.name).values()
        return tuple(replace(each, notes=each.notes and not self._quiet_migration) for each in found)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """Return the constraints on models."""
        for plugin, constraint in self._declared("constraints"):
            if not _CODE.fullmatch(constraint.code):
                raise PluginError(
                    f"constraint {constraint.code!r} of plug-in '{plugin}': "
                    "expected a code of two or more capitals and three digits"
                )
        self._refuse_misspelt("constraints")
        return tuple(self._by("constraints", lambda constraint: constraint.code).values())

    @cached_property
    def fixes(self) -> Mapping[str, Fix]:
        """Return the quick fixes, by code."""
        return self._by("fixes", lambda fix: fix.code)

    @cached_property
    def rules(self) -> Mapping[Name, Rule]:
        """Return the rules by the metaclass of their tasks."""
        by_key("rules", self._declared("rules"), lambda rule: rule.name)
        return self._by_metaclass("rules")

    @cached_property
    def robot_kinds(self) -> Mapping[Name, RobotKind]:
        """Return the robot kinds by metaclass; their robots take as long as what drives them does."""
        from mmrs_core.contributions.timing import as_driven

        kinds: dict[Name, RobotKind] = self._by_metaclass("robot_kinds")
        timings = self.vehicle_timings
        return {name: as_driven(kind, timings.get(kind.vehicle)) for name, kind in kinds.items()}

    @cached_property
    def vehicle_timings(self) -> Mapping[str, VehicleTiming]:
        """Return how long autopilots take, by class of vehicle."""
        return self._by("vehicle_timings", lambda timing: timing.vehicle)

    @cached_property
    def move_kinds(self) -> Mapping[Name, MoveKind]:
        """Return the move kinds by metaclass."""
        return self._by_metaclass("move_kinds")

    @cached_property
    def element_kinds(self) -> Mapping[Name, ElementKind]:
        """Return the kinds of context elements by metaclass."""
        return self._by_metaclass("element_kinds")

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Return the checks of behaviours."""
        return tuple(self._by("checks", lambda check: check.name).values())

    @cached_property
    def hooks(self) -> Mapping[str, Hook]:
        """Return the hooks that plug-ins specify, by name."""
        return self._by("hooks", lambda hook: hook.name)

    @cached_property
    def extensions(self) -> Extensions:
        """Return what plug-ins contribute by the hooks of plug-ins."""
        return {hook.sort: self._by(hook.sort, attrgetter(hook.key)) for hook in self.hooks.values()}

    @cached_property
    def targets(self) -> Mapping[str, Target]:
        """Return the targets for code generation by name."""
        return self._by("targets", lambda target: target.name)

    @cached_property
    def vehicles(self) -> Mapping[str, VehicleFactory]:
        """Return what drives robots, by name."""
        return self._by("vehicles", lambda vehicle: vehicle.name)

    @cached_property
    def conditions(self) -> Mapping[str, Condition]:
        """Return the functions that decide Choices, by identifier."""
        return self._by("conditions", lambda condition: condition.identifier)

    @cached_property
    def map_symbols(self) -> Mapping[Name, MapSymbol]:
        """Return how elements look on maps, by metaclass."""
        return self._by_metaclass("map_symbols")

    @cached_property
    def robot_types(self) -> Mapping[str, RobotTypeFile]:
        """Return the robot types that missions can begin with, by name."""
        return self._by("robot_types", lambda given: given.name)

    @cached_property
    def drawing_readers(self) -> tuple[DrawingReader, ...]:
        """Return the readers of what map programs draw."""
        return tuple(self._by("drawing_readers", lambda reader: reader.name).values())

    @cached_property
    def exporters(self) -> Mapping[str, Exporter]:
        """Return the formats that map programs read, by name."""
        return self._by("exporters", lambda exporter: exporter.name)

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """Return the commands that plug-ins add."""
        for plugin, command in self._declared("commands"):
            if command.name in CORE_NAMES:
                raise PluginError(f"command '{command.name}': contributed by both 'core' and '{plugin}'")
        return tuple(self._by("commands", lambda command: command.name).values())

    def catalogue(self) -> tuple[Contribution, ...]:
        """Return who contributed what, sorted by plug-in, sort and name."""
        found = (
            Contribution(plugin, hook.sort, _shown(hook, item))
            for hook in (*CORE_HOOKS.values(), *self.hooks.values())
            for plugin, item in self._declared(hook.sort)
        )
        return tuple(sorted(found, key=lambda each: (each.plugin, each.sort, each.name)))

    def distribution_of(self, sort: str, item: object) -> str:
        """Return the distribution whose plug-in contributed a descriptor; empty if none did."""
        return self._distributions.get(self._plugin_of(sort, item), "")

    def source_of(self, sort: str, item: object) -> str:
        """Return plug-in, distribution and name of a descriptor, for messages about its failures."""
        return f"{self._whose(self._plugin_of(sort, item))}: {called(CORE_HOOKS[sort], item)}"

    def check(self) -> None:
        """Look at every sort of contribution.

        Raises:
            PluginError: if a plug-in is broken, or two conflict.
        """
        for sort in ("languages", *CORE_HOOKS, "extensions"):
            getattr(self, sort)

    def _whose(self, plugin: str) -> str:
        return (
            f"plug-in '{plugin}' of distribution '{self._distributions.get(plugin, 'unknown distribution')}'"
        )

    def _plugin_of(self, sort: str, item: object) -> str:
        return next((plugin for plugin, each in self._declared(sort) if each is item), "")

    def _by_metaclass(self, sort: str) -> dict[Name, Any]:
        self._refuse_misspelt(sort)
        return self._by(sort, lambda item: item.metaclass)

    def _refuse_misspelt(self, sort: str) -> None:
        """Raise PluginError for a class that its language does not have; a language may be missing."""
        for plugin, item in self._declared(sort):
            ns_uri, name = item.metaclass
            if not self.languages.has(ns_uri):
                continue
            try:
                self.languages.metaclass(ns_uri, name)
            except ValueError as error:
                raise PluginError(f"plug-in '{plugin}': {called(CORE_HOOKS[sort], item)}: {error}") from error

    def _by(self, sort: str, key: Callable[[Any], Key]) -> dict[Key, Any]:
        return by_key(sort, self._declared(sort), key)


def called(hook: Hook, item: object) -> str:
    """Return what messages call a descriptor, such as ``rule 'wave'``."""
    return f"{_singular(hook.sort)} '{_shown(hook, item)}'"


def _shown(hook: Hook, item: object) -> str:
    key = getattr(item, hook.key)
    return "#//".join(key) if isinstance(key, tuple) else str(key)


def _singular(sort: str) -> str:
    return sort.removesuffix("es" if sort in ("fixes", "element_classes") else "s").replace("_", " ")


def by_key(sort: str, items: Iterable[tuple[str, Item]], key: Callable[[Item], Key]) -> dict[Key, Item]:
    """Return the items by key.

    Args:
        sort: what they are, for messages.
        items: each with the name of the plug-in that contributed it.
        key: of an item; must be unique over all plug-ins.

    Raises:
        PluginError: if two have the same key; names both plug-ins, or the one that says it twice.
    """
    found: dict[Key, Item] = {}
    owners: dict[Key, str] = {}
    for plugin, item in items:
        name = key(item)
        if name in found:
            shown = "#//".join(name) if isinstance(name, tuple) else name
            whom = (
                f"twice by '{plugin}'"
                if owners[name] == plugin
                else f"by both '{owners[name]}' and '{plugin}'"
            )
            raise PluginError(f"{_singular(sort)} '{shown}': contributed {whom}")
        found[name], owners[name] = item, plugin
    return found
