"""``mmrs generate`` and ``mmrs-gen``: code for every robot's controller."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import counted, say, say_json
from mmrs_core.cli.parameters import Context, Robots, behaviour_file, robot_files
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.tables import table

if TYPE_CHECKING:
    from mmrs_core.cli.journey import Workshop


def generate(
    call: typer.Context,
    behaviour: Annotated[
        Path | None,
        typer.Argument(metavar="BEHAVIOUR", help="A behaviour, or the folder with a behaviour.xmi."),
    ] = None,
    target: Annotated[str | None, typer.Option("--target", metavar="NAME", help="What to generate.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="Where to write the files.")
    ] = None,
    robots: Robots = None,
    context: Context = None,
    allow_lossy: Annotated[
        bool, typer.Option("--allow-lossy", help="Leave out what the target cannot express.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Overwrite files that were changed by hand.")
    ] = False,
    list_targets: Annotated[bool, typer.Option("--list-targets", help="List the targets.")] = False,
    json: Json = False,
) -> int:
    """Generate the code of every robot's controller."""
    from mmrs_core.cli.journey import Workshop

    workshop = Workshop(settings_of(call))
    if list_targets:
        return _list_targets(workshop, json)
    if behaviour is None or target is None or output is None:
        missing = [
            name
            for name, value in (("BEHAVIOUR", behaviour), ("--target", target), ("--output", output))
            if value is None
        ]
        raise typer.BadParameter(f"missing: {', '.join(missing)}")
    written = _generate(
        workshop, behaviour_file(behaviour), target, output, context, robot_files(robots), allow_lossy, force
    )
    if json:
        say_json({"target": target, "files": written})
    else:
        say(f"{target}: {counted(len(written), 'file')} written")
        for path in written:
            say(f"  {path}")
    return 0


def _generate(
    workshop: Workshop,
    file: Path,
    target: str,
    output: Path,
    context: Path | None,
    robots: tuple[Path, ...],
    allow_lossy: bool,
    force: bool,
) -> tuple[Path, ...]:
    from mmrs_core.cli.behaviours import load_behaviour
    from mmrs_core.cli.journey import require_safe, verdicts_of
    from mmrs_core.cli.protection import refuse_inputs
    from mmrs_core.generation.writing import write
    from mmrs_core.pipeline import render

    loaded = load_behaviour(workshop, file, context=context, robots=robots)
    program, place = loaded.program, loaded.place
    require_safe(program, verdicts_of(workshop, program, place), str(file))
    files = workshop.stage(
        "render",
        "generating",
        lambda: render(program, place, target, workshop.contributions, allow_lossy=allow_lossy),
    )
    refuse_inputs((output / file.path for file in files), workshop.inputs)
    return write(files, output, force=force)


def _list_targets(workshop: Workshop, json: bool) -> int:
    targets = sorted(workshop.contributions.targets.values(), key=lambda target: target.name)
    if json:
        say_json({"targets": [{"name": each.name, "description": each.description} for each in targets]})
    else:
        for line in table(("target", "description"), [(each.name, each.description) for each in targets]):
            say(line)
    return 0
