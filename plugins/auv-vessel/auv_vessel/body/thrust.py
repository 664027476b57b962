"""The thrusters of a simulated vehicle: their drives, and the thrust and power that follow."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log

from auv_vessel.sheet import Sheet, Thruster

_LAG = 0.15  # seconds
_LIKE_A_PROPELLER = 1.5  # power by thrust, of an ideal propeller at rest


def watts_of(thruster: Thruster, thrust: float) -> float:
    """Return what a thruster draws at a thrust, newtons; see `curve_of`."""
    return watts_by(curve_of(thruster), thrust)


def watts_by(curve: tuple[float, float, float], thrust: float) -> float:
    """Return what a thruster of this curve draws at a thrust, newtons; see `curve_of`."""
    watts, newtons, exponent = curve
    drawn: float = watts * (abs(thrust) / newtons) ** exponent
    return drawn


def curve_of(thruster: Thruster) -> tuple[float, float, float]:
    """Return watts, newtons and exponent of what a thruster draws: watts * (thrust / newtons) ** exponent.

    The curve is the power law through operating and peak thrust as its type states them; through the former,
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


OFF, RUNS, WATCHDOG, FAULT = "OFF", "RUNS", "WATCHDOG", "FAULT"

MOST_AHEAD = 127
"""Largest step of the counter from one valid command to the next."""

_SOON = 1e-9  # seconds by which sums of periods may be off


class Drive:
    """What stands between commands and a thruster's motor.

    A command is valid if its check is right, which who decodes it sees to, and its counter is 1 to
    `MOST_AHEAD` ahead of the last one, modulo 256. Only valid commands are obeyed and keep the watchdog
    quiet. The first command of all, and the first after the watchdog stopped the thruster, are not obeyed:
    they only set the counter. So a sender that repeats one frame without end does nothing.

    Attributes:
        thrust: newtons that it puts out.
        state: one of `OFF`, `RUNS`, `WATCHDOG` and `FAULT`.
        dead: whether the motor has failed. May be set.
        stopped: whether an emergency stopped it, which nothing undoes.
    """

    def __init__(self, thruster: Thruster, watchdog: float) -> None:
        self.thrust = 0.0
        self.state = OFF
        self.dead = False
        self.stopped = False
        self._most = thruster.max_thrust
        self._watchdog = watchdog
        self._counter: int | None = None
        self._received: float | None = None
        self._wanted: float | None = None

    def command(self, thrust: float, enable: bool, counter: int, now: float) -> bool:
        """Take a command with a right check; return whether it was valid."""
        self.run(now)
        ahead = 0 if self._counter is None else (counter - self._counter) % 256
        valid = 1 <= ahead <= MOST_AHEAD
        if valid or self._received is None:
            self._counter = counter
        if not valid:
            return False
        self._received = now
        self._wanted = max(-self._most, min(self._most, thrust)) if enable else None
        self.run(now)
        return True

    def stop(self) -> None:
        """Stop the thruster for good."""
        self.stopped = True
        self.run(None)

    def run(self, now: float | None) -> None:
        """Do what is due at that time, seconds; None: what does not depend on it."""
        if now is not None and self._received is not None and now - self._received >= self._watchdog - _SOON:
            self._received, self._wanted, self._counter, self.state = None, None, None, WATCHDOG
        if self.dead:
            self.state = FAULT
        elif self.stopped:
            self.state = OFF
        elif self._received is not None:
            self.state = OFF if self._wanted is None else RUNS
        elif self.state != WATCHDOG:
            self.state = OFF
        self.thrust = self._wanted or 0.0 if self.state == RUNS else 0.0
