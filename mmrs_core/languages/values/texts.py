"""Texts as values, and what all kinds of values have in common."""

from __future__ import annotations

import re

LAST_UNIT = "\uffff"
"""Java's characters have 16 bits."""

_BLANKS = re.compile("[ \t\n\r]+")
_NUMBER = re.compile(r"[+-]?\d+")
_CLASS_NAME = re.compile(r"(?:[^\W\d]|\$)(?:\w|\$)*(?:\.(?:[^\W\d]|\$)(?:\w|\$)*)*")
_ARRAY = re.compile(r"\[+(?:[ZBCSIJFD]|L([^;]+);)")
_SERIALIZED = re.compile(r"ACED0005(?:[0-9A-F]{2})+", re.IGNORECASE)
_QUALIFIED = re.compile(r"(?:(?:[^\W\d][\w.\-]*)?:)?[^\W\d][\w.\-]*")
_EVERYWHERE = re.compile(
    r"boolean|byte|char|short|int|long|float|double|void|\[+[ZBCSIJFD]|(?:\[+L)?java\.[a-z]+\.[\w.$]+;?"
)


def shown(text: str) -> str:
    """Return a text as messages quote it, cut where it is long."""
    return repr(text) if len(text) <= 60 else f"{text[:57]!r}..."


def described(value: object) -> str:
    """Return any value as messages quote it, cut where it is long."""
    try:
        words = repr(value)
    except ValueError:  # a whole number of more digits than Python writes at once
        return "a number of several thousand digits"
    return words if len(words) <= 80 else f"{words[:77]}..."


def words_of(text: str) -> list[str]:
    r"""Return the values in an attribute that holds many, as EMF tells them apart: by U+0020 only.

    >>> words_of(" a b\u00a0c  d ")
    ['a', 'b\xa0c', 'd']
    """
    return [word for word in text.split(" ") if word]


def collapsed(text: str) -> str:
    """Return a text with single blanks between its words, as XML Schema part 2 says in section 4.3.6."""
    return _BLANKS.sub(" ", text).strip(" ")


def render_collapsed(value: object) -> str:
    """Write a text whose type takes no blanks but single ones between words.

    Raises:
        ValueError: if it has others: they would be lost.
    """
    text = str(value)
    if text != collapsed(text):
        raise ValueError(f"{shown(text)}: holds blanks that its type does not keep")
    return text


def parse_qualified(text: str) -> str:
    """Read a name that a prefix may stand before, as EMF does: it may hold no blanks, and one colon."""
    name = collapsed(text)
    if not _QUALIFIED.fullmatch(name):
        raise ValueError(f"{shown(text)}: not a qualified name")
    return name.removeprefix(":")


def render_qualified(value: object) -> str:
    """Write such a name; raises ValueError for what is none."""
    return parse_qualified(render_collapsed(value))


def parse_character(text: str) -> str:
    """Read a character as EMF does: its number, or itself where it is not a digit."""
    if _NUMBER.fullmatch(text) and max(text) <= LAST_UNIT and len(text) < 7 and 0 <= int(text) < 1 << 16:
        return chr(int(text))
    if len(text) != 1:
        raise ValueError(f"{shown(text)}: not one character")
    if text > LAST_UNIT:
        raise ValueError(f"{shown(text)}: not one character of 16 bits")
    return text


def render_character(value: object) -> str:
    """Write a character as its number; raises ValueError for what is not one of 16 bits."""
    text = str(value)
    if len(text) != 1 or text > LAST_UNIT:
        raise ValueError(f"{shown(text)}: not one character of 16 bits")
    return str(ord(text))


def parse_java_object(text: str) -> str:
    """Read what only Java can read: an object as Java serializes it, in hexadecimal digits."""
    if not _SERIALIZED.fullmatch(text):
        raise ValueError(f"{shown(text)}: not a serialized object of Java")
    return text.upper()


def render_java_object(value: object) -> str:
    """Write an object that Java has serialized; raises ValueError for any other text."""
    return parse_java_object(str(value))


def parse_class_name(text: str) -> str:
    """Read the name of a class as Java's ``Class.forName`` takes it, or of a primitive type."""
    array = _ARRAY.fullmatch(text)
    name = array[1] if array else text
    if name is not None and not _CLASS_NAME.fullmatch(name):
        raise ValueError(f"{shown(text)}: not the name of a class")
    return text


def render_class_name(value: object) -> str:
    """Write the name of a class; raises ValueError for what can be none."""
    return parse_class_name(str(value))


def doubt_of_class(value: object) -> str:
    """Return why it is not certain that Eclipse knows a class; nothing for those of Java's own packages."""
    if _EVERYWHERE.fullmatch(str(value)):
        return ""
    return "is known to Eclipse only where a plug-in brings that class; be sure that one does"
