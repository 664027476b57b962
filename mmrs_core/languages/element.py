"""Elements of models, and the questions that can be asked about any of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, SupportsIndex

from mmrs_core.diagnostics import Place
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.sources import Source

_HIDDEN_STEP = re.compile(r"/@([^./\[]+)(?:\.([0-9]+))?")


chosen: ContextVar[Callable[[Metaclass], type[Element] | None] | None] = ContextVar("chosen", default=None)
"""What gives the class to be made where a metaclass's own is called: that of the registry in use."""


class ElementType(type):
    """The type of interface and implementation classes, and of subclasses: calling any makes an element."""

    _mmrs_metaclass: Metaclass | None = None

    def __call__(cls, /, **features: object) -> Any:  # the element's class is what the stubs declare
        """Make an element whose features have the given values; None stands for "not given".

        Raises:
            ValueError: if the class is abstract, a name is not a feature of it, or it is an unfit subclass.
        """
        metaclass = cls._mmrs_metaclass
        made = metaclass.implementation if metaclass else None
        if metaclass is None or made is None:
            raise ValueError(f"{cls.__name__}: abstract, no element can be made of it")
        if cls is metaclass.interface:
            choose = chosen.get()
            made = made if choose is None else choose(metaclass) or made
        elif cls is not made:
            assert metaclass.python is not None  # it has made the class above
            made = metaclass.python.class_of(cls)  # type: ignore[arg-type]  # interfaces are below Element
        element: Element = made.__new__(made)
        for attribute, value in features.items():
            if attribute not in made._mmrs_missing:
                hint = nearest(attribute, made._mmrs_missing)
                raise ValueError(f"{attribute}: no feature of {cls.__name__}{hint and '; ' + hint}")
            if value is not None:
                setattr(element, attribute, value)
        return element

    def mro(cls) -> list[type]:
        """Return Python's order, or depth first where that order does not exist.

        Ecore lets supertypes stand in any order; Python's linearisation does not.
        """
        try:
            return super().mro()
        except TypeError:
            inherited = [ancestor for base in cls.__bases__ for ancestor in base.__mro__]
            # the last occurrence, so that no class comes before its own subclass
            return [cls, *reversed(dict.fromkeys(reversed(inherited)))]


class _EClass:
    """What ``eClass`` is of elements and their classes."""

    def __get__(self, element: Element | None, kind: type[Element]) -> Any:  # pyecore has no types
        try:
            return metaclass_of(kind).eclass
        except ValueError as unknown:
            raise AttributeError(str(unknown)) from None


class Element(metaclass=ElementType):
    """An element of a model. Its attributes are the features of its metaclass.

    It answers pyecore's reflective methods as well; a feature that has the name of one of them goes first.
    """

    __slots__ = ("_mmrs_container", "_mmrs_feature", "_mmrs_line", "_mmrs_source")

    if TYPE_CHECKING:
        _mmrs_container: Element | None
        _mmrs_feature: Feature | None
        _mmrs_line: int
        _mmrs_source: Source | None

    _mmrs_slots: ClassVar[Mapping[str, Any]] = {}
    """The bare slot of each feature, by attribute: no copy of lists, no change at the other end.

    An empty slot means that the feature was never set, and so does None unless the feature is nullable.
    """
    _mmrs_inside: ClassVar[tuple[Callable[[Element], object], ...]] = ()
    """What reads the bare slot of each feature that contains elements."""
    _mmrs_missing: ClassVar[Mapping[str, Callable[[Element], object]]] = {}
    """What each feature holds while its slot is empty, by attribute."""

    if not TYPE_CHECKING:  # the stubs declare the features; anything else is a mistake to be found

        def __getattr__(self, name: str) -> object:
            try:
                return type(self)._mmrs_missing[name](self)
            except KeyError:
                pass
            if name.startswith("_mmrs_"):
                return 0 if name == "_mmrs_line" else None
            for kind in type(self).__mro__:
                if name in vars(kind):  # a property of a subclass raised AttributeError: say which
                    return vars(kind)[name].__get__(self, type(self))
            hint = nearest(name, type(self)._mmrs_missing)
            raise AttributeError(
                f"{name}: no feature of {type(self).__name__}{hint and '; ' + hint}", name=name, obj=self
            )

    eClass = _EClass()
    """The metaclass as pyecore knows it, an ``EClass``: the one in `Registry.epackage`."""

    def eGet(self, feature: Any) -> Any:
        """Return the value of a feature, given by its name or as pyecore's object of it.

        Raises:
            AttributeError: if there is no such feature; TypeError where it is neither name nor object;
                ValueError where the metamodel is not installed.
        """
        return getattr(self, metaclass_of(self).meant(feature).attribute)

    def eSet(self, feature: Any, value: object) -> None:
        """Set a feature as the attribute does, or to literals of a pyecore ``EEnum``; errors as in `eGet`."""
        meant = metaclass_of(self).meant(feature)
        if isinstance(meant.type, Enumeration):
            value = meant.type.named(value)
        setattr(self, meant.attribute, value)

    def eIsSet(self, feature: Any) -> bool:
        """Return whether a feature has a value, even its default (EMF's is `is_set`); errors as in `eGet`."""
        return given(self, metaclass_of(self).meant(feature))

    def eUnset(self, feature: Any) -> None:
        """Take the value of a feature away, so that it holds its default; errors as in `eGet`."""
        with suppress(AttributeError):  # it was empty already
            delattr(self, metaclass_of(self).meant(feature).attribute)

    def eContainer(self) -> Element | None:
        """Return the element that contains it, or None."""
        return self._mmrs_container

    def eContainmentFeature(self) -> Any:
        """Return the ``EReference`` of its container that holds it, or None."""
        feature = self._mmrs_feature
        return None if feature is None else feature.owner.eclass.findEStructuralFeature(feature.name)

    @property
    def eContents(self) -> list[Element]:
        """The elements directly inside it, in the order of features and lists."""
        return list(contents(self))

    def eAllContents(self) -> Iterator[Element]:
        """Yield all elements inside it in document order, outer ones before inner ones."""
        return descendants(self)

    @property
    def eResource(self) -> Source | None:
        """The file that it stands in; None for elements that stand in none."""
        root = root_of(self)
        source = root._mmrs_source
        return source if source is not None and source.path is not None and root in source.roots else None

    def eURIFragment(self) -> str:
        """Return the path that leads to it within its file, such as ``//@tasks.2/@shell.0``."""
        if isinstance(self, Hidden):
            rest = self._mmrs_rest
            return f"{Element.eURIFragment(self._mmrs_outer)}{rest}" if rest.startswith("/") else rest
        root, steps = _steps_to(self)
        way = (f"/@{name}.{index}" if index else f"/@{name}" for name, index in steps)
        source = root._mmrs_source
        return f"{(source and source.number(root)) or '/'}{''.join(way)}"

    def eRoot(self) -> Element:
        """Return the outermost container; the element itself if it has none."""
        return root_of(self)

    def __reduce_ex__(self, protocol: SupportsIndex) -> NoReturn:
        """Refuse to be copied or pickled: a copy would drag its container and all it refers to along."""
        raise TypeError(f"{type(self).__name__}: an element is not copied; write its model and read it again")

    def __repr__(self) -> str:
        """Return the class, its name or id if it has one, and its place."""
        label = label_of(self)
        kind = type(self).__qualname__.rpartition(".")[2]
        return f"<{kind}{label and ' ' + repr(label)} at {place_of(self)}>"


class Unknown(Element):
    """An element whose metamodel is not installed; its XML is kept as it was.

    Attributes:
        _mmrs_xml: its text, from the opening bracket to the closing one.
        _mmrs_scope: the prefixes that were in scope there.
        _mmrs_type: what it claims to be, as ``nsURI#Name``.
        _mmrs_links: the paths that stand in its text, with the elements of its file that they lead to; None
            for none.
    """

    __slots__ = ("_mmrs_links", "_mmrs_scope", "_mmrs_type", "_mmrs_xml")

    if TYPE_CHECKING:
        _mmrs_links: tuple[tuple[str, Element], ...] | None
        _mmrs_scope: Mapping[str, str]
        _mmrs_type: str
        _mmrs_xml: str


class Hidden(Unknown):
    """The target of a reference inside an element whose metamodel is not installed; its content is unknown.

    It is in no feature of any element, and says nothing but how files refer to it.

    Attributes:
        _mmrs_outer: the element it stands in.
        _mmrs_rest: the path to it from there, such as ``/@point``; or its identifier, good from anywhere.
    """

    __slots__ = ("_mmrs_outer", "_mmrs_rest")

    if TYPE_CHECKING:
        _mmrs_outer: Unknown
        _mmrs_rest: str


def metaclass_of(element: Element | type[Element]) -> Metaclass:
    """Return the metaclass of an element, or of an interface or implementation class.

    Raises:
        ValueError: if its metamodel is not installed.
    """
    kind = element if isinstance(element, type) else type(element)
    if kind._mmrs_metaclass is None:
        raise ValueError(f"{kind.__name__}: an element whose metamodel is not installed")
    return kind._mmrs_metaclass


def is_kind(element: Element, ns_uri: str, name: str) -> bool:
    """Return whether the element is of that metaclass or one of its subtypes."""
    metaclass = type(element)._mmrs_metaclass
    return metaclass is not None and metaclass.is_kind(ns_uri, name)


def container_of(element: Element) -> Element | None:
    """Return the element that contains it, or None for a root."""
    return element._mmrs_container


def containing_feature(element: Element) -> Feature | None:
    """Return the feature of its container that holds it, or None for a root."""
    return element._mmrs_feature


def root_of(element: Element) -> Element:
    """Return the outermost container; the element itself if it has none."""
    if isinstance(element, Hidden):
        element = element._mmrs_outer
    while (container := element._mmrs_container) is not None:
        element = container
    return element


def held(element: Element, feature: Feature) -> tuple[object, ...]:
    """Return the values that a feature holds now: all of a list, one, or none; defaults do not count."""
    try:
        value = type(element)._mmrs_slots[feature.attribute].__get__(element)
    except AttributeError:
        return ()
    if value is None:
        return ()
    return tuple(value) if feature.many else (value,)


def contents(element: Element) -> Iterator[Element]:
    """Yield the elements directly inside it, in the order of features and lists."""
    for read in type(element)._mmrs_inside:
        try:
            value = read(element)
        except AttributeError:
            continue
        if isinstance(value, list):
            yield from [each for each in value if isinstance(each, Element)]
        elif isinstance(value, Element):
            yield value


def descendants(element: Element) -> Iterator[Element]:
    """Yield all elements inside it, outer ones before inner ones, in document order."""
    pending = list(contents(element))[::-1]
    while pending:
        current = pending.pop()
        yield current
        if type(current)._mmrs_inside:
            pending.extend(list(contents(current))[::-1])


def get(element: Element, name: str) -> object:
    """Return the value of the feature of that name in the metamodel: the default where it is not set.

    Raises:
        ValueError: if it has no such feature.
    """
    value: object = getattr(element, metaclass_of(element).feature(name).attribute)
    return value


def is_set(element: Element, name: str) -> bool:
    """Return whether the feature of that name holds something that a file would have to say.

    As in EMF: any value counts for an unsettable feature, else only one that is not the default.

    Raises:
        ValueError: if it has no such feature.
    """
    return holds(element, metaclass_of(element).feature(name))


def holds(element: Element, feature: Feature) -> bool:
    """Return the same as `is_set`, for a feature at hand."""
    try:
        value = type(element)._mmrs_slots[feature.attribute].__get__(element)
    except AttributeError:
        return False
    if value is None:
        return feature.nullable
    if feature.many:
        return len(value) > 0
    return feature.unsettable or not feature.is_default(value)


def given(element: Element, feature: Feature) -> bool:
    """Return whether a feature was given a value, even its default, or a list holds any."""
    return holds(element, feature) or bool(held(element, feature))


def place_of(element: Element) -> Place:
    """Return the file and line it was read from, and its path within its model."""
    source = element._mmrs_source
    return Place(source.file if source else "", element._mmrs_line, path_of(element))


def path_of(element: Element) -> str:
    """Return the features and positions that lead to it from its root, such as ``/tasks[2]/shell[0]``.

    Where its file has several roots, their number comes first: ``/1/shell[0]``.
    """
    if isinstance(element, Hidden):
        rest = _HIDDEN_STEP.sub(_as_step, element._mmrs_rest)
        return f"{path_of(element._mmrs_outer).rstrip('/')}{rest if rest.startswith('/') else f'#{rest}'}"
    root, steps = _steps_to(element)
    way = (f"/{name}[{index}]" if index else f"/{name}" for name, index in steps)
    source = root._mmrs_source
    return f"{source.number(root) if source else ''}{''.join(way)}" or "/"


def _steps_to(element: Element) -> tuple[Element, list[tuple[str, str]]]:
    """Return its root, and from there each feature with the position in it, if it is a list."""
    steps: list[tuple[str, str]] = []
    while (container := element._mmrs_container) is not None:
        feature = element._mmrs_feature
        assert feature is not None  # set together with the container
        steps.append((feature.name, _index(container, feature, element)))
        element = container
    return element, steps[::-1]


def _as_step(step: re.Match[str]) -> str:
    return f"/{step[1]}" if step[2] is None else f"/{step[1]}[{step[2]}]"


def _index(container: Element, feature: Feature, element: Element) -> str:
    if not feature.many:
        return ""
    values = type(container)._mmrs_slots[feature.attribute].__get__(container)
    try:
        return str(values.position(element))
    except ValueError:  # it is not in there yet
        return "?"


def label_of(element: Element) -> str:
    """Return the element's ``name`` or ``id``, whichever it has first, or an empty text."""
    for attribute in ("name", "id"):
        if attribute in type(element)._mmrs_missing:
            value = getattr(element, attribute)
            if isinstance(value, str) and value:
                return value
    return ""
