"""Bytes as values: in hexadecimal digits, in base 64."""

from __future__ import annotations

import re
from base64 import b64decode, b64encode

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
