"""The page about hooks tells what contributions work with; `--update-golden` writes those parts anew."""

import inspect
import re
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from pathlib import Path

import pytest

from mmrs_core import scene
from mmrs_core.behaviour import program
from mmrs_core.contributions.checks import CheckInput, Verdict
from mmrs_core.contributions.constraints import Finding
from mmrs_core.contributions.fixes import Wrong
from mmrs_core.contributions.rules import MoveKind, MoveSpec
from mmrs_core.contributions.targets import FileSpec, GeneratedFile, TargetInput, TracedStep
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.diagnostics import Place
from mmrs_core.generation import planned_moves
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.xmi.markup import Attribute, Tag
from mmrs_core.planning import coverage, open_lines, positions
from mmrs_core.scene import attributes
from mmrs_core.transformation import kinds
from mmrs_runtime import vehicle
from mmrs_runtime.policies import Policy

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
        scene.Repetition,
        scene.Look,
        scene.Coverage,
        scene.Gap,
        scene.Scene,
        scene.Area,
        scene.AreaUse,
        scene.Corridor,
        scene.Device,
        scene.DeviceAction,
        scene.Battery,
        scene.Frame,
        MoveSpec,
        kinds.kinematics_for,
        kinds.straight_travel,
        MoveKind,
        attributes.number,
        attributes.text,
        attributes.flag,
        attributes.position,
        attributes.positions,
        attributes.ring,
        attributes.holes,
        attributes.pairs,
        attributes.element_called,
        positions.refuse_heights,
        positions.refuse_blocked,
        positions.refuse_unsteady,
        coverage.work_over,
        coverage.Sweep,
        open_lines.work_along,
    ),
    "mmrs_runtime.vehicle": (
        VehicleInput,
        vehicle.Vehicle,
        vehicle.VehicleState,
        vehicle.Fault,
        vehicle.Sample,
        Wrong,
        Tag,
        Attribute,
        Finding,
        ModelSet,
    ),
    "mmrs_core.behaviour.program": (
        CheckInput,
        Verdict,
        TargetInput,
        planned_moves.planned_moves,
        planned_moves.PlannedMove,
        planned_moves.kinematics_of,
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
        Policy,
    ),
}
WITH_PROPERTIES = (program.Move, program.Action, program.Transition)
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
    inherited = words_of(told.__base__)[1] if is_dataclass(told.__base__) else {}
    own = {name: words for names, words in entries for name in names.split(", ")}
    return summary.strip(), inherited | own


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


def parts_of(told):
    """Return a docstring's description, and its sections by name."""
    description, *others = re.split(r"\n\n(?=(?:Args|Raises|Returns|Attributes):\n)", inspect.getdoc(told))
    return description.strip(), {name: text for name, _, text in (other.partition(":\n") for other in others)}


def signature_of(function):
    """Return the arguments of a function and what it returns, as its source has them; without self."""
    written = re.sub(r"'([A-Za-z_][^']*)'", r"\1", str(inspect.signature(function)))
    return written.replace("(self, ", "(").replace("(self)", "()")


def section_of_function(told):
    """Return what a function is called with, does and raises."""
    description, parts = parts_of(told)
    arguments = re.split(r"\n    (?=\w)", f"\n{parts['Args']}") if "Args" in parts else []
    pairs = (re.sub(r"\s+", " ", each).partition(":") for each in arguments if each.strip())
    lines = [f"- `{name.strip()}`: {words.strip()}" for name, _, words in pairs]
    raises = re.sub(r"\s+", " ", parts.get("Raises", "")).strip()
    call = f"`{told.__name__}{signature_of(told)}` of `{told.__module__}`"
    blocks = [f"### `{told.__name__}`", call, description, "\n".join(lines), raises and f"Raises {raises}"]
    return "\n\n".join(filter(None, blocks))


def section_of_methods(told):
    """Return what each method of an abstract class does; those that must be defined first."""
    methods = [each for each in vars(told).values() if callable(each) or isinstance(each, property)]
    methods = [each for each in methods if getattr(each, "__doc__", "") and not isinstance(each, type)]
    ordered = sorted(methods, key=lambda each: not getattr(each, "__isabstractmethod__", False))
    lines = []
    for each in ordered:
        function = each.fget if isinstance(each, property) else each
        must = " Required." if getattr(each, "__isabstractmethod__", False) else ""
        summary = inspect.getdoc(each).partition("\n")[0]
        shown = (
            function.__name__
            if isinstance(each, property)
            else f"{function.__name__}{signature_of(function)}"
        )
        lines.append(f"- `{shown}`: {summary}{must}")
    return "\n".join([f"### `{told.__name__}`", "", parts_of(told)[0], "", *lines])


def section_of(told):
    if inspect.isfunction(told):
        return section_of_function(told)
    if isinstance(told, type) and issubclass(told, Enum):
        return "\n".join(
            [f"### `{told.__name__}`", "", inspect.getdoc(told), "", *(f"- `{each}`" for each in told)]
        )
    if not is_dataclass(told):
        return section_of_methods(told)
    summary, words = words_of(told)
    lines = [f"### `{told.__name__}`", "", summary, ""]
    for field in fields(told):
        default = (
            "" if field.default is MISSING else f" = {field.default!r}".replace(repr(Place()), "Place()")
        )
        said = words.get(field.name, "")
        lines.append(f"- `{field.name}: {field.type}{default}`{said and ': '}{said}")
    for name, each in vars(told).items():
        if isinstance(each, property) and told in WITH_PROPERTIES:
            lines.append(f"- `{name}: {each.fget.__annotations__['return']}`: {said_of(each)}")
    return "\n".join(lines)


def said_of(property):
    """Return what a property is, as the docstring of its function says what that returns."""
    return inspect.getdoc(property).removeprefix("Return ").rstrip(".")


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


@pytest.mark.parametrize("told", [each for part in TOLD.values() for each in part if is_dataclass(each)])
def test_docstrings_speak_of_fields_that_exist(told):
    assert set(words_of(told)[1]) - {field.name for field in fields(told)} == set()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("attributes", "grounded to `Position`"),
        ("strokes", "in an order that is good to follow"),
        ("distance", "of a GoTo"),
        ("flow", "name of the environment's attribute"),
        ("options", "as in ``--backend-option``"),
    ],
)
def test_what_an_author_needs_is_told(made, name, words):
    assert re.search(rf"^- `{name}[:`].*{re.escape(words)}", made, re.MULTILINE)
