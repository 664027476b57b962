"""Two versions of a metamodel: their packages, and which package of one is which of the other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.languages.datatypes import BUILT_IN
from mmrs_core.languages.metaclass import Metaclass, Package
from mmrs_core.languages.metamodels.ecore_file import read_ecore
from mmrs_core.languages.metamodels.gathering import gathered
from mmrs_core.languages.missing import stem_of
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
        UnreadableError: if the file cannot be read or is not a metamodel.
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


@dataclass(frozen=True, slots=True)
class Pairs:
    """The packages of two versions.

    Attributes:
        same: older and newer package, the versions' own first.
        gone: those that only the older version has.
        come: those that only the newer one has.
    """

    same: tuple[tuple[Package, Package], ...]
    gone: tuple[Package, ...]
    come: tuple[Package, ...]

    def files(self) -> Iterator[tuple[str, str]]:
        """Yield which files were compared, each pair once; a language that no file brings by its nsURI."""
        yield from dict.fromkeys((_file_of(old), _file_of(new)) for old, new in self.same)


def pairs_of(old: Version, new: Version) -> Pairs:
    """Return which packages are to be compared.

    The outermost package of one version is that of the other, whatever it is called. Of all others, those of
    one nsURI are the same; next, those of one name inside the same package; last, among the files that are
    referred to, those whose nsURIs differ in the version at their ends, or whose files have one name.
    """
    same: dict[str, Package] = {old.packages[0].ns_uri: new.packages[0]}
    ours = (*old.packages, *old.others)
    theirs = [*new.packages[1:], *new.others]
    known = {package.ns_uri for package in ours}
    for package in ours[1:]:
        if new.registry.has(package.ns_uri):
            same[package.ns_uri] = new.registry.package(package.ns_uri)
        else:
            left = [each for each in theirs if each.ns_uri not in known and each not in same.values()]
            found = _renamed(package, left, same)
            same |= {package.ns_uri: found} if found is not None else {}
    paired = {package.ns_uri for package in same.values()}
    for package in theirs:
        if package.ns_uri not in paired and old.registry.has(package.ns_uri):
            same[package.ns_uri] = package
    by_uri = {package.ns_uri: package for package in (*ours, *old.registry.packages)}
    reported = [(by_uri[ns_uri], package) for ns_uri, package in same.items()]
    taken = {package.ns_uri for package in same.values()}
    return Pairs(
        tuple(reported),
        tuple(package for package in ours if package.ns_uri not in same),
        tuple(package for package in theirs if package.ns_uri not in taken),
    )


def _renamed(package: Package, candidates: Sequence[Package], same: dict[str, Package]) -> Package | None:
    """Return what a package is called now whose nsURI the newer version does not have."""
    if package.parent:
        above = same[package.parent].ns_uri if package.parent in same else ""
        return next((each for each in candidates if (each.parent, each.name) == (above, package.name)), None)
    outer = [each for each in candidates if not each.parent]
    alike = [each for each in outer if stem_of(each.ns_uri) == stem_of(package.ns_uri)]
    alike += [each for each in outer if _file_name(each) == _file_name(package) != ""]
    return alike[0] if alike else None


def _file_name(package: Package) -> str:
    return package.ecore.name if isinstance(package.ecore, Path) else ""


def _file_of(package: Package) -> str:
    return str(package.ecore) if isinstance(package.ecore, Path) else package.ns_uri
