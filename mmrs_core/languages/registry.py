"""The metamodels at hand, and elements made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache, cached_property
from inspect import ismodule
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING
from weakref import WeakValueDictionary

from mmrs_core.errors import PluginError
from mmrs_core.languages.classes import ElementClass, joined, refuse_hiding
from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.languages.datatypes import BUILT_IN
from mmrs_core.languages.element import Element, chosen
from mmrs_core.languages.evolution.migration import Migration, chains
from mmrs_core.languages.metaclass import Metaclass, Package
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.sources import MetamodelSource as MetamodelSource
from mmrs_core.resources import shipped

if TYPE_CHECKING:
    from pyecore.ecore import EPackage

    from mmrs_core.languages.importers import Importer

_ONE_AT_A_TIME = RLock()
_ASSEMBLED: WeakValueDictionary[tuple[object, ...], Package] = WeakValueDictionary()
"""The first of the packages that were made of sources; it knows the others, and each of their classes it."""
CORE_LANGUAGES = ("robot", "mission", "context", "behaviour")


class Registry:
    """All metamodels that models may use.

    Attributes:
        packages: in the order in which they were given, a package before those inside it.
        migrations: steps from older versions of them.
        classes: the Python subclasses that elements are instances of, by the key of their metaclass.
        importers: of other tools' models, which become models of these metamodels.
        makers: functions that readers compiled, for the next file.
    """

    def __init__(
        self,
        packages: Iterable[Package],
        migrations: Iterable[Migration] = (),
        classes: Iterable[ElementClass] = (),
        importers: Iterable[Importer] = (),
    ) -> None:
        """Take packages that hold each other's types; errors of the classes as in `registry_with`."""
        self.packages = tuple(package for package in packages if package.ns_uri not in BUILT_IN)
        self.migrations = tuple(migrations)
        self.importers = tuple(importers)
        self.makers: dict[tuple[object, ...], Callable[..., bool] | None] = {}
        self._packages = {package.ns_uri: package for package in self.packages}
        self._metaclasses: Mapping[tuple[str, str], Metaclass] = {
            metaclass.key: metaclass for package in self.packages for metaclass in package.metaclasses
        }
        self.classes = self._fitting(classes)
        self._joined: dict[Metaclass, type[Element] | None] = {}

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
        packages = (*self.packages, *_assemble(more, self.packages))
        return Registry(packages, self.migrations, self.classes.values(), self.importers)

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
        metaclass = self.metaclass(ns_uri, name)
        element: Element = (self.implementation(metaclass) or metaclass.interface)(**features)
        return element

    def implementation(self, metaclass: Metaclass) -> type[Element] | None:
        """Return the class of a metaclass's elements; None for an abstract one.

        It is a subclass of each Python class that is registered for the metaclass or one above it; where
        these have something by the same name, the one for the most specific metaclass counts.
        """
        if not self.classes:
            return metaclass.implementation
        if metaclass not in self._joined:
            kinds = [self.classes[key].python for key in metaclass.ancestry if key in self.classes]
            first = tuple(
                each for at, each in enumerate(kinds) if not any(issubclass(k, each) for k in kinds[:at])
            )
            plain = metaclass.implementation
            self._joined[metaclass] = joined(metaclass, first) if plain and first else plain
        return self._joined[metaclass]

    @contextmanager
    def in_use(self) -> Iterator[None]:
        """Make calls of the language classes create what `create` creates, in this thread or task."""
        token = chosen.set(self.implementation)
        try:
            yield
        finally:
            chosen.reset(token)

    def _fitting(self, classes: Iterable[ElementClass]) -> Mapping[tuple[str, str], ElementClass]:
        found: dict[tuple[str, str], ElementClass] = {}
        for each in classes:
            other = found.setdefault(each.metaclass, each)
            if other is not each:
                both = f"{_described(other)} and {_described(each)}"
                raise PluginError(f"{'#//'.join(each.metaclass)}: two Python classes for it, {both}")
            ns_uri, name = each.metaclass
            if self.has(ns_uri) and each.metaclass not in self._metaclasses:  # else its plug-in is missing
                raise PluginError(f"{_described(each)}: {ns_uri} has no class {name} any more")
        for metaclass in self._metaclasses.values() if found else ():
            for key in metaclass.ancestry:
                if key in found:
                    _refuse_hiding(found[key], metaclass)
        return found


def _described(given: ElementClass) -> str:
    return given.python.__qualname__ + (given.provider and f" of {given.provider}")


def _refuse_hiding(given: ElementClass, metaclass: Metaclass) -> None:
    try:
        refuse_hiding(given.python, metaclass)
    except ValueError as error:
        raise PluginError(f"{given.provider}: {error}" if given.provider else str(error)) from None


def core_registry() -> Registry:
    """Return the four languages of the core; always the same registry."""
    with _ONE_AT_A_TIME:
        return _core_registry()


@cache
def _core_registry() -> Registry:
    folder = shipped("metamodels")
    sources = [MetamodelSource(f"urn:mmrs:{name}:1.0", folder / f"{name}.ecore") for name in CORE_LANGUAGES]
    return Registry(_assemble(sources, ()))


def members_of(ns_uri: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return the ``__getattr__`` and ``__dir__`` of a module that stands for a language of the core."""
    return (
        cache(lambda name: core_registry().package(ns_uri).member(name)),
        lambda: sorted(("NS_URI", *core_registry().package(ns_uri).members)),
    )


def registry_with(
    sources: Iterable[MetamodelSource],
    migrations: Iterable[Migration] = (),
    classes: Iterable[ElementClass] = (),
    importers: Iterable[Importer] = (),
) -> Registry:
    """Return the core's metamodels together with others, which may build upon each other in any order.

    Args:
        sources: the others.
        migrations: from older versions of any of them.
        classes: Python subclasses for elements, one for a metaclass; for whom this registry makes elements.
        importers: of other tools' models.

    Raises:
        PluginError: if a metamodel refers to one that is missing, two have the same nsURI, a class inherits
            from itself, a file holds another metamodel than announced, there are two Python classes for a
            metaclass, or one hides a feature of a metaclass below its own.
        UnreadableError: if a file is not a metamodel.
    """
    packages = (*core_registry().packages, *_assembled(tuple(sources)))
    return Registry(packages, migrations, classes, importers)


def _assembled(sources: tuple[MetamodelSource, ...]) -> tuple[Package, ...]:
    """Return packages, the same ones while anything uses one of them: their classes are to be subclassed."""
    given = (sources, tuple(_stamp(source.ecore) for source in sources))
    with _ONE_AT_A_TIME:
        if first := _ASSEMBLED.get(given):
            return tuple(each for each in first.known.values() if each.known is first.known)
        made = _assemble(sources, core_registry().packages)
        if made:
            _ASSEMBLED[given] = made[0]
        return made


def _stamp(ecore: Path | object) -> object:
    """Return what changes with a source: of an EPackage, the names in it."""
    if not isinstance(ecore, Path):
        inside = getattr(getattr(ecore, "eClass", None) if ismodule(ecore) else ecore, "eAllContents", tuple)
        return tuple(getattr(each, "name", None) for each in inside())
    try:
        found = ecore.stat()
    except OSError:  # whoever reads it has words for it
        return None
    return found.st_mtime_ns, found.st_size


def _assemble(sources: Iterable[MetamodelSource], known: tuple[Package, ...]) -> tuple[Package, ...]:
    with collector_at_rest():
        from mmrs_core.languages.metamodels.shapes import packages_of  # pyecore costs 0.1 s of start-up

        return packages_of(((each.ns_uri, each.ecore, each.provider) for each in sources), known)


def _itself() -> tuple[Package, ...]:
    from mmrs_core.languages.metamodels.shapes import itself  # as above

    return itself()
