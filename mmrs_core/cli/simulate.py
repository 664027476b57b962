"""``mmrs simulate``: carries a behaviour out without robots."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.behaviours import load_behaviour
from mmrs_core.cli.completion import backend_names
from mmrs_core.cli.output import answer, written
from mmrs_core.cli.parameters import (
    Assume,
    BackendOptions,
    Behaviour,
    Context,
    Robots,
    behaviour_file,
    robot_files,
)
from mmrs_core.cli.protection import refuse_inputs
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.simulation import (
    Chosen,
    answers,
    backends_of,
    fly,
    options_of,
    run_lines,
    succeeded,
    write_logs,
)
from mmrs_runtime.records.steps import log_name


def simulate(
    call: typer.Context,
    behaviour: Behaviour,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="DIR",
            help="Folder for step logs and black boxes (simulated telemetry). Default: none are written.",
        ),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    assume: Assume = None,
    backend: Annotated[
        list[str] | None,
        typer.Option(
            "--backend",
            metavar="[ROBOT=]NAME",
            help="Simulator of all robots or one: simulation, or another one that 'mmrs plugin list' gives "
            "under vehicles. Default: simulation. Repeatable.",
            autocompletion=backend_names,
        ),
    ] = None,
    backend_option: BackendOptions = None,
    json: Json = False,
) -> int:
    """Simulate a behaviour faster than real time.

    Example: mmrs simulate field -o field/logs
    """
    session = Session(settings_of(call))
    usual, own = backends_of(backend, "simulation")
    conditions, chosen = answers(assume), Chosen(usual, options_of(backend_option), own)
    loaded = load_behaviour(session, behaviour_file(behaviour), context=context, robots=robot_files(robots))
    if output is not None:
        refuse_inputs((output / log_name(robot.id) for robot in loaded.program.robots), session.inputs)
    run = fly(session, loaded.program, loaded.place, conditions, chosen)
    known = loaded.place.types, session.contributions
    logs = write_logs(run, loaded.program, output, *known) if output is not None else ()
    found = {"ending": run.ending, "tracks": run.tracks, "notes": run.notes, "logs": logs}
    answer(found, (*run_lines(run), *written(logs)), as_json=json)
    return 0 if succeeded(run) else 1
