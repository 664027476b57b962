"""``mmrs demo``: a whole mission, from models to a simulated run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.completion import example_names
from mmrs_core.cli.examples import also_called, demo_settings_of, example_folder, examples
from mmrs_core.cli.output import answer
from mmrs_core.cli.session import CommandStages, Session
from mmrs_core.cli.settings import Json, settings_of

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
    from mmrs_core.cli.demonstration import demonstrate  # imports every stage

    if list_examples:
        return _list_examples(json)
    folder = example_folder(example)

    stages = CommandStages(Session(settings_of(call)), folder)
    made = demonstrate(stages, folder, out, demo_settings_of(folder), examples().values())
    answer(made.summary(), made.lines(), as_json=json)
    return 0 if made.succeeded else 1


def _list_examples(json: bool) -> int:
    found = examples()
    called = {name: " or ".join(filter(None, (name, also_called(each)))) for name, each in found.items()}
    lines = (f"{called[name]}  ({folder})" for name, folder in found.items())
    answer({"examples": found}, lines, as_json=json)
    return 0
