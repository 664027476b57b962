"""What XML cannot hold as it is, and what EMF writes instead."""

from __future__ import annotations

import re

NO_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")
"""Characters that XML cannot hold at all."""

_ATTRIBUTE_ESCAPES = {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\n": "&#xA;", "\t": "&#x9;", "\r": "&#xD;"}
_IN_ATTRIBUTE = re.compile('[&<"\n\t\r]')
_TEXT_ESCAPES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\r": "&#xD;"}
_IN_TEXT = re.compile('[&<"\r]|(?<=]])>')


def in_attribute(value: str) -> str:
    """Return a text as it stands between the quotes of an attribute."""
    return _IN_ATTRIBUTE.sub(lambda match: _ATTRIBUTE_ESCAPES[match.group()], value)


def in_text(value: str) -> str:
    """Return a text as it stands between tags."""
    return _IN_TEXT.sub(lambda match: _TEXT_ESCAPES[match.group()], value)


def in_comment(value: str) -> str:
    """Return a text as it can stand in a comment, whose end it cannot be; its lines stay.

    >>> in_comment("a --> <b>-")
    'a - -> <b>- '
    """
    words = "\n".join(" ".join(line.split()) for line in value.strip().splitlines())
    words = NO_XML.sub("\N{REPLACEMENT CHARACTER}", words)
    apart = re.sub("-(?=-)", "- ", words)
    return f"{apart} " if apart.endswith("-") else apart
