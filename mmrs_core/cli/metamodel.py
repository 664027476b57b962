"""``mmrs metamodel``: the languages that are installed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.output import answer, counted, say, say_json, table
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import UnreadableError
from mmrs_core.generation.stubs.write import write_stubs
from mmrs_core.languages.evolution.differences import differences, ways_between
from mmrs_core.languages.evolution.effects import Difference, Effect
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.evolution.versions import pairs_of, version_of
from mmrs_core.languages.metamodels.export import export_metamodels
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.writing import replace_files
from mmrs_core.pictures.pages.languages import pages

app = typer.Typer(
    rich_markup_mode=None,
    help="Inspect and export the metamodels.",
    no_args_is_help=True,
    add_completion=False,
)

Folder = Annotated[Path, typer.Argument(metavar="DIR", help="Output folder.")]


@app.callback()
def metamodel() -> None:
    """Inspect and export the metamodels."""


@app.command("list")
def list_metamodels(call: typer.Context, json: Json = False) -> int:
    """List metamodels and their providers."""
    registry = settings_of(call).plugins().contributions.languages
    rows = [
        (package.ns_uri, package.name, package.provider, str(len(package.metaclasses)))
        for package in registry.packages
    ]
    names = ("ns_uri", "name", "provider", "classes")
    found = {"metamodels": [dict(zip(names, row, strict=True)) for row in rows]}
    answer(found, table(("language", "name", "provided by", "classes"), rows), as_json=json)
    return 0


@app.command("diff")
def diff(
    call: typer.Context,
    old: Annotated[
        str,
        typer.Argument(
            metavar="OLD", help="Old version: an .ecore file, or the nsURI of an installed metamodel."
        ),
    ],
    new: Annotated[str, typer.Argument(metavar="NEW", help="New version: an .ecore file, or an nsURI.")],
    json: Json = False,
) -> int:
    """Compare two versions of a metamodel.

    Lists the differences, and whether old models still load. Metamodels that an .ecore file refers to are
    compared as well.

    Exit codes: 0 old models load, 1 some do not.

    Example: mmrs metamodel diff kites-1.0.ecore kites.ecore
    """
    registry = settings_of(call).plugins().contributions.languages
    try:
        versions = version_of(old, registry), version_of(new, registry)
    except ValueError as fault:
        raise UnreadableError(f"{fault} (an .ecore file is named by its path)") from None
    ways = ways_between(*versions, registry.migrations)
    chain = [step for way in ways.values() for step in way]
    found = differences(*versions, ways)
    files = tuple(pairs_of(*versions).files())
    loads = all(each.verdict is not Effect.INCOMPATIBLE for each in found)
    if json:
        compared = [{"old": before, "new": after} for before, after in files]
        reported = {"old_models_load": loads, "differences": found, "migrations": len(chain)}
        say_json({**reported, "compared": compared})
    else:
        for line, colour in difference_lines(found):
            say(line, colour)
        for before, after in files:
            if before != after:
                say(f"compared: {before} with {after}")
        say(verdict_line(found, chain))
    return 0 if loads else 1


@app.command("export")
def export(
    call: typer.Context,
    directory: Folder,
    force: Annotated[
        bool, typer.Option("--force", help="Overwrite files that were changed or that MMRS did not write.")
    ] = False,
    json: Json = False,
) -> int:
    """Export all metamodels as an Eclipse project."""
    registry = settings_of(call).plugins().contributions.languages
    return _written(export_metamodels(registry, directory, force=force), json)


@app.command("docs")
def docs(call: typer.Context, directory: Folder, json: Json = False) -> int:
    """Generate the metamodel reference.

    Writes one Markdown page with a class diagram of each metamodel.
    """
    registry = settings_of(call).plugins().contributions.languages
    contents = {directory / path: content.encode() for path, content in pages(registry).items()}
    replace_files(contents)
    return _written(tuple(contents), json)


@app.command("stubs")
def stubs(
    call: typer.Context,
    file: Annotated[Path, typer.Argument(metavar="FILE.ecore", help="Metamodel.")],
    directory: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Output folder. Default: the folder of FILE."),
    ] = None,
    json: Json = False,
) -> int:
    """Generate type stubs (.pyi) for a metamodel.

    Editors and type checkers use them. Requires pyecoregen: pip install "mmrs-core[extend]".

    Example: mmrs metamodel stubs mmrs_solar/metamodels/solar.ecore -o mmrs_solar
    """
    installed = settings_of(call).plugins().contributions.metamodels
    registry, ns_uris = registry_of_files([file], installed)
    return _written(write_stubs(registry, ns_uris, directory or file.parent), json)


def _written(paths: tuple[Path, ...] | list[Path], json: bool) -> int:
    lines = (f"{counted(len(paths), 'file')} written", *(f"  {path}" for path in paths))
    answer({"files": list(paths)}, lines, as_json=json)
    return 0


_SIGNS = {"added": "+", "removed": "-", "changed": "~"}
_COLOURS = {Effect.COMPATIBLE: "32", Effect.MEANING: "33", Effect.INCOMPATIBLE: "31"}


def difference_lines(found: Sequence[Difference]) -> Iterator[tuple[str, str]]:
    """Yield a line for each difference, with its colour."""
    for each in found:
        verdict = f"{each.verdict.value}: {each.reason}" if each.reason else each.verdict.value
        yield f"{_SIGNS[each.sort]} {each.what}: {each.words} ({verdict})", _COLOURS[each.verdict]


def verdict_line(found: Sequence[Difference], chain: Sequence[Migration]) -> str:
    """Return whether old models still load.

    >>> verdict_line([], [])
    'nothing differs for models: old models load'
    """
    bad = sum(each.verdict is Effect.INCOMPATIBLE for each in found)
    doubtful = sum(each.verdict is Effect.MEANING for each in found)
    way = f", by {counted(len(chain), 'migration')}" if chain else ""
    if bad:
        unless = "; a function of a migration may see to it" if any(step.rewrite for step in chain) else ""
        return f"{counted(bad, 'incompatible change')}: not all old models load{way}{unless}"
    if doubtful:
        return f"old models load{way}, but {counted(doubtful, 'change')} may give them another meaning"
    return f"old models load{way}" if found else "nothing differs for models: old models load"
