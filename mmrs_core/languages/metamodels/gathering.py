"""Metamodel files that need each other: what one refers to, and where that lies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from os.path import isfile
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.metamodels.parsing import read_tables
from mmrs_core.languages.metamodels.tables import PackageTable
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.registry import MetamodelSource, Registry


def gathered(files: Iterable[Path], registry: Registry) -> Iterator[MetamodelSource]:
    """Yield metamodels, and those that they refer to, as far as they are not installed.

    Raises:
        UnreadableError: if a file is no metamodel.
    """
    pending, seen = list(files), set()
    brought: set[str] = set()
    while pending:
        file = pending.pop(0)
        if real_path(file) in seen:
            continue
        seen.add(real_path(file))
        tables = read_tables(file)
        names = {table.ns_uri for table in flat(tables)}
        if any(registry.has(name) or name in brought for name in names):
            continue
        brought |= names
        yield MetamodelSource(tables[0].ns_uri, file, str(file))
        for document in dict.fromkeys(documents_of(tables)):
            pending += [other for other in _meant(document, file, registry) if real_path(other) not in seen]


def documents_of(tables: Iterable[PackageTable]) -> Iterator[str]:
    """Yield the documents that packages refer to."""
    for table in flat(tables):
        yield from (uri.partition("#")[0] for uri in table.elsewhere)
        for row in table.classes:
            uris = (
                *row.supertypes,
                *(uri for each in row.features for uri in (each.type, each.opposite, *each.keys)),
            )
            yield from (document for uri in uris if (document := uri.partition("#")[0]))


def _meant(document: str, referrer: Path, registry: Registry) -> Iterator[Path]:
    """Yield the file that a metamodel refers to: by its path, or by nsURI where it lies beside."""
    if registry.has(document):
        return
    file = file_at(document, referrer.parent)
    if file is not None:
        yield file
        return
    for other, tables in beside(referrer.parent):
        if any(table.ns_uri == document for table in flat(tables)):
            yield other


def file_at(place: str, folder: Path) -> Path | None:
    """Return the .ecore file that a relative or ``platform:`` URI means, if there is one."""
    path = unquote(place.partition("#")[0])
    if path.startswith("platform:"):
        path = path.rpartition("/")[2]
    if ":" in path or path.startswith(("/", "\\")) or "\0" in path or not path.endswith(".ecore"):
        return None
    file = folder / path
    return file if isfile(file) else None  # noqa: PTH113  Path.is_file raises for a name that is too long


def beside(folder: Path) -> Iterator[tuple[Path, tuple[PackageTable, ...]]]:
    """Yield the metamodels of a folder; a file that is none is not meant."""
    for file in sorted(folder.glob("*.ecore")):
        try:
            yield file, read_tables(file)
        except UnreadableError:
            continue


def flat(tables: Iterable[PackageTable]) -> Iterator[PackageTable]:
    """Yield packages, and those inside them."""
    for table in tables:
        yield table
        yield from flat(table.subpackages)
