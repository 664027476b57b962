"""What a plug-in object declares, asked of it without loading any other plug-in."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

import pytest

from mmrs_core import builtin
from mmrs_core.contributions.registry import Contributions
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with
from mmrs_core.plugins import load_plugins


def declared(plugin: object, sort: str) -> tuple[Any, ...]:
    """Return what a plug-in declares of a sort, such as ``rules``; nothing where it has no such hook."""
    hook = getattr(plugin, f"mmrs_{sort}", None)
    return tuple(hook()) if hook is not None else ()


SORTS = {
    "rule": "rules",
    "constraint": "constraints",
    "fix": "fixes",
    "robot_kind": "robot_kinds",
    "move_kind": "move_kinds",
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
        more_metamodels: those that tests need beside the plug-in's own.
        more_sorts: as `SORTS`, for hooks of plug-ins.
    """

    plugin: ClassVar[object]
    name: ClassVar[str] = "tested"
    more_metamodels: ClassVar[Iterable[MetamodelSource]] = ()
    more_sorts: ClassVar[tuple[str, ...]] = ()

    @pytest.fixture(scope="class")
    @classmethod
    def registry(cls) -> Registry:
        """Return the core's metamodels with the plug-in's and those of the tests."""
        return registry_with((*declared(cls.plugin, "metamodels"), *cls.more_metamodels))

    @pytest.fixture(scope="class")
    @classmethod
    def alone(cls) -> Contributions:
        """Return what the core and this plug-in contribute, without any other."""
        return cls.with_core()

    @classmethod
    def with_core(cls) -> Contributions:
        """Return what the core and this plug-in contribute, without any other."""
        extra = {} if cls.plugin is builtin else {cls.name: cls.plugin}
        return load_plugins(only_core=True, extra=extra).contributions

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run a test once for each descriptor of the sort that one of its arguments is named after."""
        for argument, sort in SORTS.items():
            if argument in metafunc.fixturenames:
                items = declared(self.plugin, sort)
                metafunc.parametrize(argument, items, ids=[_label(item) for item in items])


def _label(item: Any) -> str:
    named = (getattr(item, name, "") for name in ("code", "name", "property"))
    return next(filter(None, named), "") or str(item.metaclass[1])
