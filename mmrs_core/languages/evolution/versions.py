"""Two versions of a metamodel, each with what it needs, whichever are installed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.languages.datatypes import BUILT_IN
from mmrs_core.languages.metaclass import Metaclass, Package
from mmrs_core.languages.metamodels.ecore_file import read_ecore
from mmrs_core.languages.metamodels.gathering import gathered
from mmrs_core.languages.registry import MetamodelSource, Registry


@dataclass(frozen=True, slots=True)
class Version:
    """One version of a metamodel.

    Attributes:
        label: what messages call it.
        packages: it and those inside it, outer ones first.
        registry: these, and what they need.
        others: those of the files that it refers to, and of those that these refer to; installed ones left
            out.
    """

    label: str
    packages: tuple[Package, ...]
    registry: Registry
    others: tuple[Package, ...] = ()

    def metaclass(self, ns_uri: str, name: str) -> Metaclass | None:
        """Return a class, or None if there is no such class."""
        if not self.registry.has(ns_uri):
            return None
        kinds = self.registry.package(ns_uri).metaclasses
        return next((kind for kind in kinds if kind.name == name), None)


def version_of(given: str, installed: Registry) -> Version:
    """Return the metamodel in an .ecore file, or the installed one of an nsURI.

    What a file needs is taken from the files it refers to, else from what is installed.

    Raises:
        UnreadableError: if the file cannot be read or is no metamodel.
        PluginError: if the metamodel is broken, or needs another that is not at hand.
        ValueError: if no metamodel of that nsURI is installed.
    """
    file = Path(given)
    if not given.endswith(".ecore") and not file.is_file():
        return _packed(given, given, installed)
    sources = list(gathered([file], Registry(())))
    referred = [source.ns_uri for source in sources[1:]]
    sources += _needed(sources, installed)
    return _packed(given, sources[0].ns_uri, Registry(()).extended(sources), referred)


def _packed(label: str, ns_uri: str, registry: Registry, referred: Iterable[str] = ()) -> Version:
    packages = _with_inner([ns_uri], registry)
    others = _with_inner((each for each in referred if each != ns_uri), registry)
    return Version(label, packages, registry, others)


def _with_inner(ns_uris: Iterable[str], registry: Registry) -> tuple[Package, ...]:
    """Return packages and those inside them, outer ones first."""
    packages = [registry.package(ns_uri) for ns_uri in ns_uris]
    for package in packages:
        packages += [inner for inner in registry.packages if inner.parent == package.ns_uri]
    return tuple(packages)


def _needed(sources: list[MetamodelSource], installed: Registry) -> Iterator[MetamodelSource]:
    """Yield the installed metamodels that others need, and those that these need."""
    files = [source.ecore for source in sources if isinstance(source.ecore, Path)]
    brought = {ns_uri for path in files for ns_uri in read_ecore(path).ns_uris}
    pending = [source.ecore for source in sources]
    while pending:
        ecore = pending.pop()
        if not isinstance(ecore, Path):
            continue
        for document in read_ecore(ecore).documents():
            if document in brought or document in BUILT_IN or not installed.has(document):
                continue
            package = _outermost(document, installed)
            brought.add(document)
            if package.ns_uri in brought - {document}:
                continue
            brought.add(package.ns_uri)
            pending.append(package.ecore)
            yield MetamodelSource(package.ns_uri, package.ecore, package.provider)


def _outermost(ns_uri: str, registry: Registry) -> Package:
    package = registry.package(ns_uri)
    while package.parent:
        package = registry.package(package.parent)
    return package
