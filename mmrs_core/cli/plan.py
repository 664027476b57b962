"""``mmrs plan``: from a mission to the behaviour of every robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.conversion import SchemaLocation, places_in
from mmrs_core.cli.output import progress, say_json, say_lines, tell, written
from mmrs_core.cli.parameters import Context, Explain, Project, Robots, Seed, TimeLimit, robot_files
from mmrs_core.cli.plan_words import explanation_lines, explanation_summary, plan_lines, plan_summary
from mmrs_core.cli.protection import files_of, refuse_handwritten, refuse_inputs, refuse_inside
from mmrs_core.cli.session import CommandStages, Session, require_safe
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.verdict_words import warnings
from mmrs_core.diagnostics import has_errors, in_order
from mmrs_core.errors import InvalidModelError, MmrsError
from mmrs_core.languages.modelset import model_in
from mmrs_core.pipeline import save


class Stage(StrEnum):
    """Where to stop."""

    READ = "read"
    CHECK = "check"
    GROUND = "ground"
    EXPAND = "expand"
    PLAN = "plan"
    TRANSFORM = "transform"
    VERIFY = "verify"


_VALUES: Mapping[Stage, Callable[[CommandStages], object]] = {
    Stage.READ: lambda stages: _models(stages),
    Stage.CHECK: lambda stages: stages.warnings,
    Stage.GROUND: lambda stages: stages.grounded,
    Stage.EXPAND: lambda stages: stages.scene,
    Stage.PLAN: lambda stages: stages.plan,
    Stage.TRANSFORM: lambda stages: _behaviour(stages),
    Stage.VERIFY: lambda stages: stages.verdicts,
}


def plan(
    call: typer.Context,
    project: Project,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE", help="Output file. Default: behaviour.xmi in the project."
        ),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    seed: Seed = 0,
    time_limit: TimeLimit = None,
    explain: Explain = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite a behaviour written by hand.")] = False,
    stop_after: Annotated[
        Stage | None,
        typer.Option(
            "--stop-after", help="Stop after a stage of planning, print its result as JSON and write no file."
        ),
    ] = None,
    schema_location: SchemaLocation = None,
    json: Json = False,
) -> int:
    """Plan a mission and write the robots' behaviour.

    The behaviour is verified first and written only if it passes all checks. During the search,
    Ctrl-C keeps the best plan found so far; a second Ctrl-C ends the command.

    Example: mmrs plan field
    """
    session = Session(settings_of(call))
    stages = CommandStages(
        session, project, context=context, robots=robot_files(robots), seed=seed, time_limit=time_limit
    )
    if stop_after is not None:
        if explain:
            raise typer.BadParameter("--explain goes with a whole plan, not with --stop-after")
        say_json({"stage": stop_after.value, "value": _VALUES[stop_after](stages)})
        return 0
    folder = folder_of(project)
    file = output or model_in(folder, "behaviour") or folder / "behaviour.xmi"
    next(file.parent.iterdir(), None)  # a folder that does not exist is told before a long search
    require_writable(stages, file, "" if force else "--force replaces it")
    places = places_in(schema_location, session.contributions.languages, file)
    try:
        require_sound(stages, str(project))
    except MmrsError:
        if file.exists():
            tell(f"unchanged: {file} is of an earlier plan")
        raise
    with progress("simulating the plan"):
        timed = stages.timed
    save(stages.transformed[0], file, session.contributions, places)
    if json:
        summary = plan_summary(stages.scene, timed)
        if explain:
            summary = {**summary, "explanation": explanation_summary(stages.explanation)}
        say_json({"behaviour": file, **summary, "verdicts": stages.verdicts})
    else:
        say_lines(plan_lines(stages.scene, timed))
        say_lines(warnings(stages.verdicts))
        say_lines(explanation_lines(stages.explanation) if explain else ())
        say_lines(written([file]))
    return 0


def folder_of(project: Path) -> Path:
    """Return the folder of a project given as a folder or as its mission's file."""
    return project if project.is_dir() else project.parent


def _models(stages: CommandStages) -> object:
    models = stages.models
    return {"mission": models.mission, "context": models.context, "robots": models.robots}


def _behaviour(stages: CommandStages) -> object:
    behaviour, trace = stages.transformed
    return {"behaviour": behaviour, "trace": trace}


def require_writable(stages: CommandStages, file: Path, way_out: str = "") -> None:
    """Require that the behaviour of a mission may be written to a file.

    Args:
        stages: its models are read, if they were not yet.
        file: to be written.
        way_out: what the user can do instead of replacing a hand-written behaviour;
            empty: it may be replaced.

    Raises:
        ProtectedError: if the file is an input, lies among the robot types, or was written by hand.
        InvalidModelError: if the mission is not valid.
    """
    mission = next(iter(files_of(stages.models.models)))
    refuse_inputs((file,), stages.session.inputs)
    refuse_inside(file, mission.parent / "robots")
    if way_out:
        refuse_handwritten(file, stages.session.contributions.languages, way_out)


def require_sound(stages: CommandStages, name: str) -> None:
    """Require that the behaviour of a mission is safe to execute, and valid.

    Args:
        stages: goes as far as to the verdicts.
        name: of the mission, for messages.

    Raises:
        RefusedError: if the behaviour is not safe, or not known to be.
        InvalidModelError: if it breaks a constraint, with all diagnostics.
    """
    from mmrs_core.analysis.constraints import check_planned

    require_safe(stages.program, stages.verdicts, name)
    contributions = stages.session.contributions
    faults = check_planned(
        stages.transformed[0], stages.models, contributions.constraints, contributions.languages
    )
    if has_errors(faults):
        raise InvalidModelError(f"{name}: the behaviour that was planned is not valid", in_order(faults))
