"""The metamodels at hand, and elements made of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache, cached_property
from typing import TYPE_CHECKING

from mmrs_core.languages.datatypes import BUILT_IN
from mmrs_core.languages.element import Element
from mmrs_core.languages.evolution.migration import Migration, chains
from mmrs_core.languages.metaclass import Metaclass, Package
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.sources import MetamodelSource as MetamodelSource
from mmrs_core.resources import shipped

if TYPE_CHECKING:
    from pyecore.ecore import EPackage

    from mmrs_core.languages.xmi.shapes import Maker

CORE_LANGUAGES = ("robot", "mission", "context", "behaviour")


class Registry:
    """All metamodels that models may use.

    Attributes:
        packages: in the order in which they were given, a package before those inside it.
        migrations: steps from older versions of them.
        makers: functions that readers compiled, for the next file.
    """

    def __init__(self, packages: Iterable[Package], migrations: Iterable[Migration] = ()) -> None:
        self.packages = tuple(package for package in packages if package.ns_uri not in BUILT_IN)
        self.migrations = tuple(migrations)
        self.makers: dict[tuple[object, ...], Maker | None] = {}
        self._packages = {package.ns_uri: package for package in self.packages}
        self._metaclasses: Mapping[tuple[str, str], Metaclass] = {
            metaclass.key: metaclass for package in self.packages for metaclass in package.metaclasses
        }

    @property
    def everything(self) -> tuple[Package, ...]:
        """Its packages after Ecore itself and EMF's types of XML, as far as models may hold them."""
        return (*_itself(), *self.packages)

    def package(self, ns_uri: str) -> Package:
        """Return the package of that nsURI.

        Raises:
            ValueError: if there is none, with the nearest nsURI.
        """
        if ns_uri in BUILT_IN:
            return _itself()[BUILT_IN.index(ns_uri)]
        try:
            return self._packages[ns_uri]
        except KeyError:
            hint = nearest(ns_uri, self._packages)
            raise ValueError(f"{ns_uri}: no such metamodel{hint and '; ' + hint}") from None

    def epackage(self, ns_uri: str) -> EPackage:
        """Return the package of that nsURI as pyecore has it.

        Raises:
            ValueError: if there is none, with the nearest nsURI.
        """
        return self.package(ns_uri).epackage

    def metaclass(self, ns_uri: str, name: str) -> Metaclass:
        """Return a metaclass.

        Raises:
            ValueError: if there is no such package or no such class in it, with the nearest name.
        """
        try:
            return self._metaclasses[ns_uri, name]
        except KeyError:
            kinds = {metaclass.name: metaclass for metaclass in self.package(ns_uri).metaclasses}
            if name in kinds:  # one of Ecore itself
                return kinds[name]
            hint = nearest(name, kinds)
            raise ValueError(f"{name}: no class of {ns_uri}{hint and '; ' + hint}") from None

    def has(self, ns_uri: str) -> bool:
        """Return whether the metamodel of that nsURI is here."""
        return ns_uri in self._packages or ns_uri in BUILT_IN

    def extended(self, sources: Iterable[MetamodelSource]) -> Registry:
        """Return these metamodels together with others; errors as in `registry_with`."""
        more = tuple(sources)
        if not more:
            return self
        return Registry((*self.packages, *_assemble(more, self.packages)), self.migrations)

    @cached_property
    def chains(self) -> Mapping[str, tuple[Migration, ...]]:
        """The migrations that lead to an installed version, by the nsURI where they begin.

        Raises:
            PluginError: if migrations lead in a circle, or two begin at one nsURI.
        """
        return chains(self.migrations, self._packages)

    def create(self, ns_uri: str, name: str, /, **features: object) -> Element:
        """Return a new element whose features have the given values.

        Raises:
            ValueError: if the class is unknown or abstract, or has no such feature.
        """
        element: Element = self.metaclass(ns_uri, name).interface(**features)
        return element


@cache
def core_registry() -> Registry:
    """Return the four languages of the core; always the same registry."""
    folder = shipped("metamodels")
    sources = [MetamodelSource(f"urn:mmrs:{name}:1.0", folder / f"{name}.ecore") for name in CORE_LANGUAGES]
    return Registry(_assemble(sources, ()))


def registry_with(sources: Iterable[MetamodelSource], migrations: Iterable[Migration] = ()) -> Registry:
    """Return the core's metamodels together with others, which may build upon each other in any order.

    Args:
        sources: the others.
        migrations: from older versions of any of them.

    Raises:
        PluginError: if a metamodel refers to one that is missing, two have the same nsURI, a class inherits
            from itself, or a file holds another metamodel than announced.
        UnreadableError: if a file is no metamodel.
    """
    core = core_registry().packages
    return Registry((*core, *_assemble(tuple(sources), core)), migrations)


def _assemble(sources: Iterable[MetamodelSource], known: tuple[Package, ...]) -> tuple[Package, ...]:
    from mmrs_core.languages.metamodels.shapes import packages_of  # pyecore costs 0.1 s of start-up

    return packages_of(((each.ns_uri, each.ecore, each.provider) for each in sources), known)


def _itself() -> tuple[Package, ...]:
    from mmrs_core.languages.metamodels.shapes import itself  # as above

    return itself()
