"""What a plug-in object declares, asked of it without loading more plug-ins than it builds on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest
from hypothesis import HealthCheck, settings

from mmrs_core import builtin
from mmrs_core.behaviour.program import Move, MoveTarget
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveKind, MoveSpec, most_specific
from mmrs_core.errors import PluginError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.registry import MetamodelSource, Registry
from mmrs_core.plugins import load_plugins
from mmrs_core.scene import Position


def law(examples: int) -> settings:
    """Return the settings of a law that draws so many examples where hypothesis' profile asks for 100.

    With a profile that asks for more or fewer, it draws as many times more or fewer, but at least 5.
    """
    count = max(5, examples * settings().max_examples // 100)
    relaxed = [HealthCheck.too_slow, HealthCheck.data_too_large]
    return settings(deadline=None, max_examples=count, suppress_health_check=relaxed)


def declared(plugin: object, sort: str) -> tuple[Any, ...]:
    """Return what a plug-in declares of a sort, such as ``rules``; nothing where it has no such hook."""
    hook = getattr(plugin, f"mmrs_{sort}", None)
    return tuple(hook()) if hook is not None else ()


def made_by(
    specs: Iterable[MoveSpec], here: Position, home: Position, known: Contributions
) -> Iterator[tuple[MoveKind, Move, tuple[Position, ...] | None]]:
    """Yield each move with its kind and its path, for a robot that is `here` first; None: path unknown."""
    for spec in specs:
        metaclasses = known.languages.metaclass(*spec.metaclass).ancestry
        name = most_specific(metaclasses, known.move_kinds)
        assert name is not None, f"no kind of move for {spec.metaclass[1]}"
        target = MoveTarget(spec.target) if spec.target is not None else None
        move = Move("m", metaclasses, spec.attributes, target=target, distance=spec.distance)
        path = known.move_kinds[name].path(move, here, home)
        yield known.move_kinds[name], move, path
        here = path[-1] if path else here


SORTS = {
    "rule": "rules",
    "constraint": "constraints",
    "fix": "fixes",
    "robot_kind": "robot_kinds",
    "move_kind": "move_kinds",
    "element_kind": "element_kinds",
    "check": "checks",
    "device_action": "device_actions",
    "target": "targets",
    "vehicle": "vehicles",
    "map_symbol": "map_symbols",
}
"""Arguments of tests, which run once for each contribution that the plug-in's hook of that name returns."""


class Conformance:
    """A plug-in whose contributions are tested.

    Attributes:
        plugin: the module or object with its hooks.
        name: of its entry point; matters only where it is looked for among the installed plug-ins.
        more_plugins: those that it builds on, modules or objects with hooks: loaded with it, not tested.
        more_metamodels: those that only tests need; their classes are not tested either.
        more_sorts: as `SORTS`, for hooks of plug-ins.
    """

    plugin: object
    name: ClassVar[str] = "tested"
    more_plugins: ClassVar[Iterable[object]] = ()
    more_metamodels: ClassVar[Iterable[MetamodelSource]] = ()
    more_sorts: ClassVar[tuple[str, ...]] = ()

    @pytest.fixture(scope="class")
    @classmethod
    def registry(cls) -> Registry:
        """Return the metamodels of the core, of the plug-in, of those that it builds on and of the tests."""
        return cls.with_core().languages

    @pytest.fixture(scope="class")
    @classmethod
    def alone(cls) -> Contributions:
        """Return what the core, this plug-in and those that it builds on contribute, without any other."""
        return cls.with_core()

    @classmethod
    @cache
    def with_core(cls) -> Contributions:
        """Return what the core, this plug-in and those that it builds on contribute, without any other."""
        plugins = {f"{cls.name} builds on {index}": each for index, each in enumerate(cls.more_plugins, 1)}
        if cls.more_metamodels:
            found = tuple(cls.more_metamodels)
            plugins[f"tests of {cls.name}"] = SimpleNamespace(mmrs_metamodels=hookimpl(lambda: found))
        if cls.plugin is not builtin:
            plugins[cls.name] = cls.plugin
        contributions = load_plugins(only_core=True, extra=plugins).contributions
        try:
            assert contributions.languages
        except PluginError as error:
            hint = "name the plug-in that provides it in more_plugins, or it alone in more_metamodels"
            wanted = "needs the metamodel" in str(error)
            pytest.fail(f"{cls.__name__}: {error}{f': {hint}' if wanted else ''}", pytrace=False)
        return contributions

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run a test once for each descriptor of the sort that one of its arguments is named after."""
        for argument, sort in SORTS.items():
            if argument in metafunc.fixturenames:
                items = declared(self.plugin, sort)
                metafunc.parametrize(argument, items, ids=[_label(item) for item in items])


def _label(item: Any) -> str:
    named = (getattr(item, name, "") for name in ("code", "name", "property"))
    return next(filter(None, named), "") or str(item.metaclass[1])
