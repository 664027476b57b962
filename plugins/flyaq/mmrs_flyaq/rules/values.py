"""Values of attributes, as a mapping or a source writes them and as our features hold them."""

from __future__ import annotations

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.metaclass import Enumeration, Feature
from mmrs_core.languages.naming import nearest
from mmrs_flyaq.rules.mapping import Constant


def parsed(feature: Feature, value: Constant) -> object:
    """Return a value as the feature holds it; a whole number may be written with a fraction of 0.

    Raises:
        ValueError: if it is not of the feature's type; the message begins with the value.
    """
    kind = feature.type
    if not isinstance(kind, DataType | Enumeration):
        raise ValueError(f"{value!r}: {feature.name} holds elements, not values")
    text = said(value)
    if isinstance(kind, DataType) and kind.python is int and text.endswith(".0"):
        text = text.removesuffix(".0")
    return kind.parse(text)


def said(value: Constant) -> str:
    """Return a value as files and reports write it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def misfit(feature: Feature, value: Constant) -> str:
    """Return why a feature cannot hold a value; an empty text if it can."""
    if isinstance(feature.type, Enumeration):
        literals = [literal.literal for literal in feature.type.literals]
        return "" if value in literals else no_literal(said(value), feature.type.name, literals)
    try:
        parsed(feature, value)
    except ValueError as fault:
        return str(fault)
    return ""


def no_literal(text: str, of: str, literals: list[str]) -> str:
    """Return the message for a text that is none of an enumeration's literals."""
    hint = nearest(text, literals)
    return f"{text!r} is not a literal of {of} ({', '.join(literals)}){hint and '; ' + hint}"
