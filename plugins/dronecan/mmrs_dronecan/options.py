"""The options of these drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

_NAMES = ("node", "curve", "max-rpm", "arming")


@dataclass(frozen=True, slots=True)
class Options:
    """What can be chosen.

    Attributes:
        node: identifier of the node that commands, 1 to 127.
        square: whether thrust goes with the square of the command.
        max_rpm: revolutions per minute at peak thrust; None: not known.
        arming: whether to say that drives may turn.
    """

    node: int = 10
    square: bool = True
    max_rpm: float | None = None
    arming: bool = True


def options_of(given: Mapping[str, str]) -> Options:
    """Return the options that were given by name.

    Raises:
        ValueError: there is no such option, or its value is none.
    """
    if odd := sorted(given.keys() - set(_NAMES)):
        raise ValueError(f"dronecan: no option {', '.join(odd)}; there are {', '.join(_NAMES)}")
    return Options(
        _node(given.get("node", "10")),
        _one_of("curve", given.get("curve", "square"), "square", "linear"),
        _rpm(given["max-rpm"]) if "max-rpm" in given else None,
        _one_of("arming", given.get("arming", "yes"), "yes", "no"),
    )


def _node(text: str) -> int:
    if not (text.isascii() and text.isdecimal() and len(text) < 4) or not 1 <= int(text) <= 127:
        raise ValueError(f"dronecan: node {text!r} is not 1 to 127")
    return int(text)


def _rpm(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not isfinite(value) or not 0.0 < value <= 131_071.0:
        raise ValueError(f"dronecan: max-rpm {text!r} is not above 0, up to 131071")
    return value


def _one_of(what: str, text: str, yes: str, no: str) -> bool:
    if text not in (yes, no):
        raise ValueError(f"dronecan: {what} {text!r} is neither {yes} nor {no}")
    return text == yes
