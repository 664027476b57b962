"""From the text of a source value to the value of a feature."""

from __future__ import annotations

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Enumeration, Feature
from mmrs_core.migration.rules.mapping import Constant
from mmrs_core.migration.rules.paths import reach


def put(element: Element, path: str, value: Constant) -> None:
    """Set the feature at the end of a path.

    Raises:
        ValueError: if the value is not of the feature's type; the message begins with the value.
    """
    owner, feature = reach(element, path)
    found = parsed(feature, value)
    if feature.many:
        getattr(owner, feature.attribute).append(found)
    else:
        setattr(owner, feature.attribute, found)


def parsed(feature: Feature, value: Constant) -> object:
    """Return a value as the feature holds it; a whole number may be written with a fraction of 0.

    Raises:
        ValueError: if it is not of the feature's type.
    """
    kind = feature.type
    if not isinstance(kind, DataType | Enumeration):
        raise ValueError(f"{value!r}: {feature.name} holds elements, not values")
    text = str(value).lower() if isinstance(value, bool) else str(value)
    if isinstance(kind, DataType) and kind.python is int and text.endswith(".0"):
        text = text.removesuffix(".0")
    return kind.parse(text)


def scaled(text: str, factor: float) -> str:
    """Return a number times a factor, as text.

    Raises:
        ValueError: if the text is no number.

    >>> scaled("45", 60), scaled("0.5", 1.0)
    ('2700.0', '0.5')
    """
    return text if factor == 1.0 else repr(number_in(text) * factor)


def number_in(text: str) -> float:
    """Return the number that a text is.

    Raises:
        ValueError: if it is none.
    """
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text!r}: not a number") from None
