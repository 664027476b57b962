"""From the text of a source value to the value of a feature."""

from __future__ import annotations

from mmrs_core.languages.element import Element
from mmrs_flyaq.rules.mapping import Constant
from mmrs_flyaq.rules.paths import FeaturePath, Keep, reach
from mmrs_flyaq.rules.values import parsed


def put(element: Element, path: FeaturePath, value: Constant, keep: Keep | None = None) -> None:
    """Set the feature at the end of a path.

    Args:
        keep: gives a place to what is made on the way and only referred to.

    Raises:
        ValueError: if the value is not of the feature's type; the message begins with the value. If what
            stands on the way is of a class without that feature.
    """
    owner, feature = reach(element, path, keep)
    found = parsed(feature, value)
    if feature.many:
        getattr(owner, feature.attribute).append(found)
    else:
        setattr(owner, feature.attribute, found)


def scaled(text: str, factor: float) -> str:
    """Return a number times a factor, as text.

    Raises:
        ValueError: if the text is not a number.

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
