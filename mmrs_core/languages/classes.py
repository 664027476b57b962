"""The Python classes of a metaclass: interface, implementation, and subclasses that plug-ins register."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from threading import RLock
from typing import Any

from mmrs_core.languages.element import Element, ElementType, metaclass_of
from mmrs_core.languages.links import LinkedList, link, raw, unlink
from mmrs_core.languages.metaclass import Feature, Metaclass

_KEPT = {"__bool__", "__delattr__", "__eq__", "__getattr__", "__getattribute__", "__hash__", "__init__"}
_KEPT |= {"__len__", "__new__", "__reduce__", "__reduce_ex__", "__setattr__"}
_KEPT |= {name for name in dir(Element) if not name.startswith("__")}
"""What readers, writers and links rely on."""


@dataclass(frozen=True, slots=True)
class ElementClass:
    """A Python class for the elements of a metaclass, and of all metaclasses below it.

    Attributes:
        python: a subclass of the metaclass's class, with properties and methods of its own.
        provider: who brings it, for messages.

    Raises:
        ValueError: if it is no such subclass, has `__slots__` or an `__init__` of its own, hides a feature
            or something else that elements have, or is a subclass of metaclasses none of which has the
            others above it.
    """

    python: type[Element]
    provider: str = ""

    def __post_init__(self) -> None:
        """Refuse what elements cannot be instances of."""
        refuse_unfit(self.python)

    @property
    def metaclass(self) -> tuple[str, str]:
        """(nsURI, name) of the metaclass."""
        return metaclass_of(self.python).key


def class_of(kind: type[Element]) -> type[Element]:
    """Return the class of the elements that calling a subclass of a concrete metaclass's class makes.

    Raises:
        ValueError: as for `ElementClass`.
    """
    metaclass = metaclass_of(kind)
    if metaclass.implementation is not None and issubclass(kind, metaclass.implementation):
        return kind
    made: type[Element] | None = vars(kind).get("_mmrs_made")
    if made is None:
        refuse_unfit(kind)
        made = joined(metaclass, (kind,))
        type.__setattr__(kind, "_mmrs_made", made)
    return made


def joined(metaclass: Metaclass, kinds: tuple[type[Element], ...]) -> type[Element]:
    """Return the class of a concrete metaclass's elements that are instances of Python subclasses as well.

    Args:
        metaclass: of the elements.
        kinds: what they are besides, most specific first; for this metaclass or for some above it.
    """
    assert metaclass.implementation is not None  # it has elements
    first = kinds[0]
    named = first.__qualname__ if metaclass_of(first).key == metaclass.key else metaclass.name
    namespace = {
        "__slots__": (),
        "__doc__": first.__doc__,
        "__module__": first.__module__,
        "__qualname__": named,  # what programmers see; the name stays the one that users know from files
        "_mmrs_metaclass": metaclass,
    }
    made = ElementType(metaclass.name, (*kinds, metaclass.implementation), namespace)
    assert issubclass(made, Element)  # its bases are
    return made


def refuse_unfit(kind: type[Element]) -> None:
    """Raise ValueError unless elements can be instances of a Python class."""
    own = tuple(_own(kind)) if isinstance(kind, ElementType) else ()
    if not own or kind._mmrs_metaclass is None:
        raise ValueError(f"{getattr(kind, '__name__', kind)}: no Python subclass of a class of a language")
    metaclass = metaclass_of(kind)
    for each in kind.__mro__:
        other = vars(each).get("_mmrs_metaclass")
        if other is not None and not metaclass.is_kind(*other.key):
            both = f"{metaclass.name} and {other.name}"
            raise ValueError(f"{kind.__name__}: subclass of both {both}; an element is of one metaclass")
    for each in own:
        if vars(each).get("__slots__"):
            raise ValueError(f"{each.__name__}.__slots__: not empty; without it, elements have a __dict__")
        for name in vars(each):
            if name in _KEPT:
                raise ValueError(f"{each.__name__}.{name}: a Python subclass cannot replace it")
    refuse_hiding(kind, metaclass)


def refuse_hiding(kind: type[Element], metaclass: Metaclass) -> None:
    """Raise ValueError if a Python class defines what is a feature of a metaclass."""
    for each in _own(kind):
        for name in vars(each):
            if name in metaclass.by_attribute:
                feature = metaclass.by_attribute[name]
                raise ValueError(f"{each.__name__}.{name}: hides the feature {metaclass.name}.{feature.name}")


def _own(kind: type) -> Iterator[type]:
    """Yield what a class and its bases are made of, beside the classes of languages."""
    for each in kind.__mro__:
        if each not in Element.__mro__ and not {"_mmrs_metaclass", "_mmrs_slots"} & vars(each).keys():
            yield each


_MAKING = RLock()


def give_classes(metaclass: Metaclass) -> None:
    """Make the Python classes of a metaclass, unless another thread did so meanwhile."""
    with _MAKING:
        try:
            object.__getattribute__(metaclass, "implementation")
        except AttributeError:
            _give_classes(metaclass)


def _give_classes(metaclass: Metaclass) -> None:
    interface = _interface_class(metaclass, tuple(dict.fromkeys(a.interface for a in metaclass.supertypes)))
    above = (base._mmrs_metaclass for base in interface.__mro__[1:] if isinstance(base, ElementType))
    object.__setattr__(metaclass, "interface", interface)
    object.__setattr__(metaclass, "ancestry", (metaclass.key, *(each.key for each in above if each)))
    made = None if metaclass.abstract else _implementation_class(metaclass, interface)
    object.__setattr__(metaclass, "implementation", made)  # the last: others see that all is done


def _interface_class(metaclass: Metaclass, bases: tuple[type[Element], ...]) -> type[Element]:
    """Return a class with no slots of its own, below the interfaces of the supertypes."""
    namespace = {
        "__slots__": (),
        "__doc__": metaclass.documentation or None,
        "__module__": __name__,
        "__qualname__": metaclass.name,
        "_mmrs_metaclass": metaclass,
    }
    return _element_class(metaclass.name, bases or (Element,), namespace)


def _implementation_class(metaclass: Metaclass, interface: type[Element]) -> type[Element]:
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
        if feature.many or feature.linked or not _assignable(feature):
            setattr(made, feature.attribute, _property(feature, slots[feature.attribute]))
    for index, slot in enumerate(slots.values()):
        setattr(made, bare_name(index), slot)
    made._mmrs_slots = slots
    made._mmrs_inside = tuple(
        slots[feature.attribute].__get__ for feature in metaclass.features if feature.containment
    )
    made._mmrs_missing = {feature.attribute: _missing(feature) for feature in metaclass.features}
    return made


def bare_name(index: int) -> str:
    """Return the attribute that is the bare slot of a metaclass's feature of that index, whatever its name.

    Compiled readers and writers use it: nothing that stands in a metamodel gets into their text.
    """
    return f"_mmrs_{index}"


def _element_class(name: str, bases: tuple[type[Element], ...], namespace: dict[str, Any]) -> type[Element]:
    made = ElementType(name, bases, namespace)
    assert issubclass(made, Element)  # its bases are
    return made


def _assignable(feature: Feature) -> bool:
    """Whether None may be put into the slot as it is, rather than empty it."""
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
    """Return a property that knows what an unfilled slot means, and keeps promises when written."""
    if feature.many and feature.linked:
        write = _replace_linked(feature)
    elif feature.many:
        write = _replace_plain(feature, slot)
    elif feature.linked:
        write = _set_linked(feature, slot)
    else:
        write = _set_primitive(feature, slot)
    read = slot.__get__ if feature.nullable or _plain(feature) else _read(slot, _missing(feature))
    return property(read, write, lambda element: write(element, None), feature.documentation)


def _plain(feature: Feature) -> bool:
    """Whether None is what a user is to see in a slot that holds None."""
    return not feature.many and feature.default is None


def _read(slot: Any, missing: Callable[[Element], object]) -> Callable[[Element], object]:
    get = slot.__get__

    def read(element: Element) -> object:
        value = get(element)
        return missing(element) if value is None else value

    return read


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
