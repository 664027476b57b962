"""Models of any language whose metamodel is given, or pointed to by the model, or lies beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from os.path import relpath
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Unknown
from mmrs_core.languages.importers import is_importable
from mmrs_core.languages.metamodels.gathering import beside, file_at, gathered
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.schema_location import first_kind, stated_places
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
    beside_it = list(gathered(_candidates(path, _root_needs(path, known)), known))
    sources += beside_it
    known = known.extended(beside_it)
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
    """Return the language of a first element, unless it is known: what is unknown may not nest as deeply.

    Models that are imported need none.
    """
    with suppress(UnreadableError):  # reading it says why
        ns_uri, _ = first_kind(path)
        is_known = not ns_uri or registry.has(ns_uri) or is_importable(path, registry)
        return frozenset(() if is_known else (ns_uri,))
    return frozenset()


def missing_from(model: Model, registry: Registry, certainly: bool = False) -> frozenset[str]:
    """Return the nsURIs that elements of unknown classes need, or may need unless `certainly`."""
    if not any(part.diagnostics for part in (model, *model.linked)):
        return frozenset()  # of each of them there would be one
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
        if ns_uri in missing and (file := file_at(place, model.parent)) is not None:
            yield file
    for path, other in beside(model.parent):
        if not missing.isdisjoint(other.ns_uris):
            yield path


def kept_places(source: Path, target: Path) -> Mapping[str, str]:
    """Return where a model says its metamodels lie, as a copy of it in another place has to say it."""
    places = dict(stated_places(source))
    if source.resolve().parent != target.resolve().parent:
        for ns_uri, place in places.items():
            file = file_at(place, source.parent)
            if file is not None and not place.startswith("platform:"):
                _, hash_, fragment = place.partition("#")
                places[ns_uri] = (
                    Path(relpath(file.resolve(), target.resolve().parent)).as_posix() + hash_ + fragment
                )
    return places
