"""What every descriptor of the shipped plug-ins must be, whatever it is about."""

import re
from importlib import import_module
from importlib.metadata import distribution
from pathlib import Path

import pytest

ON_BOARD = {"auv": ["auv-vessel", "mmrs-runtime"]}
"""Requirements of plug-ins whose controllers run on board without the core."""
NAMES = ("auv", "multicopter", "rover", "survey")
CODE = {"auv": "AUV", "multicopter": "MUL", "rover": "ROV", "survey": "SUR"}
ROOT = Path(__file__).parents[3]


def of(name, sort):
    declare = getattr(import_module(f"mmrs_{name}.plugin"), f"mmrs_{sort}", tuple)
    return list(declare())


@pytest.mark.parametrize("name", NAMES)
def test_constraints_are_numbered_without_a_gap_under_the_plugins_code(name):
    found = of(name, "constraints")
    assert [each.code for each in found] == [f"{CODE[name]}{i:03d}" for i in range(1, len(found) + 1)]


@pytest.mark.parametrize("name", NAMES)
def test_every_constraint_of_a_plugin_is_counted_in_its_readme(name):
    readme = (ROOT / "plugins" / name / "README.md").read_text(encoding="utf-8")
    codes = [each.code for each in of(name, "constraints")]
    assert f"{codes[0]} to {codes[-1]}" in readme


@pytest.mark.parametrize("name", NAMES)
def test_the_models_in_a_readme_conform_to_the_languages(plugins, name):
    from mmrs_core.languages.conformance import check_conformance
    from mmrs_core.languages.reading import read_text

    languages = plugins.contributions.languages
    readme = (ROOT / "plugins" / name / "README.md").read_text(encoding="utf-8")
    models = re.findall(r"```xml\n(.*?)```", readme, re.DOTALL)
    assert models
    for model in models:
        whole = model if model.startswith("<?xml") else _in_a_model(model)
        found = read_text(whole.encode(), "README.md", languages)
        assert (*found.diagnostics, *check_conformance(found, languages)) == ()


def _in_a_model(part):
    prefixes = " ".join(f'xmlns:{name}="urn:mmrs:{name}:1.0"' for name in ("mission", "survey"))
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    if part.startswith("<devices"):
        size = '<size width="1.0" length="1.0" height="1.0" weight="1.0"/>'
        robot = f'<robot:Robot xmlns:robot="urn:mmrs:robot:1.0" {xsi} name="t">'
        speed = '<movementCapabilities><speed min="0.0" max="1.0"/></movementCapabilities>'
        return f"{robot}{size}{part}{speed}</robot:Robot>"
    home = '<home xsi:type="mission:RelativeCoordinate" x="0.0" y="0.0"/>'
    team = f'<team><robots name="a" type="t">{home}</robots></team>'
    return f"<mission:Mission {prefixes} {xsi}>{team}{part}</mission:Mission>"


@pytest.mark.parametrize("name", NAMES)
def test_a_plugin_is_a_distribution_of_its_own(name):
    found = distribution(f"mmrs-{name}")
    (entry,) = [each for each in found.entry_points if each.group == "mmrs.plugins"]
    assert (entry.name, entry.value) == (name, f"mmrs_{name}.plugin")
    needed = [each for each in found.requires or [] if "extra ==" not in each]
    assert [re.split(r"[>\[]", each)[0] for each in needed] == ON_BOARD.get(name, ["mmrs-core"])
