"""The attributes of a robot type that hold figures, as they are written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from .figures import MISSION, STEP, Figure, found_by

CAPABILITY = ("lifetime", "maxTurnRate", "launchTime", "recoveryTime", "landingRate", "landingHeight")
"""Attributes of a movement capability that a flight tells."""

TIMING = (
    "maxAcceleration",
    "maxDeceleration",
    "maxJerk",
    "maxClimbRate",
    "maxDescentRate",
    "maxVerticalAcceleration",
    "cornerRadius",
    "settlingTime",
    "overshoot",
    "lag",
    "lagTime",
)
"""Attributes of its timing of legs, for each way of flying them."""


def shown(value: float) -> str:
    """Return a value with three digits, and never an exponent.

    >>> shown(3.47159), shown(2005.46), shown(-0.00004)
    ('3.47', '2010', '0')
    """
    digits = float(f"{value:.3g}")
    return f"{digits:.4f}".rstrip("0").rstrip(".") if abs(digits) >= 0.00005 else "0"


def written(figures: Iterable[Figure], names: Iterable[str], flown_as: str = "") -> dict[str, str]:
    """Return attributes that have a value beyond doubt, by name; one estimated as less than 0 is 0.

    Args:
        names: that are asked for, in the order in which they are written.
        flown_as: how the legs were flown.
    """
    found = found_by(each for each in figures if each.flown_as == flown_as)
    return {name: shown(found[name]) for name in names if name in found}


def element_lines(figures: tuple[Figure, ...]) -> Iterator[str]:
    """Yield the lines of a robot type that hold the figures."""
    yield f"<movementCapabilities{_attributes(written(figures, CAPABILITY))}>"
    for flown_as in (STEP, MISSION):
        if timing := written(figures, TIMING, flown_as):
            yield f'  <legTimings flownAs="{flown_as}"{_attributes(timing)}/>'
    yield "</movementCapabilities>"


def _attributes(values: dict[str, str]) -> str:
    return "".join(f' {name}="{value}"' for name, value in values.items())
