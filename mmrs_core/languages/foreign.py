"""Models of any language whose metamodel is given, or pointed to by the model, or lies beside it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from os.path import isfile
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Unknown
from mmrs_core.languages.metamodels.tables import PackageTable, read_tables
from mmrs_core.languages.model import Model
from mmrs_core.languages.places import first_kind, stated_places
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import MetamodelSource, Registry
from mmrs_core.languages.xmi.events import XMI, XSI

_MOST_ROUNDS = 5
"""A metamodel that was found may show that another is missing, in what was unknown before."""


@dataclass(frozen=True, slots=True)
class ForeignModel:
    """A model, and the metamodels it was read with.

    Attributes:
        registry: what was installed, and what was found.
        found: the metamodel files that were read for it.
    """

    model: Model
    registry: Registry
    found: tuple[Path, ...] = ()


def read_any(
    path: Path,
    registry: Registry,
    metamodels: Sequence[Path] = (),
    unsaved: Mapping[Path, bytes] | None = None,
) -> ForeignModel:
    """Return the model in a file, of whatever language.

    Args:
        path: an XMI or JSON file.
        registry: the metamodels that are installed.
        metamodels: .ecore files, which may refer to others beside them. What is still missing is looked for
            where the model's ``xsi:schemaLocation`` says, and among the .ecore files of its folder.
        unsaved: what is read instead of a file.

    Raises:
        UnreadableError: if the file, or a metamodel that was given, cannot be read.
        PluginError: if a metamodel is broken.
    """
    sources = list(gathered(metamodels, registry))
    known = registry.extended(sources)
    sources += gathered(_candidates(path, _root_needs(path, known)), known)
    known = registry.extended(sources)
    model = read_model(path, known, unsaved=unsaved)
    for _ in range(_MOST_ROUNDS):
        missing = missing_from(model, known)
        more = list(gathered(_candidates(path, missing), known)) if missing else []
        if not more:
            break
        sources += more
        known = known.extended(more)
        model = read_model(path, known, unsaved=unsaved)
    files = tuple(source.ecore for source in sources if isinstance(source.ecore, Path))
    return ForeignModel(model, known, files)


def _root_needs(path: Path, registry: Registry) -> frozenset[str]:
    """Return the language of a first element, unless it is known: what is unknown may not nest as deeply."""
    with suppress(UnreadableError):  # reading it says why
        ns_uri, _ = first_kind(path)
        return frozenset((ns_uri,) if ns_uri and not registry.has(ns_uri) else ())
    return frozenset()


def missing_from(model: Model, registry: Registry, certainly: bool = False) -> frozenset[str]:
    """Return the nsURIs that elements of unknown classes need, or may need unless `certainly`."""
    unknown = [
        element
        for part in (model, *model.linked)
        for element in part.elements()
        if isinstance(element, Unknown)
    ]
    named = {element._mmrs_type.rpartition("#")[0] for element in unknown}
    named |= set() if certainly else {uri for element in unknown for uri in element._mmrs_scope.values()}
    return frozenset(uri for uri in named if uri and uri not in (XMI, XSI) and not registry.has(uri))


def _candidates(model: Path, missing: frozenset[str]) -> Iterator[Path]:
    for ns_uri, place in stated_places(model).items():
        if ns_uri in missing and (file := _file_at(place, model.parent)) is not None:
            yield file
    for file, tables in _beside(model.parent):
        if any(table.ns_uri in missing for table in flat(tables)):
            yield file


def gathered(files: Iterable[Path], registry: Registry) -> Iterator[MetamodelSource]:
    """Yield metamodels, and those that they refer to, as far as they are not installed.

    Raises:
        UnreadableError: if a file is no metamodel.
    """
    pending, seen = list(files), set()
    brought: set[str] = set()
    while pending:
        file = pending.pop(0)
        if file.resolve() in seen:
            continue
        seen.add(file.resolve())
        tables = read_tables(file)
        names = {table.ns_uri for table in flat(tables)}
        if any(registry.has(name) or name in brought for name in names):
            continue
        brought |= names
        yield MetamodelSource(tables[0].ns_uri, file, str(file))
        for document in dict.fromkeys(documents_of(tables)):
            pending += [other for other in _meant(document, file, registry) if other.resolve() not in seen]


def documents_of(tables: Iterable[PackageTable]) -> Iterator[str]:
    """Yield the documents that packages refer to."""
    for table in flat(tables):
        for row in table.classes:
            uris = (*row.supertypes, *(uri for each in row.features for uri in (each.type, each.opposite)))
            yield from (document for uri in uris if (document := uri.partition("#")[0]))


def _meant(document: str, referrer: Path, registry: Registry) -> Iterator[Path]:
    """Yield the file that a metamodel refers to: by its path, or by nsURI where it lies beside."""
    if registry.has(document):
        return
    file = _file_at(document, referrer.parent)
    if file is not None:
        yield file
        return
    for beside, tables in _beside(referrer.parent):
        if any(table.ns_uri == document for table in flat(tables)):
            yield beside


def _file_at(place: str, folder: Path) -> Path | None:
    """Return the .ecore file that a relative or ``platform:`` URI means, if there is one."""
    path = unquote(place.partition("#")[0])
    if path.startswith("platform:"):
        path = path.rpartition("/")[2]
    if ":" in path or path.startswith(("/", "\\")) or "\0" in path or not path.endswith(".ecore"):
        return None
    file = folder / path
    return file if isfile(file) else None  # noqa: PTH113  Path.is_file raises for a name that is too long


def _beside(folder: Path) -> Iterator[tuple[Path, tuple[PackageTable, ...]]]:
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


def kept_places(source: Path, target: Path) -> Mapping[str, str]:
    """Return where a model says its metamodels lie, as a copy of it in another place has to say it."""
    from os.path import relpath

    places = dict(stated_places(source))
    if source.resolve().parent != target.resolve().parent:
        for ns_uri, place in places.items():
            file = _file_at(place, source.parent)
            if file is not None and not place.startswith("platform:"):
                _, hash_, fragment = place.partition("#")
                places[ns_uri] = (
                    Path(relpath(file.resolve(), target.resolve().parent)).as_posix() + hash_ + fragment
                )
    return places
