"""Writes SVG and HTML elements; whatever comes from a model is escaped here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from importlib.resources import files

_LOWEST_PRINTABLE = 0x20
_ALLOWED_CONTROLS = "\t\n\r"


def text(value: object) -> str:
    """Return a value as it may stand in element content or in a quoted attribute.

    Characters that XML forbids become U+FFFD, so that no name can break a document.

    >>> text('<b> & "c"')
    '&lt;b&gt; &amp; &quot;c&quot;'
    """
    return escape("".join(map(_legal, str(value))), quote=True)


def element(tag: str, attributes: Mapping[str, object] | None = None, *children: str | Iterable[str]) -> str:
    """Return an element; children are markup already, attributes are plain values, numbers among them.

    Attributes that are None are left out. Underscores in their names become hyphens.

    >>> element("g", {"class": "a", "stroke_width": 1.5}, "<b/>")
    '<g class="a" stroke-width="1.5"><b/></g>'
    """
    inside = "".join(child if isinstance(child, str) else "".join(child) for child in children)
    start = tag + "".join(_attribute(name, value) for name, value in (attributes or {}).items())
    return f"<{start}>{inside}</{tag}>" if inside else f"<{start}/>"


def title(words: str) -> str:
    """Return the element whose words SVG viewers show when the pointer rests on its parent."""
    return element("title", None, text(words))


def number(value: float) -> str:
    """Return a coordinate with at most two decimals.

    >>> number(3.0), number(2.345), number(-0.001)
    ('3', '2.35', '0')
    """
    short = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short


def style_sheet(name: str, package: str = "mmrs_core.pictures.preview") -> str:
    """Return one of the style sheets of a package; they are safe inside a ``style`` element."""
    return (files(package) / name).read_text(encoding="utf-8")


def _attribute(name: str, value: object) -> str:
    if value is None:
        return ""
    shown = number(value) if isinstance(value, float) else value
    return f' {name.replace("_", "-")}="{text(shown)}"'


def _legal(character: str) -> str:
    code = ord(character)
    if code < _LOWEST_PRINTABLE and character not in _ALLOWED_CONTROLS:
        return "\ufffd"
    forbidden = 0x7F <= code <= 0x9F or 0xD800 <= code <= 0xDFFF or code in (0xFFFE, 0xFFFF)
    return "\ufffd" if forbidden else character
