"""Python subclasses of metaclasses: which are fit, and the classes of the elements that are of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mmrs_core.languages.element import Element, ElementType, metaclass_of
from mmrs_core.languages.metaclass import Metaclass

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
