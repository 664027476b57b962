"""Models handed to pyecore's own API, for plug-ins that work with it, and taken back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from pyecore import ecore

from mmrs_core.errors import UnsupportedError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element, Unknown, given, held, holds, metaclass_of, path_of, root_of
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.model import Model
from mmrs_core.languages.registry import Registry

_RESERVED = frozenset((*dir(ecore.EObject), *vars(ecore.EObject())))
"""Names of features that pyecore's own attributes hide."""


def to_pyecore(model: Model, registry: Registry) -> list[Any]:
    """Return the roots of a model as pyecore ``EObject`` instances.

    What the model refers to in other files comes along, but only the model's own roots are returned.

    Args:
        model: the model; faults in it may surface as errors of pyecore.
        registry: the metamodels of its elements.

    Raises:
        UnsupportedError: for what pyecore cannot hold: elements whose metamodel is not installed, features
            that have the name of one of pyecore's own attributes, a reference that lists an element twice;
            and for elements of Ecore itself, which are pyecore's own.
    """
    outward = _Outward(registry)
    for root in model.roots:
        outward.tree(root)
    outward.connect()
    return [outward.made[id(root)] for root in model.roots]


def from_pyecore(roots: Iterable[Any], registry: Registry) -> Model:
    """Return ``EObject`` instances as a model.

    What the roots refer to outside themselves is in ``Model.linked``.

    Raises:
        UnsupportedError: if an object is of a class that the registry does not have.
    """
    inward = _Inward(registry)
    tops = list(roots)
    for top in tops:
        inward.tree(top)
    inward.connect()
    own = {id(top) for top in tops}
    others = tuple(inward.made[id(top)] for top in inward.tops if id(top) not in own)
    linked = (Model("pyecore", others),) if others else ()
    return Model("pyecore", tuple(inward.made[id(top)] for top in tops), (), linked)


class _Outward:
    def __init__(self, registry: Registry) -> None:
        self._registry = registry
        self.made: dict[int, Any] = {}
        self._references: list[tuple[Element, Feature]] = []

    def tree(self, root: Element) -> None:
        """Make the objects of a tree; references wait until all are made."""
        pending = [root]
        while pending:
            element = pending.pop()
            self.made[id(element)] = self._object(element)
            metaclass = metaclass_of(element)
            for feature in metaclass.features:
                if feature.is_reference and not feature.is_container and holds(element, feature):
                    self._references.append((element, feature))
                    if feature.containment:
                        pending.extend(
                            value for value in held(element, feature) if isinstance(value, Element)
                        )

    def _object(self, element: Element) -> Any:
        if isinstance(element, Unknown):
            raise UnsupportedError(f"{element._mmrs_type}: an element whose metamodel is not installed")
        metaclass = metaclass_of(element)
        if metaclass.ns_uri == ECORE and not metaclass.is_entry:
            raise UnsupportedError(f"{metaclass.name}: an element of Ecore itself", [path_of(element)])
        for feature in metaclass.features:
            if feature.name in _RESERVED:
                message = f"{metaclass.name}.{feature.name}: pyecore has another attribute of this name"
                raise UnsupportedError(message, [path_of(element)])
        made = metaclass.eclass()
        for feature in metaclass.features:
            if not feature.is_reference and given(element, feature):
                self._values(made, feature, held(element, feature))
        return made

    def _values(self, made: Any, feature: Feature, values: Iterable[object]) -> None:
        converted = [_outward_value(made, feature, value) for value in values]
        if feature.many:
            made.eGet(feature.name).extend(converted)
            self._same(made, feature, converted)
        else:
            made.eSet(feature.name, converted[0] if converted else None)

    def connect(self) -> None:
        """Set all references, and bring lists into the model's order where opposites filled them first."""
        index = 0
        while index < len(self._references):  # it grows where a reference leads into another tree
            element, feature = self._references[index]
            index += 1
            targets = [self._target(value) for value in held(element, feature) if isinstance(value, Element)]
            if feature.many:
                self._extend(self.made[id(element)].eGet(feature.name), targets)
            elif self.made[id(element)].eGet(feature.name) is not targets[0]:
                self.made[id(element)].eSet(feature.name, targets[0])
        for element, feature in self._references:
            if feature.many:
                made = self.made[id(element)]
                targets = [
                    self._target(value) for value in held(element, feature) if isinstance(value, Element)
                ]
                self._same(made, feature, targets)

    def _extend(self, collection: Any, targets: list[Any]) -> None:
        present = {id(value) for value in collection}
        for target in targets:
            if id(target) not in present or not isinstance(collection, ecore.EOrderedSet):
                collection.append(target)

    def _target(self, value: Element) -> Any:
        if id(value) not in self.made:
            self.tree(root_of(value))
        return self.made[id(value)]

    def _same(self, made: Any, feature: Feature, wanted: list[Any]) -> None:
        collection = made.eGet(feature.name)
        if len(collection) != len(wanted):
            message = f"{feature.owner.name}.{feature.name}: pyecore does not hold the same value twice"
            raise UnsupportedError(message)
        if (
            any(one is not other for one, other in zip(collection, wanted, strict=True))
            and feature.is_reference
        ):
            _reorder(collection, wanted)


def _reorder(collection: Any, wanted: list[Any]) -> None:
    """Bring an ordered set into order; its own operations would take values out of their containers."""
    if isinstance(collection, ecore.EOrderedSet):
        collection.items[:] = wanted
        collection.map.clear()
        collection.map.update({value: index for index, value in enumerate(wanted)})
    else:
        list.__setitem__(collection, slice(None), wanted)


class _Inward:
    def __init__(self, registry: Registry) -> None:
        self._registry = registry
        self.made: dict[int, Element] = {}
        self.tops: list[Any] = []
        self._references: list[tuple[Any, Feature]] = []

    def tree(self, top: Any) -> None:
        """Make the elements of a tree; references wait until all are made."""
        self.tops.append(top)
        pending = [top]
        while pending:
            source = pending.pop()
            metaclass = self._metaclass(source.eClass)
            element = self.made[id(source)] = self._element(source, metaclass)
            for feature in metaclass.features:
                if feature.is_reference and not feature.is_container:
                    self._references.append((source, feature))
                    if feature.containment:
                        pending.extend(_held_by(source, feature))
                elif not feature.is_reference:
                    self._value(element, source, feature)

    def _metaclass(self, eclass: Any) -> Metaclass:
        package = eclass.ePackage
        try:
            return self._registry.metaclass(package.nsURI if package else "", eclass.name)
        except ValueError as fault:
            raise UnsupportedError(f"{eclass.name}: {fault}") from None

    def _element(self, source: Any, metaclass: Metaclass) -> Element:
        if metaclass.implementation is None:
            raise UnsupportedError(f"{metaclass.name}: abstract, but {source!r} is an instance of it")
        return metaclass.implementation.__new__(metaclass.implementation)

    def _value(self, element: Element, source: Any, feature: Feature) -> None:
        value = source.eGet(feature.name)
        if feature.many:
            if value:
                setattr(element, feature.attribute, [_inward_value(feature, each) for each in value])
            return
        is_set = source.eIsSet(source.eClass.findEStructuralFeature(feature.name))
        if is_set and not (value is None and feature.default is None):
            setattr(element, feature.attribute, None if value is None else _inward_value(feature, value))

    def connect(self) -> None:
        """Set all references; what lies outside the trees made so far is made as well."""
        later = []
        for source, feature in self._all():
            if feature.containment:
                self._set(source, feature)
            else:
                later.append((source, feature))
        for source, feature in later:
            self._set(source, feature)

    def _all(self) -> Iterator[tuple[Any, Feature]]:
        index = 0
        while index < len(self._references):
            source, feature = self._references[index]
            index += 1
            for target in _held_by(source, feature):
                if id(target) not in self.made:
                    self.tree(_top(target))
            yield source, feature

    def _set(self, source: Any, feature: Feature) -> None:
        element = self.made[id(source)]
        targets = [self.made[id(target)] for target in _held_by(source, feature)]
        if feature.many and targets:
            setattr(element, feature.attribute, targets)
            _in_order(getattr(element, feature.attribute), targets)
        elif targets:
            setattr(element, feature.attribute, targets[0])


def _in_order(values: list[Element], wanted: list[Element]) -> None:
    if any(one is not other for one, other in zip(values, wanted, strict=False)):
        list.__setitem__(values, slice(None), wanted)


def _held_by(source: Any, feature: Feature) -> list[Any]:
    value = source.eGet(feature.name)
    if feature.many:
        return list(value)
    return [] if value is None else [value]


def _top(target: Any) -> Any:
    while target.eContainer() is not None:
        target = target.eContainer()
    return target


def _outward_value(made: Any, feature: Feature, value: object) -> object:
    """Return a value in the class that pyecore insists on."""
    kind = feature.type
    if isinstance(kind, Enumeration):
        eenum = made.eClass.findEStructuralFeature(feature.name).eType
        return eenum.getEEnumLiteral(name=value)
    return _CONVERTERS.get(kind.name, (_same_value, _same_value))[0](value)


def _inward_value(feature: Feature, value: Any) -> object:
    if isinstance(feature.type, Enumeration):
        return value if isinstance(value, str) else value.name
    return _CONVERTERS.get(feature.type.name, (_same_value, _same_value))[1](value)


def _same_value(value: Any) -> object:
    kept: object = value
    return kept


def _real(value: Any) -> float:
    return float(value)


def _byte_outward(value: Any) -> bytes:
    return int(value).to_bytes(1, "big", signed=True)


def _byte_inward(value: Any) -> int:
    return int.from_bytes(value, "big", signed=True)


_CONVERTERS: dict[str, tuple[Callable[[Any], object], Callable[[Any], object]]] = {
    **dict.fromkeys(("EDouble", "EDoubleObject", "EFloat", "EFloatObject"), (_real, _real)),
    **dict.fromkeys(("EByte", "EByteObject"), (_byte_outward, _byte_inward)),
    "EByteArray": (bytearray, bytes),
}
