"""``mmrs report``: a page for people about a flight."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import progress, say, say_json, tell
from mmrs_core.cli.parameters import Assume, Behaviour, Context, Robots, behaviour_file, robot_files
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_core.cli.behaviours import Loaded
    from mmrs_core.cli.session import Session
    from mmrs_core.pictures.preview.picture import Picture
    from mmrs_core.pictures.report.assembly import Given
    from mmrs_core.pictures.report.values import Report

PAGE = "report.html"


def report(
    call: typer.Context,
    behaviour: Behaviour,
    logs: Annotated[
        list[Path], typer.Argument(metavar="LOG...", help="Log files, or folders of logs and black boxes.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE", help="Output file. Default: report.html next to the logs."
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
    answered in flight.

    Example: mmrs report mission/ mission/logs -o report.html
    """
    from mmrs_core.cli.behaviours import load_behaviour
    from mmrs_core.cli.protection import refuse_inputs
    from mmrs_core.cli.session import Session
    from mmrs_core.cli.simulation import answers
    from mmrs_core.pictures.flights.gathering import read_flight
    from mmrs_core.pictures.flights.planned import planned_for
    from mmrs_core.pictures.report.assembly import Given, report_of

    session, file = Session(settings_of(call)), behaviour_file(behaviour)
    loaded = load_behaviour(session, file, context=context, robots=robot_files(robots))
    contributed = session.contributions
    flight = read_flight(logs, loaded.program, loaded.place.types, contributed.robot_kinds)
    for damage in flight.damages:
        tell(damage)
    with progress("simulating the plan"):
        planned = planned_for(loaded.program, loaded.place, contributed, flight, answers(assume))
    given = Given(
        loaded.program, loaded.place, flight, planned, contributed.move_kinds, contributed.robot_kinds
    )
    made = report_of(given)
    path = output if output is not None else _beside(logs[0])
    refuse_inputs((path,), (*session.inputs, *read_files(logs)))
    _write(path, made, given, picture_of(session, loaded, given, made, file.parent))
    if json:
        say_json({"files": [path], "report": made})
    else:
        say(f"written: {path}")
    return 0


def read_files(logs: list[Path]) -> tuple[Path, ...]:
    """Return every log and part of a black box that paths lead to."""
    from mmrs_core.behaviour.box_files import black_boxes
    from mmrs_core.behaviour.log import logs_in

    return (*logs_in(logs), *(part for box in black_boxes(logs) for part in box.parts))


def _beside(logs: Path) -> Path:
    return (logs if logs.is_dir() else logs.parent) / PAGE


def picture_of(session: Session, loaded: Loaded, given: Given, made: Report, folder: Path) -> Picture:
    """Return the picture of a flight, with the tasks of the mission that lies in a folder."""
    from mmrs_core.pictures.preview.from_flight import picture_of_flight
    from mmrs_core.pictures.preview.from_run import Surroundings
    from mmrs_core.pictures.report.asked import with_tasks

    around = Surroundings(given.place.areas or (), loaded.elements, given.place.types)
    picture = picture_of_flight(given.program, given.flight, given.planned, session.contributions, around)
    return with_tasks(picture, made, given.program, session.contributions, folder)


def _write(path: Path, made: Report, given: Given, picture: Picture) -> None:
    from mmrs_core.cli.replacing import replace_files
    from mmrs_core.pictures.report.page import page

    replace_files({path: page(made, given, picture).encode()})
