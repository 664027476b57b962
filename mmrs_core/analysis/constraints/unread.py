"""Values that could not be read, and whether a constraint used one: what follows from it does not count."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from inspect import getattr_static
from typing import Any, Generic, TypeVar, overload

from mmrs_core.languages.element import Element, ElementType, metaclass_of
from mmrs_core.languages.metaclass import Feature

Owner = TypeVar("Owner")
Value = TypeVar("Value")


class ReadNote:
    """Notes whether watched features are read while it is entered; an outer note knows nothing of it.

    Attributes:
        is_unfounded: whether one was whose value could not be read from its file.
    """

    __slots__ = ("_token", "is_unfounded")

    def __enter__(self) -> ReadNote:
        """Begin to note."""
        self.is_unfounded = False
        self._token = _reading.set(self)
        return self

    def __exit__(self, *_: object) -> None:
        """End."""
        _reading.reset(self._token)


_reading: ContextVar[ReadNote | None] = ContextVar("reading", default=None)


def _note() -> None:
    reading = _reading.get()
    if reading is not None:
        reading.is_unfounded = True


@contextmanager
def watching(broken: Iterable[tuple[Element, str]]) -> Iterator[None]:
    """Watch features, given by element and name; meanwhile their elements are of other classes."""
    names: dict[Element, set[str]] = {}
    for element, name in broken:
        names.setdefault(element, set()).add(name)
    plain = {element: type(element) for element in names}
    made: dict[tuple[type[Element], frozenset[str]], type[Element]] = {}
    try:
        for element, kind in plain.items():
            key = kind, frozenset(names[element])
            if key not in made:
                made[key] = _watched_class(*key)
            element.__class__ = made[key]
        yield
    finally:
        for element, kind in plain.items():
            element.__class__ = kind


def _watched_class(kind: type[Element], names: frozenset[str]) -> type[Element]:
    """Return a class whose elements note when those features are read, by their attribute or their slot."""
    features = [feature for feature in metaclass_of(kind).features if feature.name in names]
    slots = {
        **kind._mmrs_slots,
        **{each.attribute: _Watched(kind._mmrs_slots[each.attribute]) for each in features},
    }
    namespace: dict[str, Any] = {
        "__slots__": (),
        "__module__": kind.__module__,
        "__qualname__": kind.__qualname__,
    }
    namespace |= {each.attribute: _Watched(getattr_static(kind, each.attribute)) for each in features}
    namespace |= {"_mmrs_slots": slots, "_mmrs_inside": tuple(_inside(metaclass_of(kind).features, slots))}
    made = ElementType(kind.__name__, (kind,), namespace)
    assert issubclass(made, Element)  # its base is
    return made


def _inside(features: Iterable[Feature], slots: dict[str, Any]) -> Iterator[Callable[[Element], object]]:
    return (slots[each.attribute].__get__ for each in features if each.containment)


class _Watched:
    """A slot or property that notes when it is read."""

    def __init__(self, plain: Any) -> None:  # CPython does not name the type of slots
        self._plain = plain

    def __get__(self, element: Element, owner: type[Element] | None = None) -> object:
        _note()
        value: object = self._plain.__get__(element, owner)
        return value

    def __set__(self, element: Element, value: object) -> None:
        self._plain.__set__(element, value)

    def __delete__(self, element: Element) -> None:
        self._plain.__delete__(element)


class drawn_once(Generic[Owner, Value]):  # noqa: N801  # it is used as `cached_property` is
    """A property that is made once; each who asks for it has read what it was made of."""

    def __init__(self, make: Callable[[Owner], Value]) -> None:
        self._make = make
        self.__doc__ = make.__doc__

    @overload
    def __get__(self, owner: None, kind: type[Owner]) -> drawn_once[Owner, Value]: ...

    @overload
    def __get__(self, owner: Owner, kind: type[Owner]) -> Value: ...

    def __get__(self, owner: Owner | None, kind: type[Owner]) -> Value | drawn_once[Owner, Value]:
        """Return the value, made at the first time."""
        if owner is None:
            return self
        name = f"{self._make.__name__} as drawn"
        if name not in owner.__dict__:
            with ReadNote() as reading:
                owner.__dict__[name] = self._make(owner), reading
        found: tuple[Value, ReadNote] = owner.__dict__[name]
        if found[1].is_unfounded:
            _note()
        return found[0]
