"""Finds the installed plug-ins and collects what they contribute."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any

import pluggy

from mmrs_core import builtin, hookspecs
from mmrs_core.contributions.guard import guarded
from mmrs_core.contributions.hooks import Hook
from mmrs_core.contributions.registry import CORE_HOOKS, Contributions, called
from mmrs_core.errors import PluginError

if TYPE_CHECKING:
    from mmrs_core.languages.metaclass import Package
    from mmrs_runtime.records.steps import StepRecord

GROUP = "mmrs.plugins"
_CORE = builtin.__name__
_GONE: Mapping[str, str] = {
    "mmrs_dialects": "implement 'mmrs_importers'",
    "mmrs_backends": "implement 'mmrs_vehicles'",
}
"""Hooks of earlier versions, and what takes their place."""


@dataclass(frozen=True, slots=True)
class Plugins:
    """The loaded plug-ins.

    Attributes:
        contributions: all that they declare.
        distributions: where each comes from, by the plug-in's name.
    """

    contributions: Contributions
    distributions: Mapping[str, str]
    _manager: pluggy.PluginManager = field(repr=False)

    def observe_stage(self, stage: str, result: object) -> Mapping[str, BaseException]:
        """Notify every observer that a stage has finished; return their exceptions, by observer."""
        return self._observed("mmrs_stage_finished", stage=stage, result=result)

    def observe_step(self, record: StepRecord) -> Mapping[str, BaseException]:
        """Notify every observer that a step was executed; return their exceptions, by observer."""
        return self._observed("mmrs_step_executed", record=record)

    def _observed(self, hook: str, **seen: object) -> Mapping[str, BaseException]:
        """Call a hook for one plug-in after another, so that none keeps the others from seeing it."""
        failed: dict[str, BaseException] = {}
        for implementation in getattr(self._manager.hook, hook).get_hookimpls():
            name = implementation.plugin_name
            others = [each for each in self._manager.get_plugins() if each is not implementation.plugin]
            try:
                self._manager.subset_hook_caller(hook, others)(**seen)
            except (Exception, SystemExit) as error:
                failed[f"plug-in '{name}' of distribution '{self.distributions[name]}'"] = error
        return failed


def load_plugins(
    *, only_core: bool = False, extra: Mapping[str, object] | None = None, quiet_migration: bool = False
) -> Plugins:
    """Return the installed plug-ins, loaded in the order of their names.

    Args:
        only_core: leave out everything but the core's own contributions.
        extra: plug-in objects beside the installed ones, by name.
        quiet_migration: do not list what is not just as it was in models of other tools.

    Raises:
        PluginError: if a plug-in does not import, misspells a hook or has one that is gone, or two have one
            name; names the distribution. Conflicting contributions are raised when they are first asked for.
    """
    manager = pluggy.PluginManager("mmrs")
    manager.add_hookspecs(hookspecs)
    distributions: dict[str, str] = {}
    for name, distribution, plugin in _found(only_core, extra or {}):
        if name in distributions:
            raise PluginError(
                f"plug-in name '{name}' is used by both '{distributions[name]}' and '{distribution}'"
            )
        _register(manager, name, distribution, plugin)
        distributions[name] = distribution
    hooks = _specified(manager, distributions)
    _refuse_unknown(manager, distributions)

    @cache
    def declared(sort: str) -> tuple[tuple[str, Any], ...]:
        return tuple(_declared(manager, distributions, hooks.get(sort) or CORE_HOOKS[sort]))

    contributions = Contributions(declared, distributions, quiet_migration=quiet_migration)
    return Plugins(contributions, distributions, manager)


@cache
def language(ns_uri: str) -> Package:
    """Return a language as the installed plug-ins bring it; its members are the classes to subclass.

    A plug-in asks for it when its hooks are called, not when its module is imported.

    Raises:
        ValueError: if no plug-in brings it, with the nearest nsURI.
        PluginError: as `load_plugins`.
    """
    from mmrs_core.languages.registry import registry_with  # the help needs plug-ins, but no language

    return registry_with(load_plugins().contributions.metamodels).package(ns_uri)


def _found(only_core: bool, extra: Mapping[str, object]) -> Iterator[tuple[str, str, object]]:
    yield "core", "mmrs-core", builtin
    installed: Iterable[EntryPoint] = () if only_core else entry_points(group=GROUP)
    for entry in sorted(installed, key=lambda entry: (entry.name, entry.value)):
        if entry.value != _CORE:
            yield entry.name, _distribution(entry), _imported(entry)
    for name, plugin in sorted(extra.items()):
        yield name, "given by the caller", plugin


def _distribution(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist else "unknown distribution"


def _imported(entry: EntryPoint) -> object:
    try:
        return entry.load()
    except Exception as error:
        raise PluginError(
            f"plug-in '{entry.name}' of distribution '{_distribution(entry)}' does not load: {error!r}"
        ) from error


def _register(manager: pluggy.PluginManager, name: str, distribution: str, plugin: object) -> None:
    for gone, instead in _GONE.items():
        if hasattr(plugin, gone) and manager.parse_hookimpl_opts(plugin, gone) is not None:
            whose = f"plug-in '{name}' of distribution '{distribution}'"
            raise PluginError(f"{whose}: hook '{gone}' is gone: {instead}")
    try:
        manager.register(plugin, name)
    except (ValueError, pluggy.PluginValidationError) as error:
        raise PluginError(f"plug-in '{name}' of distribution '{distribution}': {error}") from error


def _specified(manager: pluggy.PluginManager, distributions: Mapping[str, str]) -> dict[str, Hook]:
    """Add the hooks that plug-ins specify; return them by what they declare, such as ``kite_lines``."""
    found: dict[str, Hook] = {}
    for name, hook in _declared(manager, distributions, CORE_HOOKS["hooks"]):
        source = f"plug-in '{name}' of distribution '{distributions[name]}'"
        if hook.sort in CORE_HOOKS or hook.sort in found:
            raise PluginError(f"{source}: hook '{hook.name}' is specified already")

        @hookspecs.hookspec
        def declare() -> Iterable[object]:  # type: ignore[empty-body]
            pass

        try:
            manager.add_hookspecs(type("Specified", (), {hook.name: staticmethod(declare)}))
        except pluggy.PluginValidationError as error:
            whose = manager.get_name(error.plugin) or ""
            raise PluginError(
                f"plug-in '{whose}' of distribution '{distributions.get(whose)}': {error}"
            ) from error
        found[hook.sort] = hook
    return found


def _refuse_unknown(manager: pluggy.PluginManager, distributions: Mapping[str, str]) -> None:
    """Raise PluginError for an implementation of a hook that neither the core nor a plug-in specifies."""
    for name, distribution in distributions.items():
        plugin = manager.get_plugin(name)
        for caller in manager.get_hookcallers(plugin) or ():
            own = (each for each in caller.get_hookimpls() if each.plugin is plugin)
            if not caller.has_spec() and not any(each.optionalhook for each in own):
                source = f"plug-in '{name}' of distribution '{distribution}'"
                raise PluginError(
                    f"{source}: unknown hook '{caller.name}': install the plug-in that specifies it, or"
                    " implement it with 'hookimpl(optionalhook=True)'"
                )


def _declared(
    manager: pluggy.PluginManager, distributions: Mapping[str, str], hook: Hook
) -> Iterator[tuple[str, Any]]:
    """Yield what plug-ins declare by a hook."""
    kind = _kind(hook)
    implementations = getattr(manager.hook, hook.name).get_hookimpls()
    for implementation in sorted(implementations, key=lambda each: each.plugin_name):
        name = implementation.plugin_name
        try:
            items = tuple(implementation.function())
        except Exception as error:
            raise PluginError(
                f"plug-in '{name}' of distribution '{distributions[name]}': {hook.name} fails: {error!r}"
            ) from error
        source = f"plug-in '{name}' of distribution '{distributions[name]}'"
        for item in items:
            if not isinstance(item, kind):
                raise PluginError(
                    f"{source}: {hook.name} gives a {type(item).__name__}, not a {kind.__name__}"
                )
            yield name, item if name == "core" else guarded(item, f"{source}: {called(hook, item)}")


def _kind(hook: Hook) -> type:
    """Return what a hook declares; imported now, since no command needs every sort."""
    module, _, name = hook.descriptor.partition(":")
    kind: type = getattr(import_module(module), name)
    return kind
