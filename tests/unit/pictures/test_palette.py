"""Colours stand in one place: whoever changes them there changes every page and picture."""

import ast
import re
from pathlib import Path

import pytest

from mmrs_core import pictures
from mmrs_core.pictures.palette import COLOURS, fixed, variables

HOME = Path(pictures.__file__).parent
TOP = HOME.parent.parent
CORE = TOP / "mmrs_core"
LITERAL = re.compile(r"(?<!&)#(?:[0-9a-fA-F]{3,4}){1,2}\b|\b(?:rgb|hsl)a?\(")
SHIPPED = [
    file
    for folder in ("mmrs_core", "runtime", "plugins", "codegen_templates")
    for file in (TOP / folder).rglob("*")
    if file.suffix in (".py", ".css", ".j2", ".js", ".html", ".svg")
    and not {"tests", "build", ".venv", "node_modules"} & set(file.relative_to(TOP).parts)
]
SOURCES = [file for file in HOME.rglob("*") if file.suffix in (".py", ".css", ".j2", ".js")]
NOT_COLOURS = {"lift", "k"}


def colours_in(file):
    """Return the lines of a file that name a colour, other than as the colour of a plug-in's symbol."""
    words = file.read_text("utf-8")
    if not LITERAL.search(words):
        return []
    if file.suffix == ".py":
        nodes = list(ast.walk(ast.parse(words)))
        symbols = [
            node
            for node in nodes
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "MapSymbol"
        ]
        own = (
            {id(argument) for call in symbols for argument in call.args[2:3]}
            if CORE not in file.parents
            else set()
        )
        texts = [node for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        return [node.lineno for node in texts if id(node) not in own and LITERAL.search(node.value)]
    return [number for number, line in enumerate(words.splitlines(), start=1) if LITERAL.search(line)]


def test_no_shipped_file_names_a_colour_of_its_own_except_plugins_for_their_symbols():
    found = {str(file.relative_to(TOP)) for file in SHIPPED if colours_in(file)}
    assert found == {"mmrs_core/pictures/palette.py"}


@pytest.mark.parametrize("file", [file for file in SOURCES if file.suffix != ".py"], ids=lambda f: f.name)
def test_every_colour_that_a_template_uses_is_in_the_palette(file):
    used = set(re.findall(r"var\(--([a-z0-9-]+)", file.read_text("utf-8"))) - NOT_COLOURS
    assert used - {"series-"} <= set(COLOURS)


def test_a_page_has_light_and_dark_colours_and_a_picture_only_light_ones():
    light, dark = variables().split("@media")
    assert all(f"--{name}: {pair[0]};" in light for name, pair in COLOURS.items())
    assert all(f"--{name}: {pair[1]};" in dark for name, pair in COLOURS.items())
    assert fixed("a { fill: var(--bad) }") == f"a {{ fill: {COLOURS['bad'][0]} }}"
