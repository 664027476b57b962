"""Thrusters in the water: how thrust follows what their drives put out, and what that costs."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log

from auv_vessel.sheet import Sheet, Thruster

_LAG = 0.15  # seconds
_LIKE_A_PROPELLER = 1.5  # power by thrust, of an ideal propeller at rest


def watts_of(thruster: Thruster, thrust: float) -> float:
    """Return what a thruster draws at a thrust, newtons; see `curve_of`."""
    watts, newtons, exponent = curve_of(thruster)
    drawn: float = watts * (abs(thrust) / newtons) ** exponent
    return drawn


def curve_of(thruster: Thruster) -> tuple[float, float, float]:
    """Return watts, newtons and exponent of what a thruster draws: watts * (thrust / newtons) ** exponent.

    The curve is the power law through what its type says of operating and of peak thrust; through the former,
    with the exponent 3/2 of an ideal propeller at rest, if peak thrust or power is no more than that.
    """
    operating, most = thruster.operating_thrust, thruster.max_thrust
    if not (operating > 0.0 and thruster.operating_power > 0.0):
        return (thruster.max_power, most, _LIKE_A_PROPELLER) if most > 0.0 else (0.0, 1.0, 1.0)
    exponent = _LIKE_A_PROPELLER
    if most > operating and thruster.max_power > thruster.operating_power:
        exponent = log(thruster.max_power / thruster.operating_power) / log(most / operating)
    return thruster.operating_power, operating, exponent


class Propulsion:
    """All thrusters of a vehicle: thrust follows its set-point with a lag of first order.

    Attributes:
        thrusts: newtons, now.
    """

    def __init__(self, sheet: Sheet, step: float) -> None:
        """Begin with thrusters at rest.

        Args:
            sheet: its `extra` may say ``thruster.lag``, the seconds in which a thruster gets within 1/e of
                its set-point: 0.15 if it does not.
            step: seconds from one to the next.

        Raises:
            ValueError: the lag is negative.
        """
        lag = sheet.extra.get("thruster.lag", _LAG)
        if not lag >= 0.0:
            raise ValueError(f"{sheet.robot}: thruster.lag is {lag:g}, and has to be 0 or more")
        self.thrusts = [0.0] * len(sheet.thrusters)
        self._left = (exp(-step / 2.0 / lag), exp(-step / lag)) if lag > 0.0 else (0.0, 0.0)

    def step(self, wanted: Sequence[float]) -> tuple[list[float], list[float], list[float]]:
        """Go one step on; return the thrusts at its begin, in its middle and at its end."""
        begin = self.thrusts
        half, whole = self._left
        middle = [aim + half * (thrust - aim) for thrust, aim in zip(begin, wanted, strict=True)]
        self.thrusts = [aim + whole * (thrust - aim) for thrust, aim in zip(begin, wanted, strict=True)]
        return begin, middle, self.thrusts
