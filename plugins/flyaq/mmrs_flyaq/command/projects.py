"""Reads what ``mmrs migrate`` is given, and writes what comes of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import typer

from mmrs_core.cli.protection import ProtectedError, refuse_inputs
from mmrs_core.cli.session import Session
from mmrs_core.errors import UnreadableError
from mmrs_core.languages import robot as robots
from mmrs_core.languages.importers import foreign_file
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.references.project import robot_files_in
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import replace_file, to_xmi
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_flyaq.importing import recognised_in
from mmrs_flyaq.migrate import Migration, UnknownTypeError
from mmrs_flyaq.migrate import migrate as migrated
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping import DialectMapping
from mmrs_flyaq.rules.mapping_file import read_mapping


def read_sources(
    session: Session,
    files: Sequence[Path],
    project: Path,
    mapping: Path | None,
    metamodels: Sequence[Path],
    types: Sequence[str],
) -> Migration:
    """Return what files become; robot types that the project has already count as known.

    Raises:
        UnreadableError: if a file or the mapping cannot be read.
        typer.BadParameter: if a robot type's name is not written as OLD=NAME, or OLD occurs nowhere.
    """
    registry = session.contributions.languages
    rules = read_mapping(mapping, registry) if mapping else _mapping_for(files, registry)
    stands_for = _stands_for(types)
    present = _types_in(project, session)

    def migrating() -> Migration:
        return migrated(files, rules, registry, metamodels=metamodels, types=stands_for, present=present)

    try:
        return session.stage("migrate", "migrating", migrating)
    except UnknownTypeError as fault:
        raise typer.BadParameter(f"--type: {fault}") from None


def _mapping_for(files: Iterable[Path], registry: Registry) -> DialectMapping:
    """Return the mapping of the first dialect that knows one of the files; by default that of FLYAQ 2015."""
    for file in files:
        with suppress(UnreadableError):  # that is told when it is migrated
            found = foreign_file(read_bytes(file), str(file), registry)
            own = recognised_in(found.candidate) if found is not None else None
            if own is not None:
                return own.mapping
    return read_mapping(FLYAQ_2015, registry)


def _stands_for(given: Sequence[str]) -> dict[str, str]:
    found = {}
    for each in given:
        old, sign, name = each.partition("=")
        if not (old and sign and name):
            raise typer.BadParameter(f"'{each}' is not written as OLD=NAME")
        found[old] = name
    return found


def _types_in(project: Path, session: Session) -> Mapping[str, robots.Robot]:
    models = (
        read_model(file, session.contributions.languages) for file in robot_files_in(project / "robots")
    )
    roots = (root for model in models for root in model.roots if isinstance(root, robots.Robot))
    return {root.name or "": root for root in roots}


def write_outputs(
    session: Session, migration: Migration, sources: Iterable[Path], project: Path, *, force: bool
) -> tuple[Path, ...]:
    """Write the models into the project's folder; return the files.

    Raises:
        ProtectedError: if a file is a source, or stands there with other content and may not be replaced.
        OSError: if the folder cannot be written to.
    """
    registry = session.contributions.languages
    contents = {project / each.path: to_xmi((each.element,), registry) for each in migration.outputs}
    refuse_inputs(contents, sources)
    for file, data in contents.items():
        if not force and file.exists() and file.read_bytes() != data:
            raise ProtectedError(f"{file}: has other content; use --force to overwrite")
    for file, data in contents.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        replace_file(file, data)
    return tuple(contents)
