"""``mmrs metamodel``: the languages that are installed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mmrs_core.cli.output import counted, say, say_json
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.tables import table

app = typer.Typer(
    rich_markup_mode=None,
    help="The languages that are installed.",
    no_args_is_help=True,
    add_completion=False,
)

Folder = Annotated[Path, typer.Argument(metavar="DIR", help="Where to write.")]


@app.callback()
def metamodel() -> None:
    """The languages that are installed."""


@app.command("list")
def list_metamodels(call: typer.Context, json: Json = False) -> int:
    """List the languages and who provides them."""
    registry = settings_of(call).plugins().contributions.languages
    rows = [
        (package.ns_uri, package.name, package.provider, str(len(package.metaclasses)))
        for package in registry.packages
    ]
    if json:
        names = ("ns_uri", "name", "provider", "classes")
        say_json({"metamodels": [dict(zip(names, row, strict=True)) for row in rows]})
    else:
        for line in table(("language", "name", "provided by", "classes"), rows):
            say(line)
    return 0


@app.command("export")
def export(
    call: typer.Context,
    directory: Folder,
    force: Annotated[
        bool, typer.Option("--force", help="Replace files that were changed or come from elsewhere.")
    ] = False,
    json: Json = False,
) -> int:
    """Write all languages side by side as an Eclipse project."""
    from mmrs_core.languages.metamodels.export import export_metamodels

    registry = settings_of(call).plugins().contributions.languages
    return _written(export_metamodels(registry, directory, force=force), json)


@app.command("docs")
def docs(call: typer.Context, directory: Folder, json: Json = False) -> int:
    """Write the page about the languages, with a diagram of each."""
    from mmrs_core.cli.pages.languages_page import write_pages

    registry = settings_of(call).plugins().contributions.languages
    return _written(write_pages(registry, directory), json)


@app.command("stubs")
def stubs(
    call: typer.Context,
    file: Annotated[Path, typer.Argument(metavar="FILE.ecore", help="The metamodel.")],
    directory: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where to write. By default beside FILE."),
    ] = None,
    json: Json = False,
) -> int:
    """Write typed stubs (.pyi) of a metamodel, for completion in editors and for type checkers.

    Example: mmrs metamodel stubs mmrs_solar/metamodels/solar.ecore -o mmrs_solar
    """
    from mmrs_core.generation.stubs.write import write_stubs
    from mmrs_core.languages.metamodels.files import registry_of_files

    installed = settings_of(call).plugins().contributions.metamodels
    registry, ns_uris = registry_of_files([file], installed)
    return _written(write_stubs(registry, ns_uris, directory or file.parent), json)


def _written(paths: tuple[Path, ...] | list[Path], json: bool) -> int:
    if json:
        say_json({"files": list(paths)})
    else:
        say(f"{counted(len(paths), 'file')} written")
        for path in paths:
            say(f"  {path}")
    return 0
