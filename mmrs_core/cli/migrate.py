"""``mmrs migrate``: models of another dialect become a project."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import report, say, say_json, tell
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_core.migration.migrate import Migration

Files = Annotated[list[Path], typer.Argument(metavar="FILE...", help="Models, in XMI or JSON.")]
Output = Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="The project's folder.")]
Mapping = Annotated[
    Path | None,
    typer.Option("--mapping", metavar="FILE", help="What becomes of what; else that of FLYAQ 2015."),
]
Metamodels = Annotated[
    list[Path] | None,
    typer.Option(
        "--metamodels", metavar="PATH", help="An .ecore file, or a folder of them; may be repeated."
    ),
]
Types = Annotated[
    list[str] | None,
    typer.Option(
        "--type", metavar="OLD=NAME", help="The robot type that a name stands for; may be repeated."
    ),
]


def migrate(
    call: typer.Context,
    files: Files,
    output: Output,
    mapping: Mapping = None,
    metamodels: Metamodels = None,
    types: Types = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace files of the project that say something else.")
    ] = False,
    json: Json = False,
) -> int:
    """Turn models of another dialect into a project.

    Tells every value that was defaulted, changed in meaning, or not carried over.

    For example: mmrs migrate mission.json context.json Heron.xmi -o field
    """
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.cli.migration import read_sources, write_outputs
    from mmrs_core.cli.migration_faults import faults_in
    from mmrs_core.cli.migration_words import migration_lines
    from mmrs_core.diagnostics import has_errors

    workshop = Workshop(settings_of(call))
    migration = read_sources(workshop, files, output, mapping, metamodels or (), types or ())
    written = write_outputs(workshop, migration, files, output, force=force)
    faults = faults_in(written, workshop.contributions)
    valid = bool(written) and not has_errors(faults)
    for source in migration.sources:
        if source.fault:
            tell(f"mmrs: {source.fault}")
    if json:
        told = {"sources": migration.sources, "findings": migration.findings, "files": written}
        report(faults)
        say_json({"valid": valid, **told, "diagnostics": faults})
    else:
        for line in migration_lines(migration, output):
            say(line)
        report(faults)
        say(
            f"{output}: {'valid' if valid else 'not valid'}"
            if written
            else "nothing to migrate, nothing written"
        )
    return _exit_code(migration, valid)


def _exit_code(migration: Migration, valid: bool) -> int:
    """Return 3 if a file is not readable, 1 if a model became nothing or something invalid, else 0."""
    if any(source.fault for source in migration.sources):
        return 3
    used = {file for output in migration.outputs for file in output.sources}
    came_to_nothing = any(source.is_model and source.file not in used for source in migration.sources)
    return 0 if not came_to_nothing and (valid or not migration.outputs) else 1
