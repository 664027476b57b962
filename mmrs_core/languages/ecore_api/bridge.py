"""Models handed to pyecore's own API, for plug-ins that work with it, and taken back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from pyecore import ecore
from pyecore.resources import URI

from mmrs_core.errors import UnsupportedError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element, Unknown, given, held, holds, metaclass_of, place_of, root_of
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.model import Model
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.sources import Source

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
    outward = Outward()
    for root in model.roots:
        outward.tree(root)
    outward.connect()
    return [outward.made[id(root)] for root in model.roots]


def from_pyecore(roots: Iterable[Any], registry: Registry) -> Model:
    """Return ``EObject`` instances as a model.

    What the roots refer to outside themselves is in ``Model.linked``. What stands in a resource of pyecore
    stands in its file, so that references to it can be written, and keeps the identifier it has there.

    Raises:
        UnsupportedError: if an object is of a class that the registry does not have.
    """
    inward = _Inward(registry)
    tops = [root.force_resolve() for root in roots]
    for top in tops:
        inward.tree(top)
    inward.connect()
    inward.number_roots()
    own = {id(top) for top in tops}
    others = tuple(inward.made[id(top)] for top in inward.tops if id(top) not in own)
    linked = (Model("pyecore", others),) if others else ()
    return Model("pyecore", tuple(inward.made[id(top)] for top in tops), (), linked)


class Outward:
    """The way of elements into pyecore.

    Attributes:
        made: the objects by the ``id`` of their elements.
    """

    def __init__(self, elsewhere: Callable[[Element], Any] = lambda element: None) -> None:
        """Take what gives the object of an element that pyecore has already, or None."""
        self._elsewhere = elsewhere
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
            raise _refusal(element, f"{element._mmrs_type}: an element whose metamodel is not installed")
        metaclass = metaclass_of(element)
        if metaclass.ns_uri == ECORE and not metaclass.is_entry:
            raise _refusal(element, f"{metaclass.name}: an element of Ecore itself")
        for feature in metaclass.features:
            if feature.name in _RESERVED:
                message = f"{metaclass.name}.{feature.name}: pyecore has another attribute of this name"
                raise _refusal(element, message)
        made = metaclass.eclass()
        for feature in metaclass.features:
            if not feature.is_reference and given(element, feature):
                self._values(element, made, feature)
        return made

    def _values(self, element: Element, made: Any, feature: Feature) -> None:
        converted = [_outward_value(made, feature, value) for value in held(element, feature)]
        if feature.many:
            made.eGet(feature.name).extend(converted)
            self._same(element, made, feature, converted)
        else:
            made.eSet(feature.name, converted[0] if converted else None)

    def connect(self) -> None:
        """Set all references, and bring lists into the model's order where opposites filled them first.

        Nothing is changed in what pyecore has already, before all that references lead to is found.
        """
        wanted: list[list[Any]] = []
        for element, feature in self._references:  # it grows where a reference leads into another tree
            values = held(element, feature)
            wanted.append([self._target(value) for value in values if isinstance(value, Element)])
        for (element, feature), targets in zip(self._references, wanted, strict=True):
            made = self.made[id(element)]
            if feature.many:
                self._extend(made.eGet(feature.name), targets)
            elif made.eGet(feature.name) is not targets[0]:
                made.eSet(feature.name, targets[0])
        for (element, feature), targets in zip(self._references, wanted, strict=True):
            if feature.many:
                self._same(element, self.made[id(element)], feature, targets)

    def _extend(self, collection: Any, targets: list[Any]) -> None:
        present = {id(value) for value in collection}
        for target in targets:
            if id(target) not in present or not isinstance(collection, ecore.EOrderedSet):
                collection.append(target)

    def _target(self, value: Element) -> Any:
        if id(value) not in self.made:
            known = self._elsewhere(value)
            if known is None:
                self.tree(root_of(value))
            else:
                self.made[id(value)] = known
        return self.made[id(value)]

    def _same(self, element: Element, made: Any, feature: Feature, wanted: list[Any]) -> None:
        collection = made.eGet(feature.name)
        if len(collection) != len(wanted):
            message = f"{feature.owner.name}.{feature.name}: pyecore does not hold the same value twice"
            raise _refusal(element, message)
        if (
            any(one is not other for one, other in zip(collection, wanted, strict=True))
            and feature.is_reference
        ):
            _reorder(collection, wanted)


def _refusal(element: Element, message: str) -> UnsupportedError:
    place = place_of(element)
    return UnsupportedError(f"{place}: {message}" if place.file else message, [place.path])


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
        self._homes: dict[int, tuple[Source, Any]] = {}
        self._references: list[tuple[Any, Feature]] = []

    def tree(self, top: Any) -> None:
        """Make the elements of a tree; references wait until all are made."""
        self.tops.append(top)
        home = self._home(top.eResource)
        pending = [top]
        while pending:
            source = pending.pop()
            metaclass = self._metaclass(source.eClass)
            element = self.made[id(source)] = self._element(source, metaclass)
            for each in source._isset:
                if each.name not in metaclass.by_name and each.name not in metaclass.by_attribute:
                    message = f"{metaclass.name}.{each.name}: added to the EClass after it was loaded"
                    raise UnsupportedError(message)
            element._mmrs_source = home
            if home is not None and source._internal_id:
                home.ids[element] = source._internal_id
            for feature in metaclass.features:
                if feature.is_reference and not feature.is_container:
                    self._references.append((source, feature))
                    if feature.containment:
                        pending.extend(_held_by(source, feature))
                elif not feature.is_reference:
                    self._value(element, source, feature)

    def _home(self, resource: Any) -> Source | None:
        """Return the file that a resource of pyecore stands for."""
        if resource is None or resource.uri is None:
            return None
        if id(resource) not in self._homes:
            self._homes[id(resource)] = Source(resource.uri.plain, file_of(resource.uri)), resource
        return self._homes[id(resource)][0]

    def number_roots(self) -> None:
        """Let files know their roots, as far as these are made."""
        for home, resource in self._homes.values():
            made = (self.made.get(id(root.force_resolve())) for root in resource.contents)
            home.roots = tuple(root for root in made if root is not None)

    def _metaclass(self, eclass: Any) -> Metaclass:
        package = eclass.ePackage
        try:
            return self._registry.metaclass(package.nsURI if package else "", eclass.name)
        except ValueError as fault:
            raise UnsupportedError(f"{eclass.name}: {fault}") from None

    def _element(self, source: Any, metaclass: Metaclass) -> Element:
        made = self._registry.implementation(metaclass)
        if made is None:
            raise UnsupportedError(f"{metaclass.name}: abstract, but {source!r} is an instance of it")
        return made.__new__(made)

    def _value(self, element: Element, source: Any, feature: Feature) -> None:
        value = _get(source, feature)
        if feature.many:
            if value:
                setattr(element, feature.attribute, [_inward_value(feature, each) for each in value])
            return
        is_set = source.eIsSet(feature.name) or source.eIsSet(feature.attribute)
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
                    self._file(_top(target))
            yield source, feature

    def _file(self, top: Any) -> None:
        """Make all trees of a file that one is needed of: their numbers lead to it."""
        others = top.eResource.contents if top.eResource is not None else ()
        for root in (top, *(each.force_resolve() for each in others)):
            if id(root) not in self.made:
                self.tree(root)

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


def _get(source: Any, feature: Feature) -> Any:
    try:
        return source.eGet(feature.name)
    except AttributeError:  # the modules that pyecoregen makes call it as Python does
        return source.eGet(feature.attribute)


def _held_by(source: Any, feature: Feature) -> list[Any]:
    value = _get(source, feature)
    values = value if feature.many else [] if value is None else [value]
    return [each.force_resolve() for each in values]


def file_of(uri: Any) -> Path | None:
    """Return the real path of the file that a ``URI`` means; None if it means anything else."""
    if type(uri) is not URI or uri.protocol not in (None, "file"):
        return None
    return real_path(Path(uri.normalize()))


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
