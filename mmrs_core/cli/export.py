"""``mmrs export``: missions, behaviours and flights for map programs."""

from __future__ import annotations

from collections import Counter
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.completion import exporter_names
from mmrs_core.cli.conversion import refuse_existing
from mmrs_core.cli.exporting import drawing_from, given_by
from mmrs_core.cli.output import say, say_json, tell
from mmrs_core.cli.parameters import Assume, Context, Robots, robot_files
from mmrs_core.cli.plan import folder_of
from mmrs_core.cli.protection import refuse_inputs
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import UsageError
from mmrs_core.languages.writing import replace_files
from mmrs_core.pictures.layers.layer import Layer

if TYPE_CHECKING:
    from mmrs_core.contributions.drawings import Exporter

NAME = "export"


def export(
    call: typer.Context,
    source: Annotated[
        Path,
        typer.Argument(
            metavar="PROJECT|BEHAVIOUR|LOGS",
            help="Folder of the project, its mission file, a behaviour file, or a folder of logs in or "
            "below the folder of their behaviour.xmi.",
        ),
    ],
    to: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="kml, kmz, geojson, gpx or another installed format. Default: by the suffix of -o FILE.",
            autocompletion=exporter_names,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Output file. Default: export.FORMAT in the folder of the input.",
        ),
    ] = None,
    only: Annotated[
        list[Layer] | None,
        typer.Option(
            "--only", metavar="LAYER", help=f"Layer to export: {', '.join(Layer)}. Default: all. Repeatable."
        ),
    ] = None,
    logs: Annotated[
        list[Path] | None,
        typer.Option("--logs", metavar="DIR", help="Folder with logs of a run of the behaviour. Repeatable."),
    ] = None,
    start: Annotated[
        str | None,
        typer.Option(
            "--start",
            metavar="TIME",
            help="Date, time and time zone of the start, such as 2026-05-01T09:00Z. Default: that of the "
            "logs; without logs, none.",
        ),
    ] = None,
    context: Context = None,
    robots: Robots = None,
    assume: Assume = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
    json: Json = False,
) -> int:
    """Export to QGIS, Google Earth and other map programs.

    Writes areas, context elements, tasks and homes of a project, with the planned paths, photos and other
    actions if it contains a behaviour; or those of a behaviour alone; or the flown tracks, photos,
    measurements and events of a run. A behaviour is simulated, with the outcomes that --assume gives to its
    conditions.

    Example: mmrs export field --format kml --start 2026-05-01T09:00Z
    """
    session = Session(settings_of(call))
    exporter, begin = _exporter(session, to, output), _time(start)
    given = given_by(session, source, logs or (), context, robot_files(robots), assume, only or ())
    drawing = drawing_from(session, given, exporter.heights, begin, only or ())
    path = output if output is not None else folder_of(source) / f"{NAME}{exporter.suffix}"
    refuse_inputs((path,), (*session.inputs, *given.logs))
    refuse_existing([path], force)
    losses = exporter.losses(drawing)
    replace_files({path: exporter.write(drawing, given.title)})
    layers = Counter(feature.folders[0] for feature in drawing.features)
    if json:
        missed = [{"what": each.what, "reason": each.reason} for each in drawing.left_out]
        found = {"format": exporter.name, "layers": layers, "left_out": missed, "losses": losses}
        say_json({"file": path, **found})
        return 0
    for each in drawing.left_out:
        tell(f"{each.what}: note: {each.reason}")
    for loss in losses:
        tell(f"{path}: note: {loss}")
    say(f"written: {path} ({', '.join(f'{name} {count}' for name, count in layers.items()) or 'nothing'})")
    return 0


def _exporter(session: Session, name: str | None, output: Path | None) -> Exporter:
    """Return the exporter of a name, or that of a file's suffix.

    Raises:
        UsageError: if there is none, or none is asked for.
    """
    known = session.contributions.exporters
    suffix = output.suffix.lower() if output is not None else ""
    for each in known.values():
        if each.name == name or (name is None and each.suffix == suffix):
            return each
    names = ", ".join(sorted(known)) or "none"
    if name is None:
        raise UsageError(f"--format: missing, and -o FILE has the suffix of no format; known are: {names}")
    raise UsageError(f"--format {name}: unknown; known are: {names}")


def _time(given: str | None) -> float | None:
    """Return the seconds since 1970 of a date and time of day; None for none."""
    if given is None:
        return None
    try:
        time = datetime.fromisoformat(given)
    except ValueError:
        time = None
    if time is None or time.tzinfo is None:
        raise typer.BadParameter(
            f"--start {given}: expected a date and time of day with its time zone, such as 2026-05-01T09:00Z"
        )
    return time.timestamp()
