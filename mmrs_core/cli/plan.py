"""``mmrs plan``: from a mission to the behaviour of every robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.journey import Journey, Workshop
from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.parameters import Context, Project, Robots, Seed, robot_files
from mmrs_core.cli.plan_words import plan_lines, plan_summary
from mmrs_core.cli.planned import require_sound, require_writable
from mmrs_core.cli.schema_places import SchemaLocation, places_in
from mmrs_core.cli.settings import Json, settings_of
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


_VALUES: Mapping[Stage, Callable[[Journey], object]] = {
    Stage.READ: lambda journey: _models(journey),
    Stage.CHECK: lambda journey: journey.warnings,
    Stage.GROUND: lambda journey: journey.grounded,
    Stage.EXPAND: lambda journey: journey.scene,
    Stage.PLAN: lambda journey: journey.plan,
    Stage.TRANSFORM: lambda journey: _behaviour(journey),
    Stage.VERIFY: lambda journey: journey.verdicts,
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
    force: Annotated[bool, typer.Option("--force", help="Overwrite a behaviour written by hand.")] = False,
    stop_after: Annotated[
        Stage | None,
        typer.Option("--stop-after", help="Print the result of a stage as JSON and write no file."),
    ] = None,
    schema_location: SchemaLocation = None,
    json: Json = False,
) -> int:
    """Plan a mission and write the robots' behaviour.

    The behaviour is verified first and written only if it passes all checks.

    Example: mmrs plan field
    """
    workshop = Workshop(settings_of(call))
    journey = Journey(workshop, project, context=context, robots=robot_files(robots), seed=seed)
    if stop_after is not None:
        say_json({"stage": stop_after.value, "value": _VALUES[stop_after](journey)})
        return 0
    folder = folder_of(project)
    file = output or model_in(folder, "behaviour") or folder / "behaviour.xmi"
    require_writable(journey, file, "" if force else "--force replaces it")
    places = places_in(schema_location, workshop.contributions.languages, file)
    require_sound(journey, str(project))
    save(journey.transformed[0], file, workshop.contributions, places)
    if json:
        summary = plan_summary(journey.scene, journey.plan)
        say_json({"behaviour": file, **summary, "verdicts": journey.verdicts})
    else:
        for line in plan_lines(journey.scene, journey.plan):
            say(line)
        say(f"written: {file}")
    return 0


def folder_of(project: Path) -> Path:
    """Return the folder of a project given as a folder or as its mission's file."""
    return project if project.is_dir() else project.parent


def _models(journey: Journey) -> object:
    models = journey.models
    return {"mission": models.mission, "context": models.context, "robots": models.robots}


def _behaviour(journey: Journey) -> object:
    behaviour, trace = journey.transformed
    return {"behaviour": behaviour, "trace": trace}
