"""The two Python classes of a metaclass: an interface to ask ``isinstance`` with, and an implementation."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from mmrs_core.languages.element import Element, ElementType
from mmrs_core.languages.links import LinkedList, link, raw, unlink
from mmrs_core.languages.metaclass import Feature, Metaclass


def interface_class(metaclass: Metaclass, bases: tuple[type[Element], ...]) -> type[Element]:
    """Return a class with no slots of its own, below the interfaces of the supertypes."""
    namespace = {
        "__slots__": (),
        "__doc__": metaclass.documentation or None,
        "__module__": __name__,
        "__qualname__": metaclass.name,
        "_mmrs_metaclass": metaclass,
    }
    return _element_class(metaclass.name, bases or (Element,), namespace)


def implementation_class(metaclass: Metaclass, interface: type[Element]) -> type[Element]:
    """Return the class of the metaclass's elements, with a slot for each of its features."""
    attributes = tuple(feature.attribute for feature in metaclass.features)
    namespace = {
        "__slots__": attributes,
        "__doc__": interface.__doc__,
        "__module__": __name__,
        "__qualname__": metaclass.name,
    }
    made = _element_class(metaclass.name, (interface,), namespace)
    slots = {attribute: made.__dict__[attribute] for attribute in attributes}
    for feature in metaclass.features:
        if feature.many or feature.linked or not _nullable(feature):
            setattr(made, feature.attribute, _property(feature, slots[feature.attribute]))
    made._mmrs_slots = slots
    made._mmrs_missing = {feature.attribute: _missing(feature) for feature in metaclass.features}
    return made


def _element_class(name: str, bases: tuple[type[Element], ...], namespace: dict[str, Any]) -> type[Element]:
    made = ElementType(name, bases, namespace)
    assert issubclass(made, Element)  # its bases are
    return made


def _nullable(feature: Feature) -> bool:
    """Whether None is a value that a file can state, rather than the absence of one."""
    return getattr(feature.type, "name", "") == "EString" or feature.default is None


def _missing(feature: Feature) -> Callable[[Element], object]:
    if not feature.many:
        default = feature.default
        return lambda element: default
    if feature.linked:
        return _keep(feature, lambda element: LinkedList(element, feature))
    return _keep(feature, lambda element: [])


def _keep(feature: Feature, make: Callable[[Element], list[Any]]) -> Callable[[Element], object]:
    def missing(element: Element) -> object:
        values = make(element)
        type(element)._mmrs_slots[feature.attribute].__set__(element, values)
        return values

    return missing


def _property(feature: Feature, slot: Any) -> property:  # CPython does not name the type of slots
    """Return a property that reads its slot at C speed and keeps promises when written."""
    if feature.many and feature.linked:
        write = _replace_linked(feature)
    elif feature.many:
        write = _replace_plain(feature, slot)
    elif feature.linked:
        write = _set_linked(feature, slot)
    else:
        write = _set_primitive(feature, slot)
    return property(slot.__get__, write, lambda element: write(element, None), feature.documentation)


def _replace_linked(feature: Feature) -> Callable[[Element, Any], None]:
    def write(element: Element, values: Iterable[Element] | None) -> None:
        getattr(element, feature.attribute).replace(values or ())

    return write


def _replace_plain(feature: Feature, slot: Any) -> Callable[[Element, Any], None]:
    def write(element: Element, values: Iterable[object] | None) -> None:
        if isinstance(values, str):
            raise ValueError(f"{feature.name}: takes a list, not the text {values!r}")
        slot.__set__(element, list(values or ()))

    return write


def _set_linked(feature: Feature, slot: Any) -> Callable[[Element, Any], None]:
    def write(element: Element, value: Element | None) -> None:
        before = raw(element, feature)
        if before is value:
            return
        if isinstance(before, Element):
            unlink(element, feature, before)
        if value is None:
            _empty(element, slot)
            return
        link(element, feature, value)
        slot.__set__(element, value)

    return write


def _set_primitive(feature: Feature, slot: Any) -> Callable[[Element, Any], None]:
    def write(element: Element, value: object) -> None:
        if value is None:
            _empty(element, slot)
        else:
            slot.__set__(element, value)

    return write


def _empty(element: Element, slot: Any) -> None:
    try:
        slot.__delete__(element)
    except AttributeError:  # it was empty already
        return
