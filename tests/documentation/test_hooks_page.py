"""The page about hooks tells every hook with its exact signature, and its examples work."""

import inspect
import re
from dataclasses import fields
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
def test_an_example_is_a_plugin_that_loads_and_every_field_of_what_it_declares_is_told(example, tmp_path):
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
        section = PAGE.split(f"### `{name}(")[1].split("\n### ")[0]
        assert [each.name for each in fields(declared[0]) if f"`{each.name}`" not in section] == []
    assert plugins.observe_stage("plan", None) == {}
