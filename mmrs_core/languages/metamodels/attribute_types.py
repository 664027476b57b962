"""What the values of attributes are, by pyecore's EDataTypes, EEnums and EAttributes."""

from __future__ import annotations

from typing import Any

from pyecore import ecore

from mmrs_core.languages.datatypes import ECORE, DataType, builtin_type, declared_type
from mmrs_core.languages.metaclass import MANY, Enumeration, Literal, Metaclass
from mmrs_core.languages.metamodels.ecore_file import GENMODEL
from mmrs_core.languages.values.texts import described, shown

_NUMBERS = {float: "java.lang.Double", int: "java.math.BigInteger", bool: "java.lang.Boolean"}
_JAVA = {**_NUMBERS, str: "java.lang.String"}
"""The Java classes whose values are those of Python's classes."""
_Type = Metaclass | DataType | Enumeration


def data_type(ns_uri: str, kind: Any, made_in_python: bool) -> DataType:
    """Return a data type; of one made in Python, the class of its values counts, else Java's name of it."""
    if (known := builtin_type(ns_uri, kind.name)) is not None:
        return known
    # pyecore knows no default for the flag, and EMF's is true
    serializable = bool(kind.serializable) or not kind.eIsSet("serializable")
    java_class = kind.instanceClassName or ""
    if made_in_python and not java_class and isinstance(kind.eType, type):
        java_class = _JAVA.get(kind.eType, "")
        if not java_class and kind.eType is not object:
            return _python_type(ns_uri, kind, serializable)
    return declared_type(ns_uri, kind.name, java_class, serializable)


def _python_type(ns_uri: str, kind: Any, serializable: bool) -> DataType:
    """Return a data type whose values pyecore's ``from_string`` and ``to_string`` read and write."""

    def parse(text: str) -> object:
        try:
            value: object = kind.from_string(text)
        except Exception as fault:
            raise ValueError(f"{shown(text)}: not of the type {kind.name}: {fault}") from None
        if not isinstance(value, kind.eType):
            raise ValueError(f"{shown(text)}: not of the type {kind.name}")
        return value

    return DataType(ns_uri, kind.name, kind.eType, parse, kind.to_string, None, serializable)


def enumeration_of(ns_uri: str, kind: Any) -> Enumeration:
    """Return an enumeration."""
    return Enumeration(ns_uri, kind.name, tuple(map(_literal, kind.eLiterals)), documentation_of(kind))


def _literal(literal: Any) -> Literal:
    text = literal.name if literal.literal is None else literal.literal
    return Literal(literal.name, text, literal.value, documentation_of(literal))


def documentation_of(element: Any) -> str:
    """Return what a metamodel says about an element of its."""
    annotation = element.getEAnnotation(GENMODEL)
    if annotation is not None:
        text = annotation.details.get("documentation")
    else:  # in modules that pyecoregen wrote, classes have it as Python's classes do
        text = vars(element.python_class).get("__doc__") if isinstance(element, ecore.EClass) else ""
    return text if isinstance(text, str) else ""


def default_of(feature: Any, kind: _Type, upper: int) -> object:
    """Return what a feature holds that was never set.

    Raises:
        ValueError: if the default is not a value of its type; the message begins with it.
    """
    if isinstance(kind, Metaclass) or upper > 1 or upper == MANY:
        return None
    text = feature.defaultValueLiteral
    if text is not None and (text or kind.name == "EString"):
        return kind.parse(text)
    given = feature.default_value  # of one that was made in Python
    value = given.name if isinstance(given, ecore.EEnumLiteral) else given
    if value is not None and not (kind.ns_uri == ECORE and value == feature.eType.default_value):
        if isinstance(value, str) and not kind.accepts(value):  # pyecoregen writes numbers as texts
            return kind.parse(value)
        if not kind.accepts(value):
            raise ValueError(f"{described(value)}: not of the type {kind.name}")
        return value
    if feature.unsettable:
        return None
    if isinstance(kind, Enumeration):
        return kind.names[0] if kind.literals else None
    return kind.primitive_default
