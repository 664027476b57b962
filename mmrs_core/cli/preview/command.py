"""``mmrs preview``: pictures of a planned mission."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import say, say_json
from mmrs_core.cli.parameters import Context, Project, Robots, Seed, robot_files
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_core.cli.preview.picture import Picture

PAGE = "preview.html"
MAP = "preview.svg"


def preview(
    call: typer.Context,
    project: Project,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where to write; else the project's folder."),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    seed: Seed = 0,
    json: Json = False,
) -> int:
    """Draw a mission: map, timeline, heights, on one page.

    The map is written as SVG, too.
    """
    from mmrs_core.cli.journey import Journey, Workshop
    from mmrs_core.cli.plan import folder_of
    from mmrs_core.cli.preview.from_plan import picture_of_plan

    workshop = Workshop(settings_of(call))
    journey = Journey(workshop, project, context=context, robots=robot_files(robots), seed=seed)
    picture = picture_of_plan(journey.scene, journey.plan)
    written = write_pictures(picture, output if output is not None else folder_of(project))
    if json:
        say_json({"files": written})
    else:
        for path in written:
            say(f"written: {path}")
    return 0


def write_pictures(picture: Picture, folder: Path) -> tuple[Path, ...]:
    """Write the page and the map into a folder, which is made where it is missing; return both paths."""
    from mmrs_core.cli.preview.map_drawing import map_markup
    from mmrs_core.cli.preview.page import page

    folder.mkdir(parents=True, exist_ok=True)
    contents = ((folder / PAGE, page(picture)), (folder / MAP, map_markup(picture, legend=True) + "\n"))
    for path, content in contents:
        path.write_text(content, encoding="utf-8")
    return tuple(path for path, _ in contents)
