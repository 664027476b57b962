"""The option by which commands write models that Eclipse opens without any metamodel being registered."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.metamodels.export import exported_names, schema_locations

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry

SchemaLocation = Annotated[
    Path | None,
    typer.Option(
        "--schema-location",
        metavar="DIR",
        help="Folder written by 'mmrs metamodel export', recorded as xsi:schemaLocation for Eclipse.",
    ),
]


def places_in(directory: Path | None, registry: Registry, file: Path) -> Mapping[str, str]:
    """Return where a model in a file finds the metamodels of a folder, by nsURI; nothing without a folder.

    Raises:
        UnreadableError: if not all metamodels were exported to that folder.
    """
    if directory is None:
        return {}
    for name in exported_names(registry).values():
        if not (directory / name).is_file():
            message = f"{directory}: no {name} in this folder; 'mmrs metamodel export {directory}' writes it"
            raise UnreadableError(message)
    return schema_locations(registry, directory, file)
