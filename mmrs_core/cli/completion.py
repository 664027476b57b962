"""Values that shells complete: examples, targets, robots and tasks, read without checking any model."""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import typer

from mmrs_core.cli.settings import settings_of
from mmrs_core.errors import MmrsError

if TYPE_CHECKING:
    from mmrs_core.generation.manifest import Entry

_IN_FOLDER = ("behaviour.xmi", "behaviour.json", "mission.xmi", "mission.json")
_NAMES = {"robots": ("id", "name"), "tasks": ("name",)}
"""The attributes that identify the elements of a feature, in behaviours and in missions."""


def is_completing(program: str) -> bool:
    """Return whether a shell asks for completions of a program's command line."""
    return f"_{program}_COMPLETE".replace("-", "_").upper() in os.environ


def words_to_complete() -> list[str]:
    """Return the words of the command line that a shell completes, without the program's name."""
    line = os.environ.get("COMP_WORDS") or os.environ.get("_TYPER_COMPLETE_ARGS", "")
    try:
        return shlex.split(line)[1:]
    except ValueError:  # an open quote
        return line.split()[1:]


def example_names(context: typer.Context) -> list[str]:
    """Return the names of the examples."""
    from mmrs_core.cli.examples import also_called, examples

    found = examples()
    return [*found, *filter(None, map(also_called, found.values()))]


def target_names(context: typer.Context) -> list[str]:
    """Return the names of the targets."""
    return sorted(settings_of(context).plugins().contributions.targets)


def backend_names(context: typer.Context) -> list[str]:
    """Return the names of the backends; for ``mmrs simulate``, of those in simulated time."""
    found = settings_of(context).plugins().contributions.vehicles
    simulates = context.info_name == "simulate"
    return sorted(name for name, each in found.items() if each.simulated or not simulates)


def exporter_names(context: typer.Context) -> list[str]:
    """Return the names of the formats for map programs."""
    return sorted(settings_of(context).plugins().contributions.exporters)


def one_of(*values: str) -> Callable[[], list[str]]:
    """Return what completes a value that has to be one of these."""
    return lambda: list(values)


def plugin_parts(incomplete: str) -> list[str]:
    """Return the list of parts of a new plug-in that was begun, with each part that it may continue with."""
    from mmrs_core.generation.scaffolding.files import PARTS

    before, comma, _ = incomplete.rpartition(",")
    return [f"{before}{comma}{part}" for part in PARTS if part not in before.split(",")]


def robot_names(context: typer.Context) -> list[str]:
    """Return the robots of the project or behaviour on the command line, or of the current folder."""
    return list(dict.fromkeys(_names_in(_given(context, "behaviour"), "robots")))


def running_robots(context: typer.Context) -> list[str]:
    """Return the robots with a log in the folder of ``--log``."""
    names = []
    for log in sorted(Path(str(context.params.get("log") or "logs")).glob("*.jsonl")):
        with suppress(OSError, ValueError, KeyError), log.open(encoding="utf-8") as lines:
            names.append(str(json.loads(lines.readline())["robot"]))
    return names


def generated_robots(context: typer.Context) -> list[str]:
    """Return the robots of the generated files in a folder."""
    return list(dict.fromkeys(entry.step.robot for entry in _entries(context)))


def generated_tasks(context: typer.Context) -> list[str]:
    """Return the tasks of the generated files in a folder."""
    return list(dict.fromkeys(entry.step.task for entry in _entries(context) if entry.step.task))


def _entries(context: typer.Context) -> Iterator[Entry]:
    from mmrs_core.generation.explaining import places_of

    with suppress(MmrsError, OSError):
        yield from (each.entry for each in places_of(_given(context, "where")))


def _given(context: typer.Context, parameter: str) -> Path:
    """Return the path of a parameter; it is an extra argument where the option before it lacks its value."""
    extra = [word for word in context.args if not word.startswith("-")]
    return Path(extra[0] if extra else str(context.params.get(parameter) or "."))


def _names_in(path: Path, feature: str) -> Iterator[str]:
    """Yield the names of a feature's elements in a model, or in the models of a folder."""
    files = [path / name for name in _IN_FOLDER] if path.is_dir() else [path]
    for file in files:
        with suppress(OSError, ValueError, ElementTree.ParseError):
            yield from _in_json(file, feature) if file.suffix == ".json" else _in_xmi(file, feature)


def _in_xmi(file: Path, feature: str) -> Iterator[str]:
    for _, element in ElementTree.iterparse(file):
        if element.tag == feature:
            yield from filter(None, (element.get(name) for name in _NAMES[feature]))


def _in_json(file: Path, feature: str) -> Iterator[str]:
    model = json.loads(file.read_text(encoding="utf-8"))
    roots = model.get("roots", [model])
    for holder in (part for root in roots for part in (root, root.get("team", {}))):
        for element in holder.get(feature, ()):
            yield from (str(element[name]) for name in _NAMES[feature] if name in element)
