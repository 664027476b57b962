"""Which package of a newer version is which of the older, in the files of both and in those they refer to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.languages.evolution.versions import Version
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.missing import stem_of


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
    one nsURI are the same; else those of one name inside the same package; else, among the files that are
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
    told = [(by_uri[ns_uri], package) for ns_uri, package in same.items()]
    taken = {package.ns_uri for package in same.values()}
    return Pairs(
        tuple(told),
        tuple(package for package in ours if package.ns_uri not in same),
        tuple(package for package in theirs if package.ns_uri not in taken),
    )


def _renamed(package: Package, candidates: Sequence[Package], same: dict[str, Package]) -> Package | None:
    """Return what a package is called now that bears no nsURI of the newer version."""
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
