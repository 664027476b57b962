"""Metaclasses made of tables: types looked up, supertypes before subtypes, features inherited."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.errors import InternalError, PluginError
from mmrs_core.languages.datatypes import ECORE, DataType, builtin_type, declared_type
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import MANY, Enumeration, Feature, Metaclass, Package
from mmrs_core.languages.metamodels.ecore_itself import built_in
from mmrs_core.languages.metamodels.locating import Directory, Located
from mmrs_core.languages.metamodels.tables import MAP_ENTRY, ClassTable, FeatureTable
from mmrs_core.languages.naming import nearest, python_name

DEEPEST_INHERITANCE = 100
MOST_FEATURES = 500_000
"""Of all classes together, inherited ones counted again in each; the largest metamodels have a tenth."""

_Key = tuple[str, str]
_Type = Metaclass | DataType | Enumeration
_ANYTHING = (ECORE, "EObject")


def _any_object() -> Metaclass:
    """Return Ecore's EObject, which every element is."""
    metaclass = Metaclass(ECORE, "EObject", True, "Any element at all.")
    _complete(metaclass, ancestry=(metaclass.key,), interface=Element, implementation=None)
    return metaclass


class Assembly:
    """Packages on their way from tables to metaclasses."""

    def __init__(self, known: Iterable[Package], located: Iterable[Located]) -> None:
        """Take packages that stand already and share their classes, and those to be made."""
        packages = tuple(known)
        self._located = tuple(located) if packages else (*located, *built_in())
        self._directory = Directory(self._located, packages)
        self._metaclasses: dict[_Key, Metaclass] = {}
        self._types: dict[_Key, DataType | Enumeration] = {}
        for package in packages:
            self._metaclasses |= {metaclass.key: metaclass for metaclass in package.metaclasses}
            self._types |= {(kind.ns_uri, kind.name): kind for kind in package.enumerations}
            self._types |= {(kind.ns_uri, kind.name): kind for kind in package.datatypes}
        self._packages = {package.ns_uri: package for package in packages}
        self._tables: dict[_Key, tuple[ClassTable, Located]] = {}
        self._depths: dict[_Key, int] = {}
        self._count = 0
        self._unlinked: list[tuple[Feature, FeatureTable, Located]] = []

    def packages(self) -> tuple[Package, ...]:
        """Return the packages to be made.

        Raises:
            PluginError: for an undeclared type, a class that inherits from itself, or a name used twice.
        """
        for entry in self._located:
            self._declare(entry)
        for key, (table, entry) in self._tables.items():
            self._inherit(key, table, entry, ())
        for feature, row, entry in self._unlinked:
            self._join_opposites(feature, row, entry)
        made = tuple(self._package(entry) for entry in self._located)
        self._packages |= {package.ns_uri: package for package in made}
        for package in made:
            for metaclass in package.metaclasses:
                _complete(metaclass, package=package)
        return made

    def _declare(self, entry: Located) -> None:
        ns_uri = entry.table.ns_uri
        for enum in entry.table.enums:
            self._types[ns_uri, enum.name] = Enumeration(ns_uri, enum.name, enum.literals, enum.documentation)
        for kind in entry.table.datatypes:
            known = builtin_type(ns_uri, kind.name)
            declared = declared_type(ns_uri, kind.name, kind.java_class, kind.serializable)
            self._types[ns_uri, kind.name] = known or declared
        for table in entry.table.classes:
            if (ns_uri, table.name) in self._tables or (ns_uri, table.name) in self._types:
                raise PluginError(f"{entry.provider}: {ns_uri}: class {table.name} is declared twice")
            if (ns_uri, table.name) == _ANYTHING:
                self._metaclasses[_ANYTHING] = _any_object()
                continue
            self._tables[ns_uri, table.name] = (table, entry)
            self._metaclasses[ns_uri, table.name] = Metaclass(
                ns_uri,
                table.name,
                table.abstract,
                table.documentation,
                is_entry=table.java_class == MAP_ENTRY,
            )

    def _inherit(self, key: _Key, table: ClassTable, entry: Located, below: tuple[_Key, ...]) -> None:
        metaclass = self._metaclasses[key]
        if key in self._depths:
            return
        if key in below:
            raise PluginError(
                f"{entry.provider}: {entry.table.ns_uri}: class {table.name} inherits from itself"
            )
        if len(below) > DEEPEST_INHERITANCE:
            raise self._too_deep(table, entry)
        supertypes, depth = [], 0
        for uri in table.supertypes:
            above = self._directory.find(uri, entry)
            if above in self._tables:
                self._inherit(above, *self._tables[above], (*below, key))
            supertypes.append(self._class(above, entry, f"supertype of {table.name}"))
            depth = max(depth, self._depths.get(above, 0))
        if depth >= DEEPEST_INHERITANCE:
            raise self._too_deep(table, entry)
        self._depths[key] = depth + 1
        _complete(metaclass, supertypes=tuple(supertypes))
        self._give_features(metaclass, table, entry)

    def _too_deep(self, table: ClassTable, entry: Located) -> PluginError:
        reason = f"class {table.name} inherits through more than {DEEPEST_INHERITANCE} others"
        return PluginError(f"{entry.provider}: {entry.table.ns_uri}: {reason}")

    def _give_features(self, metaclass: Metaclass, table: ClassTable, entry: Located) -> None:
        inherited = dict.fromkeys(feature for above in metaclass.supertypes for feature in above.features)
        taken = {feature.attribute for feature in inherited}
        own = []
        for row in table.features:
            feature = self._feature(metaclass, row, entry, python_name(row.name, taken))
            taken.add(feature.attribute)
            own.append(feature)
        features = (*inherited, *own)
        self._count += len(features)
        if self._count > MOST_FEATURES:
            raise PluginError(f"{entry.provider}: {metaclass.ns_uri}: more than {MOST_FEATURES} features")
        by_name = {feature.name: feature for feature in features}
        if len(by_name) < len(features):
            twice = next(feature.name for feature in features if by_name[feature.name] is not feature)
            raise PluginError(f"{entry.provider}: {metaclass.ns_uri}: {table.name} has two features {twice}")
        by_attribute = {feature.attribute: feature for feature in features}
        if len(by_attribute) < len(features):
            raise self._one_name(table, features, entry)
        _complete(metaclass, features=features, by_name=by_name, by_attribute=by_attribute)

    def _one_name(self, table: ClassTable, features: Iterable[Feature], entry: Located) -> PluginError:
        """Return the error for features, inherited from different classes, that Python cannot tell apart."""
        seen: dict[str, Feature] = {}
        for feature in features:
            other = seen.setdefault(feature.attribute, feature)
            if other is not feature:
                both = f"{other.owner.name}.{other.name} and {feature.owner.name}.{feature.name}"
                reason = f"{table.name} inherits {both}, which are both {feature.attribute} in Python"
                return PluginError(f"{entry.provider}: {entry.table.ns_uri}: {reason}; rename one")
        raise InternalError(f"{table.name}: no two features share an attribute")

    def _feature(self, owner: Metaclass, row: FeatureTable, entry: Located, attribute: str) -> Feature:
        where = f"{owner.name}.{row.name}"
        if not row.type:
            raise PluginError(f"{entry.provider}: {entry.table.ns_uri}: {where}: eType is missing")
        key = self._directory.find(row.type, entry)
        kind = self._class(key, entry, where) if row.is_reference else self._value_type(key, entry, where)
        feature = Feature(
            name=row.name,
            attribute=attribute,
            documentation=row.documentation,
            lower=row.lower,
            upper=row.upper,
            is_reference=row.is_reference,
            containment=row.containment,
            unsettable=row.unsettable,
            unique=row.unique,
            is_id=row.is_id,
            stored=row.stored and getattr(kind, "serializable", True),
            owner=owner,
            type=kind,
            keys=self._keys(row, kind, entry),
            default=_default(row, kind, f"{entry.provider}: {entry.table.ns_uri}: {where}"),
        )
        if row.opposite:
            self._unlinked.append((feature, row, entry))
        return feature

    def _keys(self, row: FeatureTable, kind: _Type, entry: Located) -> tuple[str, ...]:
        if isinstance(kind, Metaclass) and kind.is_entry:
            return ("key",)
        return tuple(self._directory.find_feature(uri, entry)[2] for uri in row.keys)

    def _class(self, key: _Key, entry: Located, where: str) -> Metaclass:
        if key in self._metaclasses:
            return self._metaclasses[key]
        raise PluginError(self._no_type(key, entry, where))

    def _value_type(self, key: _Key, entry: Located, where: str) -> DataType | Enumeration:
        found = self._types.get(key) or builtin_type(*key)
        if found is None:
            raise PluginError(self._no_type(key, entry, where))
        return found

    def _no_type(self, key: _Key, entry: Located, where: str) -> str:
        ns_uri, name = key
        if name == "EFeatureMapEntry":
            message = "a feature map, which models here cannot hold; use a reference to a common supertype"
            return f"{entry.provider}: {entry.table.ns_uri}: {where}: {message}"
        hint = nearest(name, [known for uri, known in (*self._metaclasses, *self._types) if uri == ns_uri])
        message = f"{entry.provider}: {entry.table.ns_uri}: {where}: no type {name} in {ns_uri}"
        return f"{message}; {hint}" if hint else message

    def _join_opposites(self, feature: Feature, row: FeatureTable, entry: Located) -> None:
        ns_uri, owner, name = self._directory.find_feature(row.opposite, entry)
        other = self._class((ns_uri, owner), entry, row.name).by_name.get(name)
        if other is None or not other.is_reference:
            raise PluginError(f"{entry.provider}: {entry.table.ns_uri}: {row.opposite}: no such reference")
        feature.join(other)

    def _package(self, entry: Located) -> Package:
        table = entry.table
        own = [kind for (ns_uri, _), kind in self._types.items() if ns_uri == table.ns_uri]
        return Package(
            table.ns_uri,
            table.name,
            table.prefix,
            entry.provider,
            table.documentation,
            tuple(self._metaclasses[table.ns_uri, row.name] for row in table.classes),
            tuple(kind for kind in own if isinstance(kind, Enumeration)),
            tuple(kind for kind in own if isinstance(kind, DataType)),
            entry.ecore,
            entry.parent,
            self._packages,
            root=table.root,
        )


def _default(row: FeatureTable, kind: _Type, where: str) -> object:
    if row.is_reference or isinstance(kind, Metaclass) or row.upper > 1 or row.upper == MANY:
        return None
    if row.default is not None and (row.default or kind.name == "EString"):
        try:
            return kind.parse(row.default)
        except ValueError as fault:
            raise PluginError(f"{where}: default {fault}") from None
    if row.unsettable:
        return None
    if isinstance(kind, Enumeration):
        return kind.names[0] if kind.literals else None
    return kind.primitive_default


def _complete(metaclass: Metaclass, **fields: object) -> None:
    """Fill in what could not be known when the metaclass was made: classes refer to each other in circles."""
    for name, value in fields.items():
        object.__setattr__(metaclass, name, value)
