"""``mmrs migrate``: models of another dialect become a project."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.output import report, say, say_json
from mmrs_core.cli.settings import Json, settings_of

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
    from mmrs_core.cli.migration import judged, read_sources, write_outputs
    from mmrs_core.cli.migration_words import migration_lines
    from mmrs_core.diagnostics import has_errors

    workshop = Workshop(settings_of(call))
    migration = read_sources(workshop, files, output, mapping, metamodels or (), types or ())
    written = write_outputs(workshop, migration, files, output, force=force)
    faults = judged(workshop, migration, output) if written else ()
    valid = not has_errors(faults)
    if json:
        report(faults)
        say_json(
            {
                "valid": valid,
                "sources": migration.sources,
                "findings": migration.findings,
                "files": written,
                "diagnostics": faults,
            }
        )
        return 0 if valid else 1
    for line in migration_lines(migration, output):
        say(line)
    report(faults)
    if written:
        say(f"{output}: {'valid' if valid else 'not valid'}")
    return 0 if valid else 1
