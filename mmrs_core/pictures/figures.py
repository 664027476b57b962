"""Figures as people read them: times, lengths, heights."""

from __future__ import annotations

from math import ceil, isinf

_MINUTE = 60
_HOUR = 3600
_KILOMETRE = 1000.0
_METRES_WITH_DECIMAL = 100.0
_MANY_JOULES = 10_000.0
_JOULES_IN_WATT_HOUR = 3600.0


def clock(seconds: float) -> str:
    """Return a time or duration as minutes and seconds, with hours where there are any.

    >>> clock(65.4), clock(3725)
    ('1:05', '1:02:05')
    """
    whole = round(seconds)
    minutes, rest = divmod(whole, _MINUTE)
    if whole < _HOUR:
        return f"{minutes}:{rest:02}"
    return f"{minutes // _MINUTE}:{minutes % _MINUTE:02}:{rest:02}"


def length(metres: float) -> str:
    """Return a length with a unit.

    >>> length(7.25), length(321.4), length(4321)
    ('7.2 m', '321 m', '4.32 km')
    """
    if abs(metres) >= _KILOMETRE:
        return f"{metres / _KILOMETRE:.2f} km"
    return f"{metres:.1f} m" if abs(metres) < _METRES_WITH_DECIMAL else f"{metres:.0f} m"


def quantity(value: float, unit: str) -> str:
    """Return a figure with its unit, without exponents.

    >>> quantity(3.6912, "m"), quantity(104321.0, "J"), quantity(848.4, "s"), quantity(0.0, "")
    ('3.69 m', '104 kJ', '848 s', '0')
    """
    if unit == "J" and abs(value) >= _MANY_JOULES:
        return f"{value / 1000:.0f} kJ"
    shown = f"{value:.0f}" if abs(value) >= _METRES_WITH_DECIMAL else f"{value:.3g}"
    return f"{shown} {unit}".rstrip()


def energy(joules: float | None) -> str:
    """Return an energy in watt hours.

    >>> energy(36_000.0), energy(0.0), energy(None)
    ('10.0 Wh', '0.0 Wh', 'not known')
    """
    return "not known" if joules is None else f"{joules / _JOULES_IN_WATT_HOUR:.1f} Wh"


def heights(low: float, high: float) -> str:
    """Return what heights an area covers.

    >>> heights(0.0, 25.0), heights(float("-inf"), float("inf"))
    ('0.0 m to 25.0 m', 'all heights')
    """
    if isinf(low) and isinf(high):
        return "all heights"
    if isinf(high):
        return f"from {length(low)} up"
    return f"up to {length(high)}" if isinf(low) else f"{length(low)} to {length(high)}"


_NEAR = 1.5
"""Times the lower bound up to which a plan's distance from it is given in per cent."""


def within(makespan: float, lower_bound: float) -> str:
    """Return by how much a plan is longer than any at most.

    >>> within(103.0, 100.0), within(171.9, 100.0)
    ('within 3 % of the best possible', 'at most 1.72 times the best possible')
    """
    per_cent = ceil(100.0 * (makespan / lower_bound - 1.0) - 1e-6)
    if makespan > _NEAR * lower_bound:
        return f"at most {1.0 + per_cent / 100.0:.2f} times the best possible"
    return f"within {per_cent} % of the best possible"
