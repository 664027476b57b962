"""What a metamodel says about its classes: packages, metaclasses, features, enumerations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from mmrs_core.languages.datatypes import DataType, shown
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.values.dates import WrittenDate

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element

MANY = -1
MAP_ENTRY = "java.util.Map$Entry"
"""The Java class of an entry of a map."""


@dataclass(frozen=True, slots=True)
class Literal:
    """One value of an enumeration: ``name`` in memory, ``literal`` in files, ``value`` in Java."""

    name: str
    literal: str
    value: int
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class Enumeration:
    """A closed set of values, which in memory are the names of its literals."""

    ns_uri: str
    name: str
    literals: tuple[Literal, ...]
    documentation: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """Its values in memory, in the order of the metamodel."""
        return tuple(literal.name for literal in self.literals)

    def parse(self, text: str) -> str:
        """Return the name whose literal the text is.

        Raises:
            ValueError: if it is not a literal; the message begins with the text.
        """
        for literal in self.literals:
            if literal.literal == text:
                return literal.name
        known = ", ".join(literal.literal for literal in self.literals)
        raise ValueError(f"{shown(text)}: not a literal of {self.name} ({known})")

    def meant(self, text: str) -> str:
        """Return a hint that names the literal most like a text that is none, or an empty text."""
        return nearest(text, (literal.literal for literal in self.literals))

    def named(self, value: object) -> object:
        """Return the name of a pyecore ``EEnumLiteral``, also of each in a list; any other value as it is."""
        if isinstance(value, Iterable) and not isinstance(value, str):
            return [self.named(each) for each in value]
        return getattr(value, "name", value)

    def render(self, value: object) -> str:
        """Return the literal of a name, which must be one."""
        return next(literal.literal for literal in self.literals if literal.name == value)

    def accepts(self, value: object) -> bool:
        """Return whether a value in memory is the name of a literal."""
        return isinstance(value, str) and any(literal.name == value for literal in self.literals)


@dataclass(frozen=True, slots=True, eq=False)
class Feature:
    """One attribute or reference that a metaclass declares; shared by all classes that inherit it.

    Attributes:
        name: as in the metamodel and in files.
        attribute: the name under which Python reaches it; differs for keywords, as in ``from_``.
        lower: fewest values.
        upper: the upper bound as it stands in the metamodel; 1 where that is unspecified (-2), as in EMF.
        type: a metaclass for a reference, else a data type or an enumeration.
        default: what it holds when it was never set; None where an unset number is not a number.
        unsettable: whether "never set" differs from "set to the default".
        unique: whether a value may occur only once among many.
        opposite: the reference that the other end keeps, or None.
        many: whether it holds a list.
        most: most values, ``MANY`` (-1) for any number.
        required: whether it needs at least one value.
        nullable: whether None is a value that a file can state, other than the default.
        is_container: whether it names the element that contains its owner.
        linked: whether setting it changes the other end as well.
        keys: the names of the features by which its elements differ, no two of them having the same values.
        stored: whether files hold it.
        owner: the metaclass that declares it.
    """

    name: str
    attribute: str
    documentation: str
    lower: int
    upper: int
    is_reference: bool
    containment: bool
    unsettable: bool
    unique: bool
    is_id: bool
    stored: bool
    owner: Metaclass
    type: Metaclass | DataType | Enumeration
    default: object
    opposite: Feature | None = None
    keys: tuple[str, ...] = ()
    many: bool = field(init=False)
    most: int = field(init=False)
    required: bool = field(init=False)
    nullable: bool = field(init=False)
    is_container: bool = field(init=False)
    linked: bool = field(init=False)

    def __post_init__(self) -> None:
        """Work out what the reader and the writer ask of every value."""
        object.__setattr__(self, "many", self.upper > 1 or self.upper == MANY)
        object.__setattr__(self, "most", self.upper if self.many else 1)
        object.__setattr__(self, "required", self.lower > 0)
        absent = self.is_reference or self.many or self.default is None
        object.__setattr__(self, "nullable", not (absent or getattr(self.type, "primitive", True)))
        self.join(self.opposite)

    def is_default(self, value: object) -> bool:
        """Return whether a value is the default to Java's equals: 0.0 is not -0.0, and true is not 1."""
        default = self.default
        if isinstance(value, float) and isinstance(default, float):
            return repr(value) == repr(default)
        if isinstance(value, bytes):  # arrays of Java equal none but themselves
            return False
        if isinstance(value, WrittenDate) or isinstance(default, WrittenDate):
            return value == default and getattr(value, "text", "") == getattr(default, "text", "")
        return value == default and isinstance(value, bool) == isinstance(default, bool)

    def join(self, opposite: Feature | None) -> None:
        """Make another reference its opposite; a metamodel knows them only when all its classes stand."""
        object.__setattr__(self, "opposite", opposite)
        object.__setattr__(self, "is_container", opposite is not None and opposite.containment)
        object.__setattr__(self, "linked", self.containment or opposite is not None)

    def __repr__(self) -> str:
        """Return the owner's name and its own."""
        return f"<feature {self.owner.name}.{self.name}>"


def is_null(feature: Feature, value: object) -> bool:
    """Return whether a value among many is nothing, where Java's type of it can be null: files say nil."""
    return (
        value is None and feature.many and isinstance(feature.type, DataType) and not feature.type.primitive
    )


class PythonClasses(Protocol):
    """What makes Python classes of metaclasses: the module `classes`."""

    def give_classes(self, metaclass: Metaclass, /) -> None:
        """Set ancestry, interface and implementation of a metaclass, unless another thread has."""

    def class_of(self, kind: type[Element], /) -> type[Element]:
        """Return the class of the elements that calling a subclass of an interface makes."""


@dataclass(frozen=True, slots=True, eq=False)
class Metaclass:
    """A class of a metamodel, with the Python classes made of it.

    Those classes are made when they are first asked for: of a large metamodel most never are.

    Attributes:
        features: all of them, inherited ones included, in EMF's order.
        ancestry: (nsURI, name) of itself and all supertypes, most specific first.
        interface: what ``isinstance`` is asked with, and what is called to make an element.
        implementation: the class of its elements; None when it is abstract.
        by_name: the features by their name in the metamodel.
        by_attribute: the features by their name in Python.
        is_entry: whether its elements are the entries of maps, of which each key has one.
        eclass: the class as pyecore has it, an ``EClass``, from which all this was derived.
        package: the package that declares it.
        python: what makes its Python classes.
        compiled: the functions that were compiled for its elements, by what they do; they live as long as it.
    """

    ns_uri: str
    name: str
    abstract: bool
    documentation: str
    supertypes: tuple[Metaclass, ...] = ()
    features: tuple[Feature, ...] = ()
    ancestry: tuple[tuple[str, str], ...] = field(init=False)
    interface: type[Element] = field(init=False)
    implementation: type[Element] | None = field(init=False)
    by_name: Mapping[str, Feature] = field(repr=False, default_factory=dict)
    by_attribute: Mapping[str, Feature] = field(repr=False, default_factory=dict)
    package: Package | None = field(repr=False, default=None)
    python: PythonClasses | None = field(repr=False, default=None)
    is_entry: bool = False
    eclass: Any = field(repr=False, default=None)  # pyecore has no types
    compiled: dict[str, object] = field(init=False, repr=False, default_factory=dict)

    if not TYPE_CHECKING:  # the fields are declared above

        def __getattr__(self, name: str) -> object:
            if name not in ("ancestry", "interface", "implementation"):
                raise AttributeError(f"{name}: no attribute of a metaclass", name=name, obj=self)
            assert self.python is not None  # only Ecore's EObject is made without, and has them already
            self.python.give_classes(self)
            return object.__getattribute__(self, name)

    @property
    def key(self) -> tuple[str, str]:
        """Its nsURI and name, which together identify it."""
        return self.ns_uri, self.name

    def feature(self, name: str) -> Feature:
        """Return the feature of that name in the metamodel.

        Raises:
            ValueError: if it has none, with the nearest name.
        """
        try:
            return self.by_name[name]
        except KeyError:
            hint = nearest(name, self.by_name)
            raise ValueError(f"{name}: no feature of {self.name}{hint and '; ' + hint}") from None

    def meant(self, feature: object) -> Feature:
        """Return the feature of that name, or of the name that a feature of pyecore has.

        Raises:
            AttributeError: if it has none, with the nearest name; these are the errors that pyecore raises.
            TypeError: if it is neither a name nor has one.
        """
        name = getattr(feature, "name", feature)
        if not isinstance(name, str):
            raise TypeError(f"{feature!r}: neither the name of a feature nor a feature")
        try:
            return self.feature(name)
        except ValueError as unknown:
            raise AttributeError(str(unknown)) from None

    def is_kind(self, ns_uri: str, name: str) -> bool:
        """Return whether it is that metaclass or one of its subtypes."""
        return (ns_uri, name) in self.ancestry

    def accepts(self, value: object) -> bool:
        """Return whether a value in memory is an element of this metaclass or a subtype."""
        return isinstance(value, self.interface)

    def __repr__(self) -> str:
        """Return nsURI and name."""
        return f"<metaclass {self.ns_uri}#{self.name}>"


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Package:
    """A metamodel.

    Attributes:
        prefix: which files use for it unless another package took it.
        provider: the distribution that brought it.
        ecore: the file it came from, or the pyecore EPackage.
        parent: nsURI of the package it stands in; empty at the top.
        root: which of the elements at the top of its file it is, or stands in, counted from 0.
        known: the packages that its types may come from, by nsURI.
        epackage: as pyecore has it, an ``EPackage``, from which all this was derived.
    """

    ns_uri: str
    name: str
    prefix: str
    provider: str
    documentation: str
    metaclasses: tuple[Metaclass, ...]
    enumerations: tuple[Enumeration, ...]
    datatypes: tuple[DataType, ...]
    ecore: Path | object = field(repr=False, default=None)
    parent: str = ""
    known: Mapping[str, Package] = field(repr=False, default_factory=dict)
    epackage: Any = field(repr=False, default=None)
    root: int = 0

    @property
    def members(self) -> Mapping[str, type[Element] | Enumeration]:
        """What a Python module of the language offers, by name: interface classes and enumerations."""
        enumerations = {enumeration.name: enumeration for enumeration in self.enumerations}
        return {metaclass.name: metaclass.interface for metaclass in self.metaclasses} | enumerations

    def member(self, name: str) -> type[Element] | Enumeration:
        """Return one of the members.

        Raises:
            AttributeError: if there is none of that name, as modules do, with the nearest name.
        """
        members = self.members
        if name not in members:
            hint = nearest(name, members)
            raise AttributeError(f"{name}: no class of {self.ns_uri}{hint and '; ' + hint}")
        return members[name]
