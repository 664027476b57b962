"""``mmrs demo``: a whole mission, from models to a simulated run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.completion import example_names
from mmrs_core.cli.demonstration import demonstrate, manner_of
from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.session import Session, Stages
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import UnreadableError
from mmrs_core.resources import shipped

DEFAULT = "carbon-dioxide"


def demo(
    call: typer.Context,
    example: Annotated[
        str,
        typer.Argument(
            metavar="EXAMPLE", help="Name of the example. See --list.", autocompletion=example_names
        ),
    ] = DEFAULT,
    out: Annotated[
        Path, typer.Option("-o", "--output", "--out", metavar="DIR", help="Output folder.")
    ] = Path("mmrs-demo"),
    list_examples: Annotated[bool, typer.Option("--list", help="List the examples.")] = False,
    json: Json = False,
) -> int:
    """Run an example end to end.

    Plans the mission, verifies the behaviour, generates controllers, simulates the run, checks its logs and
    draws the mission.

    Example: mmrs demo pool
    """
    if list_examples:
        return _list_examples(json)
    folder = example_folder(example)

    stages = Stages(Session(settings_of(call)), folder)
    made = demonstrate(stages, folder, out, manner_of(folder), examples().values())
    if json:
        say_json(made.summary())
    else:
        for line in made.lines():
            say(line)
    return 0 if made.succeeded else 1


def example_folder(name: str) -> Path:
    """Return the folder of a shipped example.

    Raises:
        UnreadableError: if there is none of that name.
    """
    known = examples()
    known |= {also: folder for folder in known.values() if (also := also_called(folder))}
    if name not in known:
        raise UnreadableError(f"{name}: unknown example; there are {', '.join(known)}")
    return known[name]


def examples() -> dict[str, Path]:
    """Return the folders of the shipped missions by name, sorted."""
    return {
        mission.parent.name: mission.parent for mission in sorted(shipped("examples").glob("*/mission.xmi"))
    }


def also_called(folder: Path) -> str:
    """Return a shorter name of an example; empty: it has none."""
    return manner_of(folder).also


def _list_examples(json: bool) -> int:
    found = examples()
    if json:
        say_json({"examples": found})
    else:
        for name, folder in found.items():
            also = also_called(folder)
            say(f"{name}{f' or {also}' if also else ''}  ({folder})")
    return 0
