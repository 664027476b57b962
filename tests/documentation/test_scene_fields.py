"""The page about hooks tells what rules and kinds work with; `--update-golden` writes that part anew."""

import inspect
import re
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from mmrs_core import scene
from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.diagnostics import Place

PAGE = Path(__file__).parents[2] / "docs" / "hooks.md"
MARK = "<!-- made from mmrs_core.scene -->\n"
TOLD = (
    scene.Task,
    scene.Part,
    scene.Robot,
    scene.RobotType,
    scene.Capability,
    scene.Kinematics,
    scene.Work,
    scene.Stroke,
    scene.ActionAt,
    scene.Look,
    scene.Coverage,
    scene.Scene,
    MoveSpec,
)
ENTRY = re.compile(r"(?:^|(?:[.;]) )(\w+(?:, \w+)*): ")


def words_of(told):
    """Return what a class is, and what its docstring says of each field."""
    summary, _, rest = inspect.getdoc(told).partition("\nAttributes:\n")
    lines = []
    for line in inspect.cleandoc(f"\n{rest}").splitlines():
        if line.startswith(" "):
            lines[-1] += f" {line.strip()}"
        else:
            lines.append(line)
    entries = (entry for line in lines for entry in entries_of(line, {field.name for field in fields(told)}))
    return summary.strip(), {name: words for names, words in entries for name in names.split(", ")}


def entries_of(line, known):
    """Yield names and words of the fields that a line is about: ``a: first; b, c: second.``."""
    parts = ENTRY.split(line)
    names, words = parts[1], parts[2]
    for following, more in zip(parts[3::2], parts[4::2], strict=True):
        if set(following.split(", ")) <= known:
            yield names, words.rstrip(".;")
            names, words = following, more
        else:
            words += f"; {following}: {more}"
    yield names, words.rstrip(".")


def section_of(told):
    summary, words = words_of(told)
    lines = [f"### `{told.__name__}`", "", summary, ""]
    for field in fields(told):
        default = (
            "" if field.default is MISSING else f" = {field.default!r}".replace(repr(Place()), "Place()")
        )
        said = words.get(field.name, "")
        lines.append(f"- `{field.name}: {field.type}{default}`{said and ': '}{said}")
    return "\n".join(lines)


@pytest.fixture(scope="module")
def made():
    return "\n" + "\n\n".join(map(section_of, TOLD)) + "\n"


def test_the_part_about_the_scene_is_current(made, update_golden):
    head, mark, told = PAGE.read_text(encoding="utf-8").partition(MARK)
    assert mark
    if update_golden:
        PAGE.write_text(head + mark + made, encoding="utf-8", newline="\n")
        told = made
    assert told == made


@pytest.mark.parametrize("told", TOLD)
def test_docstrings_speak_of_fields_that_exist(told):
    assert set(words_of(told)[1]) - {field.name for field in fields(told)} == set()


@pytest.mark.parametrize(
    ("name", "words"),
    [("attributes", "grounded to `Position`"), ("strokes", "in an order that is good to follow")],
)
def test_what_a_rule_author_needs_is_told(made, name, words):
    assert re.search(rf"^- `{name}: .*{re.escape(words)}", made, re.MULTILINE)
