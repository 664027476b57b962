"""``mmrs report``: a page about a flight."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.behaviour.box_files import black_boxes
from mmrs_core.behaviour.log import logs_in
from mmrs_core.cli.behaviours import Loaded, load_behaviour
from mmrs_core.cli.output import answer, progress, tell, written
from mmrs_core.cli.parameters import Assume, Behaviour, Context, Robots, behaviour_file, robot_files
from mmrs_core.cli.protection import refuse_inputs
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.languages.writing import replace_files

if TYPE_CHECKING:
    from mmrs_core.pictures.report.assembly import Given

PAGE = "report.html"


def report(
    call: typer.Context,
    behaviour: Behaviour,
    logs: Annotated[
        list[Path], typer.Argument(metavar="LOG...", help="Step logs and black boxes, or folders of them.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Output file. Default: report.html in the folder of the first log.",
        ),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    assume: Assume = None,
    json: Json = False,
) -> int:
    """Write a flight report as HTML.

    Compares the flight with its plan: tasks, tracks, times, energy, photos, faults, commands and links, on
    one page that works offline. The plan is the simulated behaviour, with the conditions as they were
    answered in flight; --assume decides only those that were not.

    Example: mmrs report mission/ mission/logs -o report.html
    """
    from mmrs_core.pictures.report.assembly import report_of
    from mmrs_core.pictures.report.map import flight_picture
    from mmrs_core.pictures.report.page import page

    session, file = Session(settings_of(call)), behaviour_file(behaviour)
    loaded = load_behaviour(session, file, context=context, robots=robot_files(robots))
    given = flown(session, loaded, logs, assume)
    for damage in given.flight.damages:
        tell(damage)
    made = report_of(given)
    path = output if output is not None else (logs[0] if logs[0].is_dir() else logs[0].parent) / PAGE
    refuse_inputs((path,), (*session.inputs, *read_files(logs)))
    picture = flight_picture(given, made, session.contributions, file.parent)
    replace_files({path: page(made, given, picture).encode()})
    answer({"files": [path], "report": made}, written([path]), as_json=json)
    return 0


def flown(session: Session, loaded: Loaded, logs: Sequence[Path], assume: Sequence[str] | None) -> Given:
    """Return the flight of a behaviour by its logs, with its plan.

    Raises:
        UnreadableError: if there is neither a log nor a black box.
        InvalidModelError: if none of them is of a robot of the behaviour.
        UsageError: if no Choice has an assumed condition.
    """
    from mmrs_core.cli.simulation import answers
    from mmrs_core.pictures.flights.gathering import read_flight
    from mmrs_core.pictures.flights.planned import planned_for
    from mmrs_core.pictures.report.assembly import Given

    program, place, contributions = loaded.program, loaded.place, session.contributions
    flight = read_flight(logs, program, place.types, contributions.robot_kinds)
    with progress("simulating the plan"):
        planned = planned_for(program, place, contributions, flight, answers(assume))
    return Given(program, place, flight, planned, contributions)


def read_files(logs: Sequence[Path]) -> tuple[Path, ...]:
    """Return every log and part of a black box that paths lead to."""
    return (*logs_in(logs), *(part for box in black_boxes(logs) for part in box.parts))
