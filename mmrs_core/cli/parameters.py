"""The arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.modelset import model_in
from mmrs_core.languages.references.project import robot_files_in

Project = Annotated[
    Path, typer.Argument(metavar="PROJECT", help="Folder of the project, or its mission file.")
]
Behaviour = Annotated[
    Path, typer.Argument(metavar="BEHAVIOUR", help="Behaviour file, or a folder that contains behaviour.xmi.")
]
Context = Annotated[
    Path | None,
    typer.Option(
        "--context",
        metavar="FILE",
        help="Context model: obstacles, areas and wind. Default: context.xmi in the folder of the input.",
    ),
]
Robots = Annotated[
    list[Path] | None,
    typer.Option(
        "--robots",
        metavar="FILE...",
        help="Robot type files, or a folder of them. Default: robots/*.xmi in the folder of the input.",
    ),
]
Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Planner random seed.")]
LONGEST_SEARCH = 1e6
"""Seconds: eleven days."""

TimeLimit = Annotated[
    float | None,
    typer.Option(
        "--time-limit",
        metavar="SECONDS",
        min=0.0,
        max=LONGEST_SEARCH,
        help="Search time for a better plan. Default: a fixed number of steps, which gives the same plan "
        "each time.",
    ),
]
Explain = Annotated[
    bool,
    typer.Option(
        "--explain", help="Explain the plan: critical path, limits, and the cost of assigning other robots."
    ),
]

Duration = Annotated[
    float,
    typer.Option("--for", min=0.0, metavar="SECONDS", help="Stop after SECONDS; 0 runs until interrupted."),
]
Assume = Annotated[
    list[str] | None,
    typer.Option(
        "--assume",
        metavar="CONDITION=yes|no",
        help="Outcome of a condition, named by the conditionIdentifier of a Choice. Repeatable.",
    ),
]


BackendOptions = Annotated[
    list[str] | None,
    typer.Option(
        "--backend-option",
        metavar="[ROBOT:]KEY=VALUE",
        help="Setting of a backend, for all robots or one, e.g. tries=9 or Kite:tries=9. Repeatable.",
    ),
]


def robot_files(given: Iterable[Path] | None) -> tuple[Path, ...]:
    """Return the files of robot types that were named; a folder stands for all models in it.

    Raises:
        UnreadableError: if a folder holds no model.
    """
    return tuple(file for path in given or () for file in _files_of(path))


def _files_of(path: Path) -> tuple[Path, ...]:
    if not path.is_dir():
        return (path,)
    found = robot_files_in(path)
    if not found:
        raise UnreadableError(f"{path}: no robot type (*.xmi, *.json) in this folder")
    return found


def without_mission(project: Path) -> Path:
    """Return the behaviour in a folder without a mission, otherwise the path."""
    alone = model_in(project, "behaviour") if model_in(project, "mission") is None else None
    return alone or project


def behaviour_file(given: Path) -> Path:
    """Return the file of a behaviour, which a folder may stand for.

    Raises:
        UnreadableError: if the folder has none.
    """
    if not given.is_dir():
        return given
    file = model_in(given, "behaviour")
    if file is None or not file.is_file():
        raise UnreadableError(f"{given}: no behaviour.xmi in this folder; 'mmrs plan {given}' makes one")
    return file
