"""The page about hooks tells every hook with its exact signature, and its examples work."""

import inspect
import re
from pathlib import Path

import pytest

from mmrs_core import hookspecs
from mmrs_core.plugins import load_plugins

PAGE = (Path(__file__).parents[2] / "docs" / "hooks.md").read_text(encoding="utf-8")
OF_PLUGINS = load_plugins().contributions.hooks
SIGNATURES = {
    name: f"{name}{inspect.signature(hook)}".replace("'", "")
    for name, hook in vars(hookspecs).items()
    if name.startswith("mmrs_")
} | {name: f"{name}() -> Iterable[{hook.descriptor.partition(':')[2]}]" for name, hook in OF_PLUGINS.items()}
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


def implemented_by(example):
    return [name for name in SIGNATURES if f"def {name}(" in example]


@pytest.mark.parametrize("name", SIGNATURES)
def test_every_hook_is_told_with_its_exact_signature(name):
    assert f"\n### `{SIGNATURES[name]}`\n" in PAGE


def test_no_hook_is_told_that_does_not_exist():
    assert set(re.findall(r"^### `(\w+)\(", PAGE, re.MULTILINE)) == set(SIGNATURES)


@pytest.mark.parametrize("name", SIGNATURES)
def test_every_hook_has_an_example(name):
    assert [example for example in EXAMPLES if name in implemented_by(example)]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: " ".join(implemented_by(example)))
def test_an_example_is_a_plugin_that_loads(example, tmp_path):
    namespace = {"__file__": str(tmp_path / "plugin.py"), "__name__": "kites"}
    exec(compile(example, "docs/hooks.md", "exec"), namespace)  # noqa: S102  the page's own code
    plugin = type("Plugin", (), {n: staticmethod(namespace[n]) for n in implemented_by(example)})()
    only_core = not OF_PLUGINS.keys() & set(implemented_by(example))
    plugins = load_plugins(only_core=only_core, extra={"kites": plugin})
    for name in implemented_by(example):
        if "() ->" not in SIGNATURES[name]:
            continue
        declared = list(namespace[name]())
        assert declared
        expected = re.search(r"Iterable\[(\w+)\]", SIGNATURES[name]).group(1)
        assert {type(each).__name__ for each in declared} == {expected}
    assert plugins.observe_stage("plan", None) == {}


def test_every_field_of_what_is_declared_is_told():
    from dataclasses import fields

    from mmrs_core.contributions import (
        checks,
        commands,
        constraints,
        drawings,
        execution,
        fixes,
        robot_types,
        rules,
        symbols,
        targets,
        vehicles,
    )
    from mmrs_core.contributions.hooks import Hook
    from mmrs_core.languages.classes import ElementClass
    from mmrs_core.languages.evolution.migration import Migration
    from mmrs_core.languages.importers import Importer
    from mmrs_mavlink.profiles import VehicleProfile
    from mmrs_mavlink.wiring import DeviceWiring

    told = {
        "mmrs_element_classes": ElementClass,
        "mmrs_migrations": Migration,
        "mmrs_importers": Importer,
        "mmrs_constraints": constraints.Constraint,
        "mmrs_fixes": fixes.Fix,
        "mmrs_rules": rules.Rule,
        "mmrs_robot_kinds": rules.RobotKind,
        "mmrs_move_kinds": rules.MoveKind,
        "mmrs_element_kinds": rules.ElementKind,
        "mmrs_checks": checks.Check,
        "mmrs_device_actions": DeviceWiring,
        "mmrs_vehicle_profiles": VehicleProfile,
        "mmrs_targets": targets.Target,
        "mmrs_vehicles": vehicles.VehicleFactory,
        "mmrs_conditions": execution.Condition,
        "mmrs_map_symbols": symbols.MapSymbol,
        "mmrs_robot_types": robot_types.RobotTypeFile,
        "mmrs_drawing_readers": drawings.DrawingReader,
        "mmrs_exporters": drawings.Exporter,
        "mmrs_commands": commands.Command,
        "mmrs_hooks": Hook,
    }
    missing = []
    for name, descriptor in told.items():
        section = PAGE.split(f"### `{name}(")[1].split("\n### ")[0]
        missing += [
            f"{name}: {field.name}" for field in fields(descriptor) if f"`{field.name}`" not in section
        ]
    assert missing == []
