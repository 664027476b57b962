"""Colours stand in one place: whoever changes them there changes every page and picture."""

import re
from pathlib import Path

import pytest

from mmrs_core import pictures
from mmrs_core.pictures.palette import COLOURS, fixed, variables

HOME = Path(pictures.__file__).parent
SOURCES = [file for file in HOME.rglob("*") if file.suffix in (".py", ".css", ".j2", ".js")]
NOT_COLOURS = {"lift", "k"}


def test_no_module_or_template_names_a_colour_of_its_own():
    literal = re.compile(r"(?<!&)#[0-9a-fA-F]{3,8}\b|\brgba?\(")
    named = {file.name for file in SOURCES if literal.search(file.read_text("utf-8"))}
    assert named == {"palette.py"}


@pytest.mark.parametrize("file", [file for file in SOURCES if file.suffix != ".py"], ids=lambda f: f.name)
def test_every_colour_that_a_template_uses_is_in_the_palette(file):
    used = set(re.findall(r"var\(--([a-z0-9-]+)", file.read_text("utf-8"))) - NOT_COLOURS
    assert used - {"series-"} <= set(COLOURS)


def test_a_page_has_light_and_dark_colours_and_a_picture_only_light_ones():
    light, dark = variables().split("@media")
    assert all(f"--{name}: {pair[0]};" in light for name, pair in COLOURS.items())
    assert all(f"--{name}: {pair[1]};" in dark for name, pair in COLOURS.items())
    assert fixed("a { fill: var(--bad) }") == f"a {{ fill: {COLOURS['bad'][0]} }}"
