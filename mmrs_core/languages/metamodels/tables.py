"""What an .ecore file says, as plain tables; references to types are still texts."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.languages.metaclass import Literal

MAP_ENTRY = "java.util.Map$Entry"
"""The Java class of an entry of a map."""


@dataclass(frozen=True, slots=True)
class FeatureTable:
    """A structural feature as it stands in its file; ``type``, ``opposite`` and ``keys`` are URIs.

    A URI is ``document#//Class``, or with the feature behind it; the document of one that leads to the same
    file is empty. Within a file, what had another form, such as an ``xmi:id``, has been brought to that one.
    """

    name: str
    type: str
    is_reference: bool
    documentation: str = ""
    lower: int = 0
    upper: int = 1
    containment: bool = False
    unsettable: bool = False
    unique: bool = True
    is_id: bool = False
    stored: bool = True
    default: str | None = None
    opposite: str = ""
    keys: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ClassTable:
    """A class; ``supertypes`` are URIs; ``java_class`` is what Java is to have in its place, if anything."""

    name: str
    abstract: bool = False
    documentation: str = ""
    supertypes: tuple[str, ...] = ()
    features: tuple[FeatureTable, ...] = ()
    java_class: str = ""


@dataclass(frozen=True, slots=True)
class EnumTable:
    """An enumeration."""

    name: str
    literals: tuple[Literal, ...] = ()
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class DataTypeTable:
    """A data type that the package declares itself."""

    name: str
    java_class: str = ""
    serializable: bool = True
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class PackageTable:
    """A package, with the packages inside it.

    Attributes:
        elsewhere: URIs of packages inside it that stand in files of their own.
        root: which of the elements at the top of its file it is, counted from 0.
    """

    ns_uri: str
    name: str
    prefix: str
    documentation: str = ""
    classes: tuple[ClassTable, ...] = ()
    enums: tuple[EnumTable, ...] = ()
    datatypes: tuple[DataTypeTable, ...] = ()
    subpackages: tuple[PackageTable, ...] = ()
    elsewhere: tuple[str, ...] = ()
    root: int = 0
