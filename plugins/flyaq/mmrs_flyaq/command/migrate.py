"""``mmrs migrate``: models of another dialect become a project."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import report, say, say_json, tell
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_flyaq.migrate import Migration

Files = Annotated[list[Path], typer.Argument(metavar="FILE...", help="Models to migrate, in XMI or JSON.")]
Output = Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Project folder to write.")]
Mapping = Annotated[
    Path | None,
    typer.Option(
        "--mapping",
        metavar="FILE",
        help="TOML file that maps the classes of the dialect. Default: that of a known one, e.g. FLYAQ 2015.",
    ),
]
Metamodels = Annotated[
    list[Path] | None,
    typer.Option(
        "--metamodels",
        metavar="PATH",
        help="Metamodel of the models (.ecore), or a folder of metamodels. Repeatable.",
    ),
]
Types = Annotated[
    list[str] | None,
    typer.Option(
        "--type", metavar="OLD=NAME", help="Robot type that replaces the type called OLD. Repeatable."
    ),
]


app = typer.Typer(rich_markup_mode=None, add_completion=False)


@app.command()
def migrate(
    call: typer.Context,
    files: Files,
    output: Output,
    mapping: Mapping = None,
    metamodels: Metamodels = None,
    types: Types = None,
    force: Annotated[
        bool, typer.Option("--force", help="Overwrite project files with other content.")
    ] = False,
    json: Json = False,
) -> int:
    """Migrate models of another dialect to an MMRS project.

    Lists every value that was defaulted, changed in meaning or dropped. The other commands read models of
    FLYAQ 2015 directly and migrate them in memory.

    Example: mmrs migrate mission.json context.json Heron.xmi -o orchard
    """
    from mmrs_core.cli.session import Session
    from mmrs_core.diagnostics import in_order
    from mmrs_flyaq.command.projects import read_sources, write_outputs
    from mmrs_flyaq.command.report import migration_lines, verdict_lines, verdicts_on

    session = Session(settings_of(call))
    migration = read_sources(session, files, output, mapping, metamodels or (), types or ())
    written = write_outputs(session, migration, files, output, force=force)
    for line in migration_lines(migration, output) if not json else ():
        say(line)
    verdicts = verdicts_on(written, session)
    faults = in_order(dict.fromkeys(fault for verdict in verdicts for fault in verdict.faults))
    valid = bool(written) and all(verdict.valid for verdict in verdicts)
    unreadable = [source.fault for source in migration.sources] + [each.unreadable for each in verdicts]
    for fault in filter(None, unreadable):
        tell(f"mmrs: {fault}")
    report(faults)
    if json:
        reported = {"sources": migration.sources, "findings": migration.findings, "files": written}
        judged = [{"path": each.path, "valid": each.valid, "missing": each.missing} for each in verdicts]
        say_json({"valid": valid, "verdicts": judged, **reported, "diagnostics": faults})
    for line in verdict_lines(verdicts) if not json else ():
        say(line)
    is_read = not any(unreadable) and all(verdict.is_read for verdict in verdicts)
    return _exit_code(migration, valid) if is_read else 3


def _exit_code(migration: Migration, valid: bool) -> int:
    """Return 1 if a model became nothing or something invalid, else 0."""
    used = {file for output in migration.outputs for file in output.sources}
    came_to_nothing = any(source.is_model and source.file not in used for source in migration.sources)
    return 0 if not came_to_nothing and (valid or not migration.outputs) else 1
