"""Finds the installed plug-ins and collects what they contribute."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

import pluggy

from mmrs_core import hookspecs
from mmrs_core.contributions.registry import Contribution, Contributions, by_key
from mmrs_core.errors import PluginError
from mmrs_core.languages.registry import registry_with

GROUP = "mmrs.plugins"
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True)
class Plugins:
    """The loaded plug-ins.

    Attributes:
        contributions: all that they declare.
        observe_stage, observe_step: call every observer.
    """

    contributions: Contributions
    manager: pluggy.PluginManager

    def observe_stage(self, stage: str, result: object) -> None:
        """Tell observers that a stage has finished."""
        self.manager.hook.mmrs_stage_finished(stage=stage, result=result)


def load_plugins(*, only_core: bool = False, extra: Mapping[str, object] | None = None) -> Plugins:
    """Return the installed plug-ins, loaded in the order of their names.

    Args:
        only_core: leave out everything but the core's own contributions.
        extra: plug-in objects beside the installed ones, by name.

    Raises:
        PluginError: if a plug-in does not import, misspells a hook, or two conflict; names the
            distribution.
    """
    manager = pluggy.PluginManager("mmrs")
    manager.add_hookspecs(hookspecs)
    owners: dict[str, str] = {}
    for name, distribution, plugin in _found(only_core):
        _register(manager, owners, name, distribution, plugin)
    for name, plugin in sorted((extra or {}).items()):
        _register(manager, owners, name, "given by the caller", plugin)
    return Plugins(_collect(manager, owners), manager)


def _found(only_core: bool) -> Iterable[tuple[str, str, object]]:
    from mmrs_core import builtin

    yield "core", "mmrs-core", builtin
    if only_core:
        return
    for entry in sorted(entry_points(group=GROUP), key=lambda entry: (entry.name, entry.value)):
        if entry.value != "mmrs_core.builtin":
            yield entry.name, _distribution(entry), _imported(entry)


def _distribution(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist else "unknown distribution"


def _imported(entry: EntryPoint) -> object:
    try:
        return entry.load()
    except Exception as error:
        raise PluginError(
            f"plug-in '{entry.name}' of distribution '{_distribution(entry)}' does not load: {error!r}"
        ) from error


def _register(
    manager: pluggy.PluginManager, owners: dict[str, str], name: str, distribution: str, plugin: object
) -> None:
    if name in owners:
        raise PluginError(f"plug-in name '{name}' is used by both '{owners[name]}' and '{distribution}'")
    try:
        manager.register(plugin, name)
        manager.check_pending()
    except (ValueError, pluggy.PluginValidationError) as error:
        raise PluginError(f"plug-in '{name}' of distribution '{distribution}': {error}") from error
    owners[name] = distribution


def _collect(manager: pluggy.PluginManager, owners: Mapping[str, str]) -> Contributions:
    catalogue: list[Contribution] = []

    def items(sort: str, named: Callable[[Item], object]) -> list[tuple[str, Item]]:
        found = list(_declared(manager, owners, sort))
        catalogue.extend(
            Contribution(plugin, owners[plugin], sort, _shown(named(item))) for plugin, item in found
        )
        return found

    metamodels = items("metamodels", lambda m: m.ns_uri)
    constraints = items("constraints", lambda c: c.code)
    rules = items("rules", lambda r: r.name)
    by_key("rule", rules, lambda r: r.name)
    robot_kinds = items("robot_kinds", lambda k: k.name)
    move_kinds = items("move_kinds", lambda k: k.metaclass)
    checks = items("checks", lambda c: c.name)
    targets = items("targets", lambda t: t.name)
    backends = items("backends", lambda b: b.name)
    conditions = items("conditions", lambda c: c.identifier)
    symbols = items("map_symbols", lambda s: s.metaclass)
    commands = items("commands", lambda c: c.name)
    sources = tuple(by_key("metamodel", metamodels, lambda m: m.ns_uri).values())
    return Contributions(
        languages=registry_with(sources),
        metamodels=sources,
        constraints=tuple(by_key("constraint", constraints, lambda c: c.code).values()),
        rules=by_key("rule for", rules, lambda r: r.metaclass),
        robot_kinds=by_key("robot kind for", robot_kinds, lambda k: k.metaclass),
        move_kinds=by_key("move kind for", move_kinds, lambda k: k.metaclass),
        checks=tuple(by_key("check", checks, lambda c: c.name).values()),
        targets=by_key("target", targets, lambda t: t.name),
        backends=by_key("backend", backends, lambda b: b.name),
        conditions=by_key("condition", conditions, lambda c: c.identifier),
        map_symbols=by_key("map symbol for", symbols, lambda s: s.metaclass),
        commands=tuple(by_key("command", commands, lambda c: c.name).values()),
        catalogue=tuple(sorted(catalogue, key=lambda c: (c.plugin, c.sort, c.name))),
    )


def _declared(
    manager: pluggy.PluginManager, owners: Mapping[str, str], sort: str
) -> Iterable[tuple[str, Any]]:
    hook = getattr(manager.hook, f"mmrs_{sort}")
    for implementation in sorted(hook.get_hookimpls(), key=lambda each: each.plugin_name):
        name = implementation.plugin_name
        try:
            declared = tuple(implementation.function())
        except Exception as error:
            raise PluginError(
                f"plug-in '{name}' of distribution '{owners[name]}': mmrs_{sort} fails: {error!r}"
            ) from error
        for item in declared:
            yield name, item


def _shown(name: object) -> str:
    return "#//".join(str(part) for part in name) if isinstance(name, tuple) else str(name)
