"""``mmrs preview``: pictures of a planned mission."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
from mmrs_core.cli.output import answer, tell, written
from mmrs_core.cli.parameters import (
    Assume,
    Context,
    Explain,
    Robots,
    Seed,
    TimeLimit,
    behaviour_file,
    robot_files,
    without_mission,
)
from mmrs_core.cli.plan import folder_of
from mmrs_core.cli.protection import files_of, refuse_inputs
from mmrs_core.cli.session import CommandStages, Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.verdict_words import verdict_rows
from mmrs_core.diagnostics import Diagnostic
from mmrs_core.errors import InfeasibleError, InvalidModelError
from mmrs_core.languages.writing import replace_files
from mmrs_core.pictures.explanations import sections_of

if TYPE_CHECKING:
    from mmrs_core.pictures.preview.picture import Picture

PAGE = "preview.html"
MAP = "preview.svg"


def preview(
    call: typer.Context,
    project: Annotated[
        Path,
        typer.Argument(
            metavar="PROJECT", help="Folder of the project, its mission file, or a behaviour file."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Output folder. Default: the project's folder."),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    seed: Seed = 0,
    time_limit: TimeLimit = None,
    explain: Explain = False,
    assume: Assume = None,
    logs: Annotated[
        list[Path] | None,
        typer.Option("--logs", metavar="DIR", help="Folder with logs of a run of the behaviour. Repeatable."),
    ] = None,
    json: Json = False,
) -> int:
    """Draw a mission's map, timeline and altitude profile.

    Writes preview.html and preview.svg (the map alone). A mission, or that of a folder, is planned; a
    behaviour file is simulated. With --logs, the flown tracks are drawn over the planned paths of the
    behaviour, which PROJECT names or contains. --assume is for behaviours; with --logs, it decides only
    conditions that were not evaluated in flight. A mission that is not valid or has no feasible plan is drawn
    with its problems.

    Exit codes: 0 drawn, 1 drawn, but the mission is not valid, 4 drawn, but no plan is feasible.

    Example: mmrs preview field
    """
    session = Session(settings_of(call))
    types = robot_files(robots)
    folder = output if output is not None else folder_of(project)
    alone = without_mission(project)
    if explain and (logs or is_behaviour(session, alone)):
        raise typer.BadParameter("--explain goes with a mission, which is planned")
    if logs:
        picture = _of_flight(session, behaviour_file(project), context, types, assume, logs)
    elif is_behaviour(session, alone):
        picture = _of_behaviour(session, alone, context, types, assume)
    elif assume:
        raise typer.BadParameter(
            "--assume goes with a behaviour, or with --logs; a mission is drawn as planned"
        )
    else:
        stages = CommandStages(
            session, project, context=context, robots=types, seed=seed, time_limit=time_limit
        )
        with drawn_on_failure(stages, folder):
            picture = picture_of(stages)
            if explain:
                picture = replace(picture, explanation=sections_of(stages.explanation))
    refuse_inputs((folder / PAGE, folder / MAP), session.inputs)
    files = write_pictures(picture, folder)
    answer({"files": files}, written(files), as_json=json)
    return 0


def picture_of(stages: CommandStages) -> Picture:
    """Return the picture of a planned mission, with the moves that carry it out."""
    from mmrs_core.pictures.preview.from_models import with_problems
    from mmrs_core.pictures.preview.from_plan import picture_of_plan

    symbols = stages.session.contributions.map_symbols
    picture = picture_of_plan(stages.scene, stages.timed, symbols, stages.transformed[1].moves())
    picture = with_problems(picture, stages.models, stages.warnings)
    return replace(picture, checks=verdict_rows(stages.verdicts))


@contextmanager
def drawn_on_failure(stages: CommandStages, folder: Path) -> Iterator[None]:
    """Draw a mission that turns out not to be valid, or to have no plan, with its problems into a folder.

    Raises:
        InvalidModelError, InfeasibleError: after that, as the stages raise it.
    """
    try:
        yield
    except (InvalidModelError, InfeasibleError) as error:
        from mmrs_core.pictures.preview.from_models import picture_of_models

        models = stages.readable()
        if models is None:
            raise
        if isinstance(error, InvalidModelError):
            problems: tuple[Diagnostic | str, ...] = error.diagnostics
        else:
            problems = (*error.reasons, *stages.warnings)
        picture = picture_of_models(models, stages.session.contributions.map_symbols, problems)
        refuse_inputs((folder / PAGE, folder / MAP), files_of(models.models))
        written = write_pictures(picture, folder)
        tell(f"drawn with its problems: {written[0]}")
        raise


def _of_behaviour(
    session: Session, file: Path, context: Path | None, robots: tuple[Path, ...], assume: list[str] | None
) -> Picture:
    from mmrs_core.cli.simulation import answers, fly
    from mmrs_core.pictures.preview.from_run import picture_of_run

    conditions = answers(assume)
    loaded = load_behaviour(session, file, context=context, robots=robots)
    run = fly(session, loaded.program, loaded.place, conditions)
    contributions = session.contributions
    return picture_of_run(
        loaded.program,
        run.records,
        run.tracks,
        contributions.move_kinds,
        contributions.map_symbols,
        loaded.place,
    )


def _of_flight(
    session: Session,
    file: Path,
    context: Path | None,
    robots: tuple[Path, ...],
    assume: list[str] | None,
    logs: list[Path],
) -> Picture:
    from mmrs_core.cli.report import flown
    from mmrs_core.pictures.report.assembly import report_of
    from mmrs_core.pictures.report.map import flight_picture

    loaded = load_behaviour(session, file, context=context, robots=robots)
    given = flown(session, loaded, logs, assume)
    return flight_picture(given, report_of(given), session.contributions, file.parent)


def write_pictures(picture: Picture, folder: Path) -> tuple[Path, ...]:
    """Write the page and the map into a folder, which is made where it is missing; return both paths."""
    from mmrs_core.pictures.preview.map import map_of
    from mmrs_core.pictures.preview.page import page

    contents = {folder / PAGE: page(picture), folder / MAP: map_of(picture, standalone=True) + "\n"}
    replace_files({path: content.encode() for path, content in contents.items()})
    return tuple(contents)
