"""How values of each Java class, and of EMF's XML types, are read and written; bytes and truth values too."""

from __future__ import annotations

import re
from base64 import b64decode, b64encode
from collections.abc import Callable
from datetime import datetime
from decimal import Decimal
from typing import NamedTuple

from mmrs_core.languages.values import dates, exact, real, texts
from mmrs_core.languages.values.texts import collapsed, shown

_HEXADECIMAL = re.compile("[0-9a-fA-F]*")
_BLANKS = re.compile("[ \t\n\r]+")


def parse_bytes(text: str) -> bytes:
    """Read hexadecimal digits as EMF does: the last, if it has no partner, is a byte of its own."""
    if not _HEXADECIMAL.fullmatch(text):
        raise ValueError(f"{shown(text)}: not bytes in hexadecimal digits")
    return bytes.fromhex(f"{text[:-1]}0{text[-1]}" if len(text) % 2 else text)


def parse_schema_bytes(text: str) -> bytes:
    """Read hexadecimal digits as XML Schema part 2 has them, section 3.2.15."""
    digits = collapsed(text)
    if len(digits) % 2:
        raise ValueError(f"{shown(text)}: an odd number of hexadecimal digits")
    return parse_bytes(digits)


def render_bytes(value: object) -> str:
    """Write bytes in hexadecimal digits."""
    return bytes(value).hex().upper()  # type: ignore[call-overload,no-any-return]  # accepts() vouches for it


def parse_base64(text: str) -> bytes:
    """Read bytes in base 64; blanks may stand anywhere."""
    digits = _BLANKS.sub("", text)
    try:
        value = b64decode(digits, validate=True)
    except ValueError:
        raise ValueError(f"{shown(text)}: not bytes in base 64") from None
    if render_base64(value) != digits:
        raise ValueError(f"{shown(text)}: bits behind the last byte in base 64")
    return value


def render_base64(value: object) -> str:
    """Write bytes in base 64."""
    return b64encode(bytes(value)).decode()  # type: ignore[call-overload]  # accepts() vouches for it


def parse_boolean(text: str) -> bool:
    """Read a truth value, in any case of letters, as EMF does."""
    word = text.lower()
    if word not in ("true", "false"):
        raise ValueError(f"{shown(text)}: not true or false")
    return word == "true"


def parse_schema_boolean(text: str) -> bool:
    """Read a truth value as XML Schema part 2 has it, section 3.2.2."""
    word = collapsed(text)
    if word not in ("true", "false", "1", "0"):
        raise ValueError(f"{shown(text)}: not true, false, 1 or 0")
    return word in ("true", "1")


def render_boolean(value: object) -> str:
    """Write a truth value."""
    return "true" if value else "false"


class Codec(NamedTuple):
    """What the values of a Java class are in Python, and as text.

    Attributes:
        python: the class of its values.
        parse: reads a value from text; raises ValueError, whose message begins with the text.
        render: writes a value as EMF does; raises ValueError if EMF could not read it again as that value.
        default: what a primitive type of Java holds that was never set; otherwise None.
        bits: of a whole number, sign included; None for any number, and for what is not a whole number.
        doubt: returns what in a value Eclipse may read differently; mostly nothing.
    """

    python: type
    parse: Callable[[str], object]
    render: Callable[[object], str]
    default: object = None
    bits: int | None = None
    doubt: Callable[[object], str] | None = None


def _whole(bits: int | None, default: object = None) -> Codec:
    return Codec(int, exact.reader(bits), exact.writer(bits), default, bits)


def _truth(default: object = None) -> Codec:
    return Codec(bool, parse_boolean, render_boolean, default)


_TEXT = Codec(str, str, str)
_DOUBLE = Codec(float, real.parse_real, real.render_real)
_SINGLE = Codec(float, real.parse_single, real.render_single)
_CHARACTER = Codec(str, texts.parse_character, texts.render_character)

_BY_JAVA_CLASS: dict[str, Codec] = {
    "boolean": _truth(False),
    "java.lang.Boolean": _truth(),
    "byte": _whole(8, 0),
    "java.lang.Byte": _whole(8),
    "short": _whole(16, 0),
    "java.lang.Short": _whole(16),
    "int": _whole(32, 0),
    "java.lang.Integer": _whole(32),
    "long": _whole(64, 0),
    "java.lang.Long": _whole(64),
    "java.math.BigInteger": _whole(None),
    "float": _SINGLE._replace(default=0.0),
    "java.lang.Float": _SINGLE,
    "double": _DOUBLE._replace(default=0.0),
    "java.lang.Double": _DOUBLE,
    "java.math.BigDecimal": Codec(Decimal, exact.parse_decimal, exact.render_decimal),
    "char": _CHARACTER._replace(default="\0"),
    "java.lang.Character": _CHARACTER,
    "byte[]": Codec(bytes, parse_bytes, render_bytes),
    "java.util.Date": Codec(datetime, dates.parse_date, dates.render_date, doubt=dates.doubt_of_date),
    "java.lang.Object": Codec(str, texts.parse_java_object, texts.render_java_object),
    "java.lang.Class": Codec(
        str, texts.parse_class_name, texts.render_class_name, doubt=texts.doubt_of_class
    ),
}

_WORDS = Codec(str, texts.collapsed, texts.render_collapsed)
_XML_CODECS = {
    "Base64Binary": Codec(bytes, parse_base64, render_base64),
    "HexBinary": Codec(bytes, parse_schema_bytes, render_bytes),
    **dict.fromkeys(
        ("Token", "Language", "Name", "NCName", "ID", "IDREF", "IDREFS", "IDREFSBase", "ENTITY", "ENTITIES"),
        _WORDS,
    ),
    **dict.fromkeys(("ENTITIESBase", "NMTOKEN", "NMTOKENS", "NMTOKENSBase"), _WORDS),
    **dict.fromkeys(("QName", "NOTATION"), Codec(str, texts.parse_qualified, texts.render_qualified)),
}
_SCHEMA_CODECS: dict[str, Codec] = {
    "boolean": Codec(bool, parse_schema_boolean, render_boolean),
    "double": Codec(float, real.parse_schema_real, real.render_schema_real),
    "float": Codec(float, real.parse_schema_single, real.render_schema_single),
    "java.math.BigDecimal": Codec(Decimal, exact.parse_schema_decimal, exact.render_schema_decimal),
}
"""The codecs of the Java classes that EMF's XML types read otherwise than Ecore's."""
_OBJECTS = {"java.lang.Boolean": "boolean", "java.lang.Double": "double", "java.lang.Float": "float"}


def codec_of(java_class: str) -> Codec:
    """Return how Ecore's types of a Java class are read and written; as plain texts where it is not known."""
    return _BY_JAVA_CLASS.get(java_class, _TEXT)


def schema_codec_of(name: str, java_class: str) -> Codec:
    """Return the same for one of EMF's XML types."""
    codec = _BY_JAVA_CLASS.get(java_class, _TEXT)
    if name in _XML_CODECS:
        return _XML_CODECS[name]
    if codec.python is int:
        return codec._replace(parse=exact.schema_reader(codec.bits))
    other = _SCHEMA_CODECS.get(_OBJECTS.get(java_class, java_class))
    return codec if other is None else other._replace(default=codec.default)
