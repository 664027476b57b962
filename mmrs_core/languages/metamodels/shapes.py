"""Metaclasses derived from pyecore's EClasses: supertypes before subtypes, features inherited."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

from pyecore import ecore

from mmrs_core.errors import InternalError, PluginError
from mmrs_core.languages import classes
from mmrs_core.languages.datatypes import BUILT_IN, ECORE, DataType, builtin_type, refusal
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import MAP_ENTRY, Enumeration, Feature, Metaclass, Package
from mmrs_core.languages.metamodels.attribute_types import (
    data_type,
    default_of,
    documentation_of,
    enumeration_of,
)
from mmrs_core.languages.metamodels.ecore_itself import built_in
from mmrs_core.languages.metamodels.loading import LoadedPackages, epackage_of, load
from mmrs_core.languages.metamodels.locating import Address, Located, located_in
from mmrs_core.languages.naming import nearest, python_name
from mmrs_core.languages.values.texts import described

MOST_FEATURES = 500_000
"""The most features of all classes, inherited ones included; the largest metamodels have a tenth."""

_STRAYS = (ecore.EEnum.eClass, ecore.EDataType.eClass)
"""What modules that pyecoregen wrote take for classes of their own."""
_Type = Metaclass | DataType | Enumeration
_ANYTHING = (ECORE, "EObject")
_OWN_ECORE = "EStringToStringMapEntry"
"""A class of Ecore that pyecore has as a data type only."""


def packages_of(sources: Iterable[tuple[str, Any, str]], known: tuple[Package, ...]) -> tuple[Package, ...]:
    """Return the packages of metamodels, those inside others included.

    Args:
        sources: nsURI, .ecore file or EPackage, and the distribution that brings it.
        known: packages that stand.

    Raises:
        PluginError: if a metamodel is already there, does not hold the nsURI that is announced, refers to
            one that is missing, or is broken.
        UnreadableError: if a file is not a metamodel.
    """
    located: list[Located] = []
    seen = {package.ns_uri: package.provider for package in known}
    for ns_uri, given, provider in sources:
        found = (
            located_in(given, provider) if isinstance(given, Path) else list(_flat(given, given, provider))
        )
        if ns_uri not in [entry.ns_uri for entry in found]:
            held = ", ".join(entry.ns_uri for entry in found)
            label = given if isinstance(given, Path) else f"EPackage {getattr(given, 'name', '?')}"
            raise PluginError(f"{provider}: {label} holds {held}, not {ns_uri}")
        for entry in found:
            if entry.ns_uri in seen:
                before = seen[entry.ns_uri]
                raise PluginError(f"{provider}: metamodel {entry.ns_uri} is already provided by {before}")
            seen[entry.ns_uri] = provider
        located += found
    return _Shapes(known, load(located, known)).packages(located)


@cache
def itself() -> tuple[Package, ...]:
    """Return Ecore and EMF's types of XML, as far as models may hold them; always the same packages."""
    found = {package.nsURI: package for package in built_in()}
    located = [entry for package in found.values() for entry in _flat(package, None, "core")]
    return _Shapes((), LoadedPackages(found)).packages(located)


def _flat(package: Any, given: object, provider: str, parent: str = "") -> Iterable[Located]:
    if not isinstance(package, ecore.EPackage):
        what = f"neither the path of an .ecore file nor a pyecore EPackage, but {described(package)}"
        raise PluginError(f"{provider}: {what}")
    package = epackage_of(package)
    if not package.name or not package.nsURI:
        raise PluginError(f"{provider}: EPackage {package.name or '?'}: name or nsURI is missing")
    yield Located(package.nsURI, package.name, provider, given, parent)
    for inner in package.eSubpackages:
        yield from _flat(inner, given, provider, package.nsURI)


class _Shapes:
    """Packages whose metaclasses are derived from EClasses."""

    def __init__(self, known: tuple[Package, ...], loaded: LoadedPackages) -> None:
        """Take packages that stand already and share their classes, and those to be made."""
        self._loaded = loaded
        self._metaclasses: dict[Address, Metaclass] = {}
        self._types: dict[Address, DataType | Enumeration] = {}
        self._packages: dict[str, Package] = {}
        self._know(known)
        self._eclasses: dict[Address, tuple[Any, Located]] = {}
        self._done: set[Address] = set()
        self._count = 0
        self._unlinked: list[tuple[Feature, Any, Located]] = []

    def _know(self, packages: Iterable[Package]) -> None:
        for package in packages:
            self._packages[package.ns_uri] = package
            self._metaclasses |= {metaclass.key: metaclass for metaclass in package.metaclasses}
            self._types |= {(kind.ns_uri, kind.name): kind for kind in package.enumerations}
            self._types |= {(kind.ns_uri, kind.name): kind for kind in package.datatypes}

    def packages(self, located: Iterable[Located]) -> tuple[Package, ...]:
        """Return the packages to be made.

        Raises:
            PluginError: for a class or feature that no model can have.
        """
        entries = tuple(located)
        kinds = {entry.ns_uri: self._declare(self._loaded.packages[entry.ns_uri], entry) for entry in entries}
        for address, (eclass, entry) in self._eclasses.items():
            self._inherit(address, eclass, entry)
        for feature, reference, entry in self._unlinked:
            self._join(feature, reference, entry)
        made = tuple(self._package(entry, kinds[entry.ns_uri]) for entry in entries)
        self._packages |= {package.ns_uri: package for package in made}
        for package in made:
            for metaclass in package.metaclasses:
                _complete(metaclass, package=package)
        return made

    def _declare(self, package: Any, entry: Located) -> list[_Type]:
        """Note the classifiers of a package, and return what they are to be."""
        ns_uri = entry.ns_uri
        kinds = [kind for kind in package.eClassifiers if kind not in _STRAYS]
        for kind in kinds:
            address = (ns_uri, kind.name)
            if address in self._metaclasses or address in self._types:
                self._refuse(entry, address, f"class {kind.name} is declared twice")
            if isinstance(kind, ecore.EEnum):
                self._types[address] = enumeration_of(ns_uri, kind)
            elif isinstance(kind, ecore.EDataType):
                self._types[address] = data_type(ns_uri, kind, entry.file is None)
            elif address == _ANYTHING:
                self._metaclasses[address] = _any_object()
            else:
                self._eclasses[address] = (kind, entry)
                self._metaclasses[address] = Metaclass(
                    ns_uri,
                    kind.name,
                    bool(kind.abstract or kind.interface),
                    documentation_of(kind),
                    is_entry=kind.instanceClassName == MAP_ENTRY,
                    eclass=_eclass(ns_uri, kind),
                    python=classes,
                )
        addresses = [(ns_uri, kind.name) for kind in kinds]
        return [self._metaclasses.get(each) or self._types[each] for each in addresses]

    def _inherit(self, address: Address, eclass: Any, entry: Located) -> None:
        if address in self._done:
            return
        self._done.add(address)
        metaclass = self._metaclasses[address]
        supertypes = []
        for above in eclass.eSuperTypes:
            other = self._address_of(above, entry, address)
            if other in self._eclasses:
                self._inherit(other, *self._eclasses[other])
            supertypes.append(self._class(other, entry, address))
        _complete(metaclass, supertypes=tuple(supertypes))
        self._give_features(metaclass, eclass, entry)

    def _give_features(self, metaclass: Metaclass, eclass: Any, entry: Located) -> None:
        inherited = dict.fromkeys(feature for above in metaclass.supertypes for feature in above.features)
        taken = {feature.attribute for feature in inherited}
        own = []
        for each in eclass.eStructuralFeatures:
            feature = self._feature(metaclass, each, entry, python_name(each.name, taken))
            taken.add(feature.attribute)
            own.append(feature)
        features = (*inherited, *own)
        self._count += len(features)
        if self._count > MOST_FEATURES:
            self._refuse(entry, metaclass.key, f"more than {MOST_FEATURES} features")
        by_name = {feature.name: feature for feature in features}
        if len(by_name) < len(features):
            twice = next(feature.name for feature in features if by_name[feature.name] is not feature)
            self._refuse(entry, metaclass.key, f"{metaclass.name} has two features {twice}")
        by_attribute = {feature.attribute: feature for feature in features}
        if len(by_attribute) < len(features):
            self._refuse(entry, metaclass.key, _one_name(metaclass, features))
        _complete(metaclass, features=features, by_name=by_name, by_attribute=by_attribute)

    def _feature(self, owner: Metaclass, given: Any, entry: Located, attribute: str) -> Feature:
        address = (*owner.key, given.name)
        if given.eType is None:
            self._refuse(entry, address, f"{owner.name}.{given.name}: eType is missing")
        is_reference = isinstance(given, ecore.EReference)
        key = self._address_of(given.eType, entry, address)
        kind = self._class(key, entry, address) if is_reference else self._value_type(key, entry, address)
        upper = 1 if given.upperBound == _UNSPECIFIED else given.upperBound
        is_entry = isinstance(kind, Metaclass) and kind.is_entry
        try:
            default = default_of(given, kind, upper)
        except ValueError as fault:
            self._refuse(entry, address, f"{owner.name}.{given.name}: default {fault}")
        feature = Feature(
            name=given.name,
            attribute=attribute,
            documentation=documentation_of(given),
            lower=given.lowerBound,
            upper=upper,
            is_reference=is_reference,
            containment=is_reference and bool(given.containment),
            unsettable=bool(given.unsettable),
            unique=bool(given.unique),
            is_id=not is_reference and bool(given.iD),
            stored=not given.transient and getattr(kind, "serializable", True),
            owner=owner,
            type=kind,
            keys=("key",) if is_entry else tuple(key.name for key in getattr(given, "eKeys", ())),
            default=default,
        )
        if is_reference and given.eOpposite is not None:
            self._unlinked.append((feature, given.eOpposite, entry))
        return feature

    def _address_of(self, kind: Any, entry: Located, address: Address) -> Address:
        try:
            return _address(kind)
        except ValueError as fault:
            self._refuse(entry, address, f"{'.'.join(address[1:])}: {fault}")

    def _class(self, key: Address, entry: Located, address: Address) -> Metaclass:
        if key == _ANYTHING:
            return _any_object()
        if key[0] in BUILT_IN and key not in self._metaclasses:
            self._know(itself())
        if key not in self._metaclasses:
            self._refuse(entry, address, self._no_type(key, address))
        return self._metaclasses[key]

    def _value_type(self, key: Address, entry: Located, address: Address) -> DataType | Enumeration:
        if reason := refusal(*key):
            self._refuse(entry, address, f"{'.'.join(address[1:])}: {reason}")
        found = self._types.get(key) or builtin_type(*key)
        if found is None and key[0] in BUILT_IN:  # one whose values live in Java only
            self._know(itself())
            found = self._types.get(key)
        if found is None:
            self._refuse(entry, address, self._no_type(key, address))
        return found

    def _no_type(self, key: Address, address: Address) -> str:
        ns_uri, name = key
        if ns_uri not in self._loaded.packages and ns_uri not in (*self._packages, *BUILT_IN):
            return f"{'.'.join(address[1:])}: needs the metamodel {ns_uri} (for {name})"
        hint = nearest(name, [known for uri, known in (*self._metaclasses, *self._types) if uri == ns_uri])
        return f"{'.'.join(address[1:])}: no type {name} in {ns_uri}{hint and '; ' + hint}"

    def _join(self, feature: Feature, opposite: Any, entry: Located) -> None:
        address = (*feature.owner.key, feature.name)
        owner = self._class(self._address_of(opposite.eContainingClass, entry, address), entry, address)
        other = owner.by_name.get(opposite.name)
        if other is None or not other.is_reference:
            self._refuse(entry, address, f"{feature.name}: {owner.name}/{opposite.name}: no such reference")
        feature.join(other)

    def _package(self, entry: Located, kinds: list[_Type]) -> Package:
        epackage = self._loaded.packages[entry.ns_uri]
        return Package(
            entry.ns_uri,
            entry.name,
            entry.name if epackage.nsPrefix is None else epackage.nsPrefix,
            entry.provider,
            documentation_of(epackage),
            tuple(kind for kind in kinds if isinstance(kind, Metaclass)),
            tuple(kind for kind in kinds if isinstance(kind, Enumeration)),
            tuple(kind for kind in kinds if isinstance(kind, DataType)),
            entry.ecore,
            entry.parent,
            self._packages,
            epackage,
            entry.root,
        )

    def _refuse(self, entry: Located, address: Address, reason: str) -> NoReturn:
        where, node = self._loaded.nodes.get(address, (entry, None))
        where.refuse(reason, node)


_UNSPECIFIED = -2
"""The upper bound that EMF calls unspecified, and that means one value."""


def _eclass(ns_uri: str, kind: Any) -> Any:
    """Return the EClass that stands for a class: pyecore's own, where it is one of Ecore."""
    own = getattr(ecore, kind.name, None) if ns_uri == ECORE and kind.name != _OWN_ECORE else None
    return kind if own is None else own.eClass


@cache
def _any_object() -> Metaclass:
    """Return Ecore's EObject, which every element is."""
    made = Metaclass(ECORE, "EObject", True, "Any element at all.", eclass=ecore.EObject.eClass)
    _complete(made, ancestry=(made.key,), interface=Element, implementation=None)
    return made


def _address(kind: Any) -> Address:
    """Return what a classifier is known by.

    Raises:
        ValueError: if it is in no package, or in a file that pyecore does not find.
    """
    try:
        eclass = kind.dyn_inst  # where a Python class stands for it, as pyecoregen writes them
        package = eclass.ePackage
    except Exception as fault:  # a proxy, whatever it runs into
        raise ValueError(f"pyecore does not find what it refers to: {fault}") from None
    if package is None:
        raise ValueError(f"{eclass.name} is in no EPackage")
    return package.nsURI, eclass.name


def _one_name(metaclass: Metaclass, features: Iterable[Feature]) -> str:
    """Return which features, inherited from different classes, Python cannot tell apart."""
    seen: dict[str, Feature] = {}
    for feature in features:
        other = seen.setdefault(feature.attribute, feature)
        if other is not feature:
            both = f"{other.owner.name}.{other.name} and {feature.owner.name}.{feature.name}"
            return (
                f"{metaclass.name} inherits {both}, which are both {feature.attribute} in Python; rename one"
            )
    raise InternalError(f"{metaclass.name}: no two features share an attribute")


def _complete(metaclass: Metaclass, **fields: object) -> None:
    """Fill in what could not be known when the metaclass was made: classes refer to each other in circles."""
    for name, value in fields.items():
        object.__setattr__(metaclass, name, value)
