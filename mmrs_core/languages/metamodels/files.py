"""Metamodels that are files of the user's, beside those that are installed."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mmrs_core.languages.metamodels.gathering import documents_of, file_at, flat
from mmrs_core.languages.metamodels.parsing import read_tables
from mmrs_core.languages.metamodels.tables import PackageTable
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with


def registry_of_files(
    files: Iterable[Path], installed: Iterable[MetamodelSource]
) -> tuple[Registry, tuple[str, ...]]:
    """Return the metamodels of some .ecore files with those that are installed, and the files' nsURIs.

    A file takes the place of an installed metamodel of the same nsURI. The .ecore files that it refers to
    are taken along where they are there; where a path leads nowhere, as in a workspace of Eclipse projects
    that were moved, a file of that name beside it.

    Args:
        files: the .ecore files.
        installed: what plug-ins bring.

    Raises:
        UnreadableError: if a file is no metamodel.
        PluginError: if a metamodel refers to one that is missing, or two files hold the same.
    """
    given = [real_path(file) for file in files]
    held = {
        file: [table.ns_uri for table in flat(tables)] for file, tables in _with_neighbours(given).items()
    }
    taken = {uri for uris in held.values() for uri in uris}
    sources = [MetamodelSource(uris[0], file, file.name) for file, uris in held.items()]
    others = [source for source in installed if source.ns_uri not in taken]
    wanted = tuple(dict.fromkeys(uri for file in given for uri in held[file]))
    return registry_with([*others, *sources]), wanted


def _with_neighbours(files: Iterable[Path]) -> dict[Path, tuple[PackageTable, ...]]:
    found: dict[Path, tuple[PackageTable, ...]] = {}
    pending = list(files)
    while pending:
        file = pending.pop(0)
        if file in found:
            continue
        found[file] = read_tables(file)
        for document in documents_of(found[file]):
            other = file_at(document, file.parent) or file_at(document.rpartition("/")[2], file.parent)
            pending += [real_path(other)] if other is not None else []
    return found
