"""``mmrs import``: what was drawn in map programs becomes a project, or is added to one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import counted, report, say, say_json, say_lines, table, tell
from mmrs_core.cli.parameters import robot_files
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.diagnostics import has_errors
from mmrs_core.errors import InvalidModelError, MmrsError, UsageError
from mmrs_core.languages.writing import make_folder, replace_files
from mmrs_core.projects import ALTITUDE

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.drawings.drawing import Drawing
    from mmrs_core.projects.building import Outcome
    from mmrs_core.projects.importing import ImportOptions, ImportResult

_MANY = 10
"""Features of one folder that share a line if the report says the same of each."""
_NOWHERE = Path("imported")
"""Stands for the folder of a project that is not written."""


def import_drawings(
    call: typer.Context,
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="Files of map programs, such as field.kml.")
    ],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FOLDER", help="New project folder.")
    ] = None,
    into: Annotated[
        Path | None,
        typer.Option("--into", metavar="PROJECT", help="Existing project to add to; nothing in it changes."),
    ] = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option(
            "--as",
            metavar="PATTERN=TYPE[:NAME=VALUE,...]",
            help="What matching features become: a type of task or context element, task, obstacle, "
            "forbidden, emergency, home or ignore. The pattern matches names, or with a slash folders and "
            "names. The last option that fits counts. Repeatable.",
        ),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option("--mapping", metavar="FILE", help="TOML file with tables [as] and [robots]."),
    ] = None,
    robots: Annotated[
        list[str] | None,
        typer.Option(
            "--robot",
            metavar="NAME=TYPE[@HOME]",
            help="Robot of the team, its type, and its home: the name of a point, or LATITUDE,LONGITUDE. "
            "Default: the next home in the files. Repeatable.",
        ),
    ] = None,
    types: Annotated[
        list[Path] | None,
        typer.Option(
            "--robots",
            metavar="FILE...",
            help="Robot type files, or a folder of them, beside the installed ones.",
        ),
    ] = None,
    altitude: Annotated[
        float,
        typer.Option(
            "--altitude",
            metavar="M",
            min=0.0,
            help="Height above the origin of tasks drawn without one, for flying robots.",
        ),
    ] = ALTITUDE,
    simplify: Annotated[
        float | None,
        typer.Option(
            "--simplify",
            metavar="M",
            min=0.0,
            help="Drop positions that are less than M metres off the line. Default: none.",
        ),
    ] = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Report what features become, and write nothing.")
    ] = False,
    json: Json = False,
) -> int:
    """Import drawings of map programs into a project.

    Areas, lines and points become tasks, obstacles, forbidden and emergency areas, and homes: by --as and
    --mapping, by their role in the file, by words in their names and folders (no-fly, forbidden, obstacle,
    emergency, rally, home), or by their shape. What each feature became, or why it was left out, is listed.

    Examples: mmrs import farm.kml --dry-run; mmrs import farm.kml -o farm
    --robot 'Kite=Freefly Astro LR1@yard' --as 'Field*=task:altitude=40';
    mmrs import zones.geojson --into farm --as 'Zone*=forbidden'
    """
    if output is not None and into is not None:
        raise typer.BadParameter(
            "-o FOLDER makes a project, and --into PROJECT adds to one; give one of them"
        )
    if output is None and into is None and not dry_run:
        raise typer.BadParameter("where to? -o FOLDER makes a project, --into PROJECT adds to one")
    if output is not None and output.exists() and (not output.is_dir() or any(output.iterdir())):
        raise ProtectedError(f"{output}: exists and is not empty; --into {output} adds to a project")
    session = Session(settings_of(call))
    contributions = session.contributions
    options = _options(files, assignments or (), mapping, robots or (), robot_files(types), contributions)
    options = replace(options, altitude=altitude, simplify=simplify)
    drawings = [_drawing(file, contributions) for file in files]
    team = bool(options.robots) or into is not None
    result, error = _imported(drawings, options, contributions, into or output or _NOWHERE, into is not None)
    if error is None and not (team or dry_run):
        error = _without_robots(result, contributions)
    if error is None and team and has_errors(result.diagnostics):
        hint = "correct the drawing, or leave features out with --as NAME=ignore"
        if into is None and not any(each.path.startswith("/tasks") for each in result.outcomes):
            hint = "no feature becomes a task; --as NAME=task makes one, --into adds to a project with tasks"
        words = f"nothing written: the project would not be valid; {hint}"
        error = InvalidModelError(words, result.diagnostics)
    if not json:
        _tell_all(result)
    if error is not None:
        error.found = _as_json(replace(result, files={}), team, dry_run)
        raise error
    report(result.diagnostics if team else ())
    if not dry_run:
        make_folder(output, result.files) if output is not None else replace_files(result.files)
    if json:
        say_json(_as_json(result, team, dry_run))
        return 0
    say(_summary(result.outcomes))
    if not team:
        tell("note: no robots yet, so the project was not checked; --robot NAME=TYPE adds one")
    for file in [*result.files][::-1] if not dry_run else ():
        say(f"written: {file}")
    if dry_run or not result.files:
        say("nothing written")
    return 0


def _options(
    files: Sequence[Path],
    assignments: Sequence[str],
    mapping: Path | None,
    robots: Sequence[str],
    types: Sequence[Path],
    contributions: Contributions,
) -> ImportOptions:
    from mmrs_core.projects.choosing import Mapped, assignment_of, read_mapping
    from mmrs_core.projects.importing import ImportOptions
    from mmrs_core.projects.notes import completed
    from mmrs_core.projects.team import medium_of, robot_wanted, types_for

    kept = read_mapping(mapping) if mapping is not None else Mapped()
    team = {
        each.name: each
        for text, source in (
            *((f"{name}={rest}", f"{mapping}: {name!r}") for name, rest in kept.robots.items()),
            *((text, f"--robot '{text}'") for text in robots),
        )
        for each in (robot_wanted(text, source),)
    }
    wanted = tuple(team.values())
    used = types_for(wanted, types, contributions)
    names = ", ".join(file.name for file in files)
    media = {medium_of(used[each.type].element, contributions) for each in wanted}
    return ImportOptions(
        choices=(*kept.choices, *(assignment_of(text, f"--as '{text}'") for text in assignments)),
        robots=wanted,
        types=used,
        title=files[0].stem,
        complete=completed(files[0].stem, media, made=f"imported from {names}"),
    )


def _drawing(file: Path, contributions: Contributions) -> Drawing:
    from mmrs_core.contributions.drawings import reader_for
    from mmrs_core.languages.xmi.events import read_bytes

    data = read_bytes(file)
    return reader_for(data, str(file), contributions.drawing_readers).read(data, str(file))


def _imported(
    drawings: Iterable[Drawing],
    options: ImportOptions,
    contributions: Contributions,
    folder: Path,
    into: bool,
) -> tuple[ImportResult, MmrsError | None]:
    """Return what an import makes, and why it is refused."""
    from mmrs_core.projects.importing import ImportRefusedError, imported

    drawings = list(drawings)
    features = [feature for drawing in drawings for feature in drawing.features]
    left_out = [each for drawing in drawings for each in drawing.left_out]
    try:
        return imported(features, left_out, options, contributions, folder, into=into), None
    except ImportRefusedError as refused:
        return refused.result, refused


def _tell_all(result: ImportResult) -> None:
    """Print what became of every feature: those that became the same together, those left out at the end."""
    order = [*dict.fromkeys(each.became for each in result.outcomes if each.became), ""]
    alike: dict[object, list[Outcome]] = {}
    for each in sorted(result.outcomes, key=lambda each: order.index(each.became)):
        why = _row(each)[-1].replace(_pattern([each]), "")
        key = (each.became, each.place.file, each.shape, each.folders, why, each.called in ("", each.name))
        alike.setdefault(key, []).append(each)
    rows = [
        row
        for group in alike.values()
        for row in (map(_row, group) if len(group) < _MANY else [_row_of_all(group)])
    ]
    if rows:
        say_lines(table(("became", "place", "name", "why"), rows))
    for note in result.notes:
        say(f"note: {note}")


def _row(outcome: Outcome) -> tuple[str, str, str, str]:
    name = outcome.name
    if outcome.called and outcome.called != name:
        name = f"{name} -> {outcome.called}" if name.strip() else f"-> {outcome.called}"
    why = "; ".join((outcome.reason or outcome.by, *outcome.notes))
    return outcome.became or "(left out)", str(outcome.place), name, why


def _row_of_all(outcomes: Sequence[Outcome]) -> tuple[str, str, str, str]:
    """Return the row of many features of one folder of which the report says the same."""
    first = outcomes[0]
    became, _, _, why = _row(first)
    lines = [each.place.line for each in outcomes]
    place = f"{first.place.file}:{min(lines)}-{max(lines)}" if any(lines) else first.place.file
    names = [*dict.fromkeys(each.called or each.name for each in outcomes)]
    ends = names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}"
    folder = f" of '{first.folders[-1]}'" if first.folders else ""
    name = f"{counted(len(outcomes), first.shape or 'item')}{folder}: {ends}"
    return became, place, name, why.replace(_pattern([first]), _pattern(outcomes))


def _pattern(outcomes: Sequence[Outcome]) -> str:
    """Return what --as calls some features of one folder."""
    from mmrs_core.projects.choosing import pattern_of, quoted

    first = outcomes[0]
    one = all(each.name == first.name for each in outcomes)
    return pattern_of(first) if one else quoted("", first.folders)


def _summary(outcomes: Sequence[Outcome]) -> str:
    """Return how many features became what.

    >>> _summary(())
    'nothing to import'
    """
    became = Counter(each.became for each in outcomes if each.became)
    parts = [counted(number, kind) for kind, number in became.items()]
    left = sum(not each.became for each in outcomes)
    return (
        "; ".join(filter(None, (", ".join(parts), f"{left} left out" if left else ""))) or "nothing to import"
    )


def _without_robots(result: ImportResult, contributions: Contributions) -> UsageError:
    installed = ", ".join(sorted(contributions.robot_types))
    points = [each.name for each in result.outcomes if each.shape == "point" and each.name]
    return UsageError(
        "no robots: a mission needs a team; --robot NAME=TYPE@HOME adds one",
        tuple(_details(installed, points)),
    )


def _details(installed: str, points: Sequence[str]) -> Iterator[str]:
    yield f"installed robot types: {installed or 'none'}; --robots FILE adds others"
    if points:
        yield f"points for homes: {', '.join(points[:10])}{', …' if len(points) > 10 else ''}"
    else:
        yield "no point is drawn for a home: NAME=TYPE@LATITUDE,LONGITUDE"


def _as_json(result: ImportResult, checked: bool, dry_run: bool) -> dict[str, object]:
    return {
        "features": [
            {
                "name": each.name,
                "folders": each.folders,
                "file": each.place.file,
                "line": each.place.line,
                "shape": each.shape,
                "became": each.became,
                "element": each.called,
                "decided_by": each.by,
                "left_because": each.reason,
                "notes": each.notes,
            }
            for each in result.outcomes
        ],
        "notes": result.notes,
        "files": list(result.files),
        "written": bool(result.files) and not dry_run,
        "diagnostics": result.diagnostics if checked else (),
    }
