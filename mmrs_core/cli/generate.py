"""``mmrs generate`` and ``mmrs-gen``: code for every robot's controller."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.behaviours import load_behaviour
from mmrs_core.cli.completion import target_names
from mmrs_core.cli.output import answer, counted, say, say_json, table
from mmrs_core.cli.parameters import Context, Robots, behaviour_file, robot_files
from mmrs_core.cli.protection import refuse_inputs
from mmrs_core.cli.session import Session, require_safe, verdicts_of
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.generation.deployment import fetch
from mmrs_core.generation.manifest import Manifest, manifest_in
from mmrs_core.generation.writing import write
from mmrs_core.pipeline import capabilities, render

if TYPE_CHECKING:
    from mmrs_core.cli.session import Session
    from mmrs_core.generation.capabilities.judging import TargetCapability


def generate(
    call: typer.Context,
    behaviour: Annotated[
        Path | None,
        typer.Argument(metavar="BEHAVIOUR", help="Behaviour file, or a folder that contains behaviour.xmi."),
    ] = None,
    target: Annotated[
        str | None,
        typer.Option(
            "--target",
            metavar="NAME",
            help="Target to generate code for; see --list-targets. Required to generate.",
            autocompletion=target_names,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Output folder. Required to generate."),
    ] = None,
    robots: Robots = None,
    context: Context = None,
    allow_lossy: Annotated[
        bool, typer.Option("--allow-lossy", help="Omit elements the target does not support.")
    ] = False,
    templates: Annotated[
        Path | None,
        typer.Option("--templates", metavar="DIR", help="Folder of your own templates, as DIR/TARGET/FILE."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite files changed by hand.")] = False,
    wheels: Annotated[
        list[str] | None,
        typer.Option(
            "--wheels",
            metavar="PLATFORM",
            help="Download the controllers' wheels for a platform, e.g. manylinux2014_aarch64. Repeatable.",
        ),
    ] = None,
    list_targets: Annotated[bool, typer.Option("--list-targets", help="List the targets.")] = False,
    capabilities: Annotated[
        bool,
        typer.Option("--capabilities", help="List the elements that the target, or every target, supports."),
    ] = False,
    json: Json = False,
) -> int:
    """Generate controller code for every robot.

    'mmrs-gen' is the same command. 'mmrs explain FILE:LINE' traces a generated line to its move.

    Example: mmrs generate field --target mavlink-python -o code
    """
    session = Session(settings_of(call))
    if list_targets:
        return _list_targets(session, json)
    if capabilities:
        return print_capabilities(session, target or (str(behaviour) if behaviour else None), json)
    if behaviour is None or target is None or output is None:
        missing = [
            name
            for name, value in (("BEHAVIOUR", behaviour), ("--target", target), ("--output", output))
            if value is None
        ]
        raise typer.BadParameter(f"missing: {', '.join(missing)}")
    order = _Order(target, output, context, robot_files(robots), templates, allow_lossy, force, wheels or [])
    made = _generate(session, behaviour_file(behaviour), order)
    if json:
        left_out = {"losses": made.manifest.losses, "overrides": sorted(made.manifest.overrides)}
        said = {"asks": made.asks, "notes": {str(path): note for path, note in made.notes.items()}}
        say_json({"target": target, "files": made.written, **left_out, **said})
    else:
        _tell_written(made, output)
    return 0


@dataclass(frozen=True, slots=True)
class _Order:
    """What is to be generated from a behaviour, and where to."""

    target: str
    output: Path
    context: Path | None
    robots: tuple[Path, ...]
    templates: Path | None
    allow_lossy: bool
    force: bool
    platforms: Sequence[str]


@dataclass(frozen=True, slots=True)
class _Made:
    """What was generated: files that were written, what is left to do, and notes on files."""

    written: tuple[Path, ...]
    manifest: Manifest
    asks: tuple[str, ...]
    notes: Mapping[Path, str]


_MANY = 20
"""Files of a folder that are listed one by one; of a larger folder, only their number."""


def _tell_written(made: _Made, folder: Path) -> None:
    manifest = made.manifest
    say(f"{manifest.target}: {counted(len(made.written), 'file')} written")
    for line in _listed(made.written, folder):
        note = made.notes.get(Path(line), "")
        say(f"  {line} ({note})" if note else f"  {line}")
    for sort, names in (
        ("with a file of yours in place of the target's own", sorted(manifest.overrides)),
        ("left out, since the target cannot express it", manifest.losses),
        ("left for you to do before it works", made.asks),
    ):
        if names:
            say(f"{sort}:")
        for name in names:
            say(f"  {name}")


def _listed(written: tuple[Path, ...], folder: Path) -> list[str]:
    """Return a line for each file, and for each large folder of the target's own.

    >>> _listed((Path("code/a.py"), *(Path(f"code/lib/{i}.py") for i in range(30))), Path("code"))
    ['code/a.py', 'code/lib/ (30 files)']
    """
    tops = [folder.joinpath(*path.relative_to(folder).parts[:1]) for path in written]
    sizes = Counter(tops)
    lines = (
        f"{top}/ ({counted(sizes[top], 'file')})" if sizes[top] > _MANY else str(path)
        for top, path in zip(tops, written, strict=True)
    )
    return list(dict.fromkeys(lines))


def _generate(session: Session, file: Path, order: _Order) -> _Made:
    loaded = load_behaviour(session, file, context=order.context, robots=order.robots)
    program, place = loaded.program, loaded.place
    require_safe(program, verdicts_of(session, program, place), str(file))
    files = session.stage(
        "render",
        "generating",
        lambda: render(
            program,
            place,
            order.target,
            session.contributions,
            allow_lossy=order.allow_lossy,
            templates=order.templates,
        ),
    )
    refuse_inputs((order.output / file.path for file in files), session.inputs)
    written = write(files, order.output, force=order.force)
    if order.platforms:
        fetch(order.output, order.platforms)
    new = [file for file in files if order.output / file.path in written]
    asks = tuple(f"{file.path}: {each}" for file in new for each in file.asks)
    notes = {order.output / file.path: file.note for file in new if file.note}
    return _Made(written, manifest_in(files[-1].content), asks, notes)


def _list_targets(session: Session, json: bool) -> int:
    targets = sorted(session.contributions.targets.values(), key=lambda target: target.name)
    names = [(each.name, each.description) for each in targets]
    found = {"targets": [{"name": name, "description": description} for name, description in names]}
    answer(found, table(("target", "description"), names), as_json=json)
    return 0


WIDEST = 96


def print_capabilities(session: Session, target: str | None, json: bool) -> int:
    """Print what a target can express, or every target where None is named; return the exit code.

    Raises:
        UsageError: there is no such target.
    """
    contributions = session.contributions
    tables = session.stage("capabilities", "trying", lambda: capabilities(target, contributions))
    if json:
        say_json({"targets": {name: [_row(each) for each in rows] for name, rows in tables.items()}})
        return 0
    for name, rows in tables.items():
        say(f"{name}: {contributions.targets[name].description}")
        for line in table(("what", "", "how, or why not"), list(_cells(rows)), widest=WIDEST):
            say(line)
    return 0


def policy_lines(rows: Iterable[TargetCapability]) -> Iterator[tuple[str, str, str]]:
    """Yield policies in few lines: what, verdict, responses; those together that fare alike."""
    responses: dict[tuple[str, str, str], list[str]] = {}
    for row in rows:
        event, _, response = row.element.partition(": ")
        responses.setdefault((row.group, event, row.verdict), []).append(response)
    events: dict[tuple[str, str, str], list[str]] = {}
    for (group, event, verdict), some in responses.items():
        events.setdefault((group, verdict, ", ".join(some)), []).append(event)
    count = len({event for _, event, _ in responses})
    for (group, verdict, words), names in events.items():
        yield f"{group}: {'any fault' if len(names) == count else ', '.join(names)}", verdict, words


def _cells(rows: Sequence[TargetCapability]) -> Iterator[tuple[str, str, str]]:
    policies = [row for row in rows if is_policy(row)]
    for row in rows:
        if not is_policy(row):
            yield row.element, row.verdict, row.how
    yield from policy_lines(policies)


def is_policy(row: TargetCapability) -> bool:
    """Return whether a row is about a policy of a robot."""
    return row.group.startswith("policy")


def _row(row: TargetCapability) -> dict[str, str]:
    return {"group": row.group, "element": row.element, "verdict": row.verdict, "how": row.how}
