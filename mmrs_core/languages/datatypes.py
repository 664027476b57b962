"""Values of attributes: how EMF writes each data type as text, and how it reads it back.

A real number keeps all its bits, whatever its type: one of EFloat is the double that its text means, and is
written with the fewest digits that give that double again. EMF rounds it to 32 bits when it reads it; what
EMF wrote comes back to it unchanged.
"""

from __future__ import annotations

import re
from base64 import b64decode, b64encode
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from decimal import Decimal

ECORE = "http://www.eclipse.org/emf/2002/Ecore"
XML_TYPES = "http://www.eclipse.org/emf/2003/XMLType"

_JAVA_REAL = re.compile(r"[+-]?(?:NaN|Infinity|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[fFdD]?)", re.ASCII)
_JAVA_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_LAST_UNIT = "\uffff"
_MOST_DIGITS = 4300
"""Of a whole number; Python reads no longer ones, since that takes the square of their length."""
_JAVA_INTEGER = re.compile(r"[+-]?[0-9]+")
_DATE = re.compile(
    r"(\d+)-(\d\d)-(\d\d)(?:T(\d\d):(\d\d)(?::(\d\d)(?:\.(\d{1,6}))?)?)?(Z|[+-]\d\d:?\d\d)?", re.ASCII
)


@dataclass(frozen=True, slots=True)
class DataType:
    """A type of attribute values.

    Attributes:
        ns_uri: of the package that declares it.
        name: as in the metamodel, such as EDouble.
        python: the class of its values.
        parse: reads a value from text; raises ValueError, whose message begins with the text.
        render: writes a value as EMF does; the value must be of the class ``python``.
        primitive_default: what an attribute holds that was never set; None except for Java's primitive types.
        primitive: whether a value can not be null.
        serializable: whether values appear in files at all.
        java_class: the class of its values in EMF.
    """

    ns_uri: str
    name: str
    python: type
    parse: Callable[[str], object]
    render: Callable[[object], str]
    primitive_default: object = None
    serializable: bool = True
    java_class: str = "java.lang.String"

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


def shown(text: str) -> str:
    """Return a text as messages quote it, cut where it is long."""
    return repr(text) if len(text) <= 60 else f"{text[:57]!r}..."


def parse_boolean(text: str) -> bool:
    """Read a truth value, in any case of letters, as EMF does."""
    word = text.lower()
    if word not in ("true", "false"):
        raise ValueError(f"{shown(text)}: not true or false")
    return word == "true"


def parse_real(text: str) -> float:
    """Read a number in Java's notation, which has NaN, Infinity and a trailing d or f."""
    # most numbers are in Python's notation too; it differs by underscores, other digits, words at the end
    if text[-1:].isdigit() and "_" not in text and text.isascii():
        try:
            return float(text)
        except ValueError:
            raise ValueError(f"{shown(text)}: not a number") from None
    stripped = text.strip()
    if not _JAVA_REAL.fullmatch(stripped, 0):
        raise ValueError(f"{shown(text)}: not a number")
    return float(stripped if stripped[-1] == "y" else stripped.rstrip("fFdD"))


def render_real(value: object) -> str:
    """Write a number as Java does: plain between 1e-3 and 1e7, else with a power of ten.

    >>> [render_real(x) for x in (0.0, -1.5, 42.0, 1e7, 12345678.9, 0.00012, float("inf"))]
    ['0.0', '-1.5', '42.0', '1.0E7', '1.23456789E7', '1.2E-4', 'Infinity']
    """
    number = float(value)  # type: ignore[arg-type]  # accepts() vouches for it
    if number != number:
        return "NaN"
    if number in (float("inf"), float("-inf")):
        return "Infinity" if number > 0 else "-Infinity"
    if number == 0.0 or 1e-3 <= abs(number) < 1e7:
        text = format(Decimal(repr(number)), "f")
        return text if "." in text else f"{text}.0"
    sign, digits, exponent = Decimal(repr(number)).as_tuple()
    if len(digits) == 1:  # Java writes the nearest two; they differ for a few of the smallest numbers only
        sign, digits, exponent = Decimal(f"{number:.1e}").as_tuple()
    figures = "".join(map(str, digits))
    power = int(exponent) + len(figures) - 1
    fraction = figures[1:].rstrip("0") or "0"
    return f"{'-' if sign else ''}{figures[0]}.{fraction}E{power}"


def _parse_schema_boolean(text: str) -> bool:
    """Read a truth value as XML Schema part 2 has it, section 3.2.2."""
    return parse_boolean({"1": "true", "0": "false"}.get(text, text))


def _parse_schema_real(text: str) -> float:
    """Read a number as XML Schema part 2 has it, section 3.2.5, or in Java's notation."""
    return parse_real(text.replace("INF", "Infinity") if text in ("INF", "-INF") else text)


def _render_schema_real(value: object) -> str:
    return render_real(value).replace("Infinity", "INF")


def _integer(bits: int | None) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not _JAVA_INTEGER.fullmatch(text):
            raise ValueError(f"{shown(text)}: not a whole number")
        if bits is not None and len(text) > 25:
            raise ValueError(f"{shown(text)}: does not fit into {bits} bits")
        if len(text.lstrip("+-")) > _MOST_DIGITS:
            raise ValueError(f"{shown(text)}: more than {_MOST_DIGITS} digits")
        value = int(text)
        if bits is not None and not -(1 << bits - 1) <= value < 1 << bits - 1:
            raise ValueError(f"{shown(text)}: does not fit into {bits} bits")
        return value

    return parse


def _parse_decimal(text: str) -> Decimal:
    if not _JAVA_DECIMAL.fullmatch(text):
        raise ValueError(f"{shown(text)}: not a decimal number")
    return Decimal(text)


def _parse_character(text: str) -> str:
    """Read a character as EMF does: its number, or itself where it is no digit."""
    if _JAVA_INTEGER.fullmatch(text) and len(text) < 7 and 0 <= int(text) < 1 << 16:
        return chr(int(text))
    if len(text) != 1:
        raise ValueError(f"{shown(text)}: not one character")
    if text > _LAST_UNIT:
        raise ValueError(f"{shown(text)}: not one character of 16 bits")
    return text


def _render_character(value: object) -> str:
    return str(ord(str(value)))


def _parse_bytes(text: str) -> bytes:
    try:
        return bytes.fromhex(text)
    except ValueError:
        raise ValueError(f"{shown(text)}: not bytes in hexadecimal digits") from None


def _parse_base64(text: str) -> bytes:
    try:
        return b64decode("".join(text.split()), validate=True)
    except ValueError:
        raise ValueError(f"{shown(text)}: not bytes in base 64") from None


def _render_base64(value: object) -> str:
    return b64encode(bytes(value)).decode()  # type: ignore[call-overload]  # accepts() vouches for it


def parse_date(text: str) -> datetime:
    """Read a date as EMF writes it; one without a zone is taken as UTC."""
    match = _DATE.fullmatch(text)
    if match is None:
        raise ValueError(f"{shown(text)}: not a date such as 2024-05-01T10:11:12.123+0200")
    year, month, day, hour, minute, second, fraction, zone = match.groups()
    micro = int((fraction or "").ljust(6, "0") or "0")
    try:
        date = datetime(
            int(year), int(month), int(day), int(hour or 0), int(minute or 0), int(second or 0), micro
        )
        offset = datetime.strptime(zone, "%z").tzinfo if zone and zone != "Z" else UTC
    except ValueError:
        raise ValueError(f"{shown(text)}: no such date") from None
    return date.replace(tzinfo=offset)


def _render_date(value: object) -> str:
    assert isinstance(value, datetime)  # accepts() vouches for it
    date = value if value.tzinfo else value.replace(tzinfo=UTC)
    return f"{date:%Y-%m-%dT%H:%M:%S}.{date.microsecond // 1000:03d}{date:%z}"


def _render_boolean(value: object) -> str:
    return "true" if value else "false"


def _render_bytes(value: object) -> str:
    return bytes(value).hex().upper()  # type: ignore[call-overload,no-any-return]  # accepts() vouches for it


_Codec = tuple[type, Callable[[str], object], Callable[[object], str], object]
_TEXT: _Codec = (str, str, str, None)


def _whole(bits: int | None, primitive: bool) -> _Codec:
    return (int, _integer(bits), str, 0 if primitive else None)


def _real(primitive: bool) -> _Codec:
    return (float, parse_real, render_real, 0.0 if primitive else None)


def _truth(primitive: bool) -> _Codec:
    return (bool, parse_boolean, _render_boolean, False if primitive else None)


_BY_JAVA_CLASS: dict[str, _Codec] = {
    "boolean": _truth(True),
    "java.lang.Boolean": _truth(False),
    "byte": _whole(8, True),
    "java.lang.Byte": _whole(8, False),
    "short": _whole(16, True),
    "java.lang.Short": _whole(16, False),
    "int": _whole(32, True),
    "java.lang.Integer": _whole(32, False),
    "long": _whole(64, True),
    "java.lang.Long": _whole(64, False),
    "java.math.BigInteger": _whole(None, False),
    "float": _real(True),
    "java.lang.Float": _real(False),
    "double": _real(True),
    "java.lang.Double": _real(False),
    "java.math.BigDecimal": (Decimal, _parse_decimal, str, None),
    "char": (str, _parse_character, _render_character, "\0"),
    "java.lang.Character": (str, _parse_character, _render_character, None),
    "byte[]": (bytes, _parse_bytes, _render_bytes, None),
    "java.util.Date": (datetime, parse_date, _render_date, None),
}

_ECORE_JAVA = {
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

_XML_JAVA = {
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


def declared_type(ns_uri: str, name: str, java_class: str, serializable: bool = True) -> DataType:
    """Return the data type that a package declares, whose values are as those of the Java class.

    The values of a class that is not known here are kept as the text that stands in the file.
    """
    python, parse, render, default = _BY_JAVA_CLASS.get(java_class, _TEXT)
    return DataType(
        ns_uri, name, python, parse, render, default, serializable, java_class or "java.lang.String"
    )


def builtin_type(ns_uri: str, name: str) -> DataType | None:
    """Return a data type of Ecore itself or of EMF's XML types; None where there is none of that name."""
    if ns_uri == ECORE and name in _ECORE_JAVA:
        return declared_type(ns_uri, name, _ECORE_JAVA[name])
    if ns_uri == XML_TYPES:
        found = declared_type(ns_uri, name, _XML_JAVA.get(name, "java.lang.String"))
        if found.python is float:
            return replace(found, parse=_parse_schema_real, render=_render_schema_real)
        if found.python is bool:
            return replace(found, parse=_parse_schema_boolean)
        if found.python is Decimal:
            return replace(found, render=lambda value: format(value, "f"))
        if name == "Base64Binary":
            return replace(found, parse=_parse_base64, render=_render_base64)
        return found
    return None
