"""Metamodels that are files of the user's, beside those that are installed."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.languages.metamodels.tables import PackageTable, read_tables
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with
from mmrs_core.languages.xmi.events import read_bytes

_REFERRED = re.compile(rb'[\s"]([^\s"#]+\.ecore)#')


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
    given = [file.resolve() for file in files]
    tables = {file: read_tables(file) for file in _with_neighbours(given)}
    held = {file: [uri for table in tables[file] for uri in _uris(table)] for file in tables}
    taken = {uri for uris in held.values() for uri in uris}
    sources = [MetamodelSource(uris[0], file, file.name) for file, uris in held.items()]
    others = [source for source in installed if source.ns_uri not in taken]
    wanted = tuple(dict.fromkeys(uri for file in given for uri in held[file]))
    return registry_with([*others, *sources]), wanted


def _with_neighbours(files: Iterable[Path]) -> list[Path]:
    found = list(dict.fromkeys(files))
    for file in found:  # grows on the way
        for named in _REFERRED.findall(read_bytes(file)):
            path = unquote(named.decode("utf-8", "replace"))
            places = (file.parent / path, file.parent / path.rpartition("/")[2])
            other = next((each.resolve() for each in places if each.is_file()), file)
            if other not in found:
                found.append(other)
    return found


def _uris(table: PackageTable) -> Iterable[str]:
    yield table.ns_uri
    for inner in table.subpackages:
        yield from _uris(inner)
