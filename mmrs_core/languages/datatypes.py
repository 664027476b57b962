"""Data types: what the attributes of a metamodel hold, in memory and as text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from mmrs_core.languages.values.codecs import Codec, codec_of, schema_codec_of
from mmrs_core.languages.values.dates import parse_date
from mmrs_core.languages.values.real import parse_real, render_real
from mmrs_core.languages.values.texts import shown

ECORE_CLASSES = {
    "EBoolean": "boolean",
    "EBooleanObject": "java.lang.Boolean",
    "EByte": "byte",
    "EByteObject": "java.lang.Byte",
    "EByteArray": "byte[]",
    "EChar": "char",
    "ECharacterObject": "java.lang.Character",
    "EDate": "java.util.Date",
    "EDouble": "double",
    "EDoubleObject": "java.lang.Double",
    "EFloat": "float",
    "EFloatObject": "java.lang.Float",
    "EInt": "int",
    "EIntegerObject": "java.lang.Integer",
    "ELong": "long",
    "ELongObject": "java.lang.Long",
    "EShort": "short",
    "EShortObject": "java.lang.Short",
    "EBigInteger": "java.math.BigInteger",
    "EBigDecimal": "java.math.BigDecimal",
    "EString": "java.lang.String",
    "EJavaObject": "java.lang.Object",
    "EJavaClass": "java.lang.Class",
}

XML_CLASSES = {
    "Base64Binary": "byte[]",
    "HexBinary": "byte[]",
    "Boolean": "boolean",
    "BooleanObject": "java.lang.Boolean",
    "Byte": "byte",
    "ByteObject": "java.lang.Byte",
    "Decimal": "java.math.BigDecimal",
    "Double": "double",
    "DoubleObject": "java.lang.Double",
    "Float": "float",
    "FloatObject": "java.lang.Float",
    "Int": "int",
    "IntObject": "java.lang.Integer",
    "Integer": "java.math.BigInteger",
    "Long": "long",
    "LongObject": "java.lang.Long",
    "Short": "short",
    "ShortObject": "java.lang.Short",
    "UnsignedByte": "short",
    "UnsignedByteObject": "java.lang.Short",
    "UnsignedShort": "int",
    "UnsignedShortObject": "java.lang.Integer",
    "UnsignedInt": "long",
    "UnsignedIntObject": "java.lang.Long",
    "UnsignedLong": "java.math.BigInteger",
    "NonNegativeInteger": "java.math.BigInteger",
    "NonPositiveInteger": "java.math.BigInteger",
    "NegativeInteger": "java.math.BigInteger",
    "PositiveInteger": "java.math.BigInteger",
}


__all__ = [
    "BUILT_IN",
    "ECORE",
    "XML_TYPES",
    "DataType",
    "builtin_type",
    "declared_type",
    "parse_date",
    "parse_real",
    "refusal",
    "render_real",
    "shown",
]

ECORE = "http://www.eclipse.org/emf/2002/Ecore"
XML_TYPES = "http://www.eclipse.org/emf/2003/XMLType"
BUILT_IN = (ECORE, XML_TYPES)
"""The nsURIs of metamodels that no plug-in provides."""


_ONLY_ECORES = ("java.lang.Object", "java.lang.Class")
"""A type of another package may name them for what only its own factory can read."""


_TIMES = ("Date", "DateTime", "Time", "GDay", "GMonth", "GMonthDay", "GYear", "GYearMonth")
_REFUSED = {
    "Duration": "use EDouble, and state the unit in its documentation",
    **dict.fromkeys(_TIMES, "use EDate, or EString for a part of a date"),
}
"""EMF's types of XML whose values are of no class that Ecore has a type for, and what to use instead."""


@dataclass(frozen=True, slots=True)
class DataType:
    """A type of attribute values.

    Attributes:
        ns_uri: of the package that declares it.
        name: as in the metamodel, such as EDouble.
        python: the class of its values.
        parse: reads a value from text; raises ValueError, whose message begins with the text.
        render: writes a value of the class ``python`` as EMF does; raises ValueError if EMF could not read it
            again as that value.
        primitive_default: what an attribute holds that was never set; None except for Java's primitive types.
        serializable: whether values appear in files at all.
        java_class: the class of its values in EMF.
        bits: of whole numbers, sign included; None where they are not bounded, and for other values.
        doubt: returns what in a value Eclipse may read differently, and after a semicolon what to do about
            it; nothing for nearly all values, and None where that holds for all.
    """

    ns_uri: str
    name: str
    python: type
    parse: Callable[[str], object]
    render: Callable[[object], str]
    primitive_default: object = None
    serializable: bool = True
    java_class: str = "java.lang.String"
    bits: int | None = None
    doubt: Callable[[object], str] | None = None

    @property
    def primitive(self) -> bool:
        """Return whether its values are those of a primitive type of Java."""
        return self.primitive_default is not None

    def accepts(self, value: object) -> bool:
        """Return whether a value in memory is one of this type; whole numbers pass for real ones."""
        if self.python is float:
            return isinstance(value, (float, int)) and not isinstance(value, bool)
        if self.python is int:
            return isinstance(value, int) and not isinstance(value, bool)
        return isinstance(value, self.python)


def declared_type(ns_uri: str, name: str, java_class: str, serializable: bool = True) -> DataType:
    """Return the data type that a package declares, whose values are as those of the Java class.

    The values of a class that is not known here are kept as the text that stands in the file.
    """
    readable = ns_uri == ECORE or java_class not in _ONLY_ECORES
    codec = codec_of(java_class if readable else "java.lang.String")
    return _made(ns_uri, name, java_class, codec, serializable)


@cache
def builtin_type(ns_uri: str, name: str) -> DataType | None:
    """Return a data type of Ecore itself or of EMF's XML types; None for no such name, and a refused one."""
    if ns_uri == ECORE and name in ECORE_CLASSES:
        return declared_type(ns_uri, name, ECORE_CLASSES[name])
    if ns_uri == XML_TYPES and name not in _REFUSED:
        java_class = XML_CLASSES.get(name, "java.lang.String")
        return _made(ns_uri, name, java_class, schema_codec_of(name, java_class), True)
    return None


def refusal(ns_uri: str, name: str) -> str:
    """Return why attributes cannot have a type of EMF's, and what to use instead; empty where they can."""
    if ns_uri != XML_TYPES or name not in _REFUSED:
        return ""
    return f"the type {name} of XML Schema is not supported; {_REFUSED[name]}"


def _made(ns_uri: str, name: str, java_class: str, codec: Codec, serializable: bool) -> DataType:
    python, parse, render, default, bits, doubt = codec
    java = java_class or "java.lang.String"
    return DataType(ns_uri, name, python, parse, render, default, serializable, java, bits, doubt)
