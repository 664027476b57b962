"""The page about hooks tells what contributions work with; `--update-golden` writes those parts anew."""

import inspect
import re
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from mmrs_core import scene
from mmrs_core.behaviour import program
from mmrs_core.contributions.checks import CheckInput, Verdict
from mmrs_core.contributions.rules import MoveSpec
from mmrs_core.contributions.targets import FileSpec, GeneratedFile, TargetInput, TracedStep
from mmrs_core.diagnostics import Place

PAGE = Path(__file__).parents[2] / "docs" / "hooks.md"
TOLD = {
    "mmrs_core.scene": (
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
        scene.Gap,
        scene.Scene,
        MoveSpec,
    ),
    "mmrs_core.behaviour.program": (
        CheckInput,
        Verdict,
        TargetInput,
        FileSpec,
        GeneratedFile,
        TracedStep,
        program.Program,
        program.RobotProgram,
        program.Move,
        program.MoveTarget,
        program.Heading,
        program.Action,
        program.Transition,
    ),
}
END = "<!-- until here -->\n"
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


def made_of(part):
    return "\n" + "\n\n".join(map(section_of, TOLD[part])) + "\n\n"


@pytest.fixture(scope="module")
def made():
    return "".join(map(made_of, TOLD))


@pytest.mark.parametrize("part", TOLD)
def test_what_is_made_from_docstrings_is_current(part, update_golden):
    head, mark, rest = PAGE.read_text(encoding="utf-8").partition(f"<!-- made from {part} -->\n")
    told, end, tail = rest.partition(END)
    assert mark
    assert end
    if update_golden:
        told = made_of(part)
        PAGE.write_text(head + mark + told + end + tail, encoding="utf-8", newline="\n")
    assert told == made_of(part)


@pytest.mark.parametrize("told", [each for part in TOLD.values() for each in part])
def test_docstrings_speak_of_fields_that_exist(told):
    assert set(words_of(told)[1]) - {field.name for field in fields(told)} == set()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("attributes", "grounded to `Position`"),
        ("strokes", "in an order that is good to follow"),
        ("distance", "of a GoTo"),
    ],
)
def test_what_an_author_needs_is_told(made, name, words):
    assert re.search(rf"^- `{name}: .*{re.escape(words)}", made, re.MULTILINE)
