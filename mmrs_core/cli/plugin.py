"""``mmrs plugin``: who contributed what, and the beginning of a plug-in of one's own."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from importlib.metadata import EntryPoint, PackageNotFoundError, entry_points, version
from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from mmrs_core.cli.completion import plugin_parts
from mmrs_core.cli.output import answer, counted, say, say_json, tell
from mmrs_core.cli.settings import Json, Settings, settings_of
from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.generation.scaffolding.files import PARTS, write_plugin
from mmrs_core.generation.scaffolding.names import plugin_names
from mmrs_core.plugins import GROUP

app = typer.Typer(
    rich_markup_mode=None, help="List and create plug-ins.", no_args_is_help=True, add_completion=False
)


@app.callback()
def plugin() -> None:
    """List and create plug-ins."""


@app.command("list")
def list_plugins(call: typer.Context, json: Json = False) -> int:
    """List plug-ins, including those that fail to load.

    Prints the contributions of each.
    """
    settings = settings_of(call)
    try:
        found, conflict = _loaded(settings)
    except PluginError as error:
        tell(f"mmrs: {error}")
        return _list_broken(str(error), json)
    if conflict:
        tell(f"mmrs: {conflict}")
    answer({"plugins": found} | ({"error": conflict} if conflict else {}), _lines(found), as_json=json)
    return 1 if conflict else 0


def _lines(found: _Found) -> Iterator[str]:
    for name, (distribution, release, sorts) in found.items():
        yield f"{name} ({' '.join(filter(None, (distribution, release)))})"
        yield from (f"  {sort.replace('_', ' ')}: {_listed(names)}" for sort, names in sorts.items())


class TaskGeometry(StrEnum):
    """The geometry of a new plug-in's task."""

    POLYGON = "polygon"
    LINE = "line"
    POINT = "point"


@app.command("new")
def new_plugin(
    call: typer.Context,
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME", help="Name in lower-case letters, digits and hyphens, e.g. roof-wash."
        ),
    ],
    contents: Annotated[
        str,
        typer.Option(
            "--with",
            metavar="PART,...",
            help="Contributions to begin with: any of task, robot, target, check, vehicle.",
            autocompletion=plugin_parts,
        ),
    ] = "task",
    task: Annotated[
        TaskGeometry | None, typer.Option("--task", help="Geometry of the task. Default: polygon.")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Output folder, new or empty. Default: mmrs-NAME."
        ),
    ] = None,
    json: Json = False,
) -> int:
    """Create a plug-in, ready to install.

    --with lists its parts: a task type (task), a robot type with its own moves (robot), a code generation
    target (target), a check of behaviours (check), a simulated vehicle (vehicle). The tests of the plug-in
    pass; they subclass the conformance classes of mmrs_core.testing. Requires pyecoregen:
    pip install "mmrs-core[extend]".

    Example: mmrs plugin new roof-wash --task polygon --with task,check
    """
    parts = _parts(contents)
    if task is not None and "task" not in parts:
        raise typer.BadParameter(f"--task {task}: --with {contents} creates no task; add task to --with")
    known = settings_of(call).plugins().contributions
    taken = {each.plugin for each in known.catalogue()}
    taken |= {part for source in known.metamodels for part in source.ns_uri.split(":")}
    taken |= {rule.name for rule in known.rules.values()}
    try:
        names = plugin_names(name, taken, [each.code for each in known.constraints])
    except ValueError as fault:
        raise typer.BadParameter(str(fault)) from fault
    folder = output or Path(names.distribution)
    written = write_plugin(names, parts, (task or TaskGeometry.POLYGON).value, folder, known.metamodels)
    if json:
        say_json({"plugin": names.name, "distribution": names.distribution, "files": written})
        return 0
    say(f"{names.distribution}: {counted(len(written), 'file')} written to {folder}")
    say("Next:")
    plan = ("mmrs plan example",) if "task" in parts else ()
    for command in (f"cd {quote(str(folder))}", 'pip install -e ".[test]"', "pytest", *plan):
        say(f"  {command}")
    return 0


def _parts(contents: str) -> tuple[str, ...]:
    """Return the parts of ``--with``, in the order of `PARTS`.

    Raises:
        typer.BadParameter: if one is unknown.
    """
    named = [each.strip() for each in contents.split(",")]
    for each in named:
        if each not in PARTS:
            raise typer.BadParameter(f"--with {each}: unknown; there are {', '.join(PARTS)}")
    return tuple(part for part in PARTS if part in named)


_Found = dict[str, tuple[str, str, dict[str, list[str]]]]


def _loaded(settings: Settings) -> tuple[_Found, str]:
    """Return the plug-ins that load, and how they conflict; empty if they do not.

    Raises:
        PluginError: if one is broken.
    """
    plugins = settings.plugins()
    found: _Found = {
        name: (distribution, _version(distribution), {})
        for name, distribution in plugins.distributions.items()
    }
    for each in plugins.contributions.catalogue():
        found[each.plugin][2].setdefault(each.sort, []).append(each.name)
    try:
        plugins.contributions.check()
    except (PluginError, UnreadableError) as error:
        return found, str(error)
    return found, ""


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return ""


def _listed(names: list[str]) -> str:
    """Return the names in one line; codes that follow each other are joined.

    >>> _listed(["MML001", "MML002", "MML003", "x"])
    'MML001 to MML003, x'
    """
    return ", ".join(_joined(names))


def _joined(names: list[str]) -> Iterator[str]:
    run: list[str] = []
    for name in [*names, ""]:
        if run and _follows(run[-1], name):
            run.append(name)
            continue
        if run:
            yield f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(run)
        run = [name]


def _follows(before: str, name: str) -> bool:
    return (
        before[:-3] == name[:-3]
        and before[-3:].isdigit()
        and name[-3:].isdigit()
        and int(name[-3:]) == int(before[-3:]) + 1
    )


def _list_broken(reason: str, json: bool) -> int:
    """List the installed plug-ins by their entry points, each with whether it loads alone."""
    entries = sorted(entry_points(group=GROUP), key=lambda entry: entry.name)
    states = [(entry.name, entry.dist.name if entry.dist else "", _state(entry)) for entry in entries]
    broken = [{"plugin": name, "distribution": dist, "state": state} for name, dist, state in states]
    lines = (f"{name} ({distribution}): {state}" for name, distribution, state in states)
    answer({"error": reason, "plugins": broken}, lines, as_json=json)
    return 1


def _state(entry: EntryPoint) -> str:
    try:
        entry.load()
    except Exception as error:
        return f"does not load: {error!r}"
    return "loads"
