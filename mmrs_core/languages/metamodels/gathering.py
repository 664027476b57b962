"""Metamodel files that need each other: what one refers to, and where that lies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from os.path import isfile
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.metamodels.ecore_file import EcoreFile, read_ecore
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.registry import MetamodelSource, Registry, registry_with


def gathered(files: Iterable[Path], registry: Registry) -> Iterator[MetamodelSource]:
    """Yield metamodels, and those that they refer to, as far as they are not installed.

    Raises:
        UnreadableError: if a file is not a metamodel.
    """
    pending, seen = list(files), set()
    brought: set[str] = set()
    while pending:
        path = pending.pop(0)
        if real_path(path) in seen:
            continue
        seen.add(real_path(path))
        file = read_ecore(path)
        if any(registry.has(name) or name in brought for name in file.ns_uris):
            continue
        brought.update(file.ns_uris)
        yield MetamodelSource(file.ns_uris[0], path, str(path))
        for document in dict.fromkeys(file.documents()):
            pending += [other for other in _meant(document, path, registry) if real_path(other) not in seen]


def registry_of_files(
    files: Iterable[Path], installed: Iterable[MetamodelSource]
) -> tuple[Registry, tuple[str, ...]]:
    """Return the metamodels of some .ecore files with those that are installed, and the files' nsURIs.

    A file replaces an installed metamodel of the same nsURI. The .ecore files that it refers to
    are taken along where they are there; where a path leads nowhere, as in a workspace of Eclipse projects
    that were moved, a file of that name beside it.

    Args:
        files: the .ecore files.
        installed: what plug-ins bring.

    Raises:
        UnreadableError: if a file is not a metamodel.
        PluginError: if a metamodel refers to one that is missing, or two files hold the same.
    """
    given = [real_path(file) for file in files]
    held = {path: file.ns_uris for path, file in _with_neighbours(given).items()}
    taken = {uri for uris in held.values() for uri in uris}
    sources = [MetamodelSource(uris[0], path, path.name) for path, uris in held.items()]
    others = [source for source in installed if source.ns_uri not in taken]
    wanted = tuple(dict.fromkeys(uri for path in given for uri in held[path]))
    return registry_with([*others, *sources]), wanted


def _with_neighbours(files: Iterable[Path]) -> dict[Path, EcoreFile]:
    found: dict[Path, EcoreFile] = {}
    pending = list(files)
    while pending:
        path = pending.pop(0)
        if path in found:
            continue
        found[path] = read_ecore(path)
        for document in found[path].documents():
            other = file_at(document, path.parent) or file_at(document.rpartition("/")[2], path.parent)
            pending += [real_path(other)] if other is not None else []
    return found


def _meant(document: str, referrer: Path, registry: Registry) -> Iterator[Path]:
    """Yield the file that a metamodel refers to: by its path, or its name or nsURI where it lies beside."""
    if registry.has(document):
        return
    path = file_at(document, referrer.parent) or file_at(document.rpartition("/")[2], referrer.parent)
    if path is not None:
        yield path
        return
    for other, file in beside(referrer.parent):
        if document in file.ns_uris:
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


def beside(folder: Path) -> Iterator[tuple[Path, EcoreFile]]:
    """Yield the metamodels of a folder; a file that is none is not meant."""
    for path in sorted(folder.glob("*.ecore")):
        try:
            yield path, read_ecore(path)
        except UnreadableError:
            continue
