"""The batteries of a simulated robot: what is left, when they are low, when they are empty.

What they hold is counted in seconds at mean power, since a type may tell its lifetime and not the
energy of its batteries.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from math import inf

from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Kinematics, Policy, Position
from mmrs_core.simulation.escape import Escapes
from mmrs_core.simulation.legs import Flow, TimedLeg, response_stretches
from mmrs_runtime.policies import response_to

SLACK = 1e-6
"""Seconds, and seconds at mean power, that rounding may cost."""

ROUNDING = 5e-7
"""Part of a full charge that robots have beyond it, since planned times follow from rounded places."""

_STAYING = ("HOLD", "CONTINUE", "STOP_THRUST")


class SimulatedBattery:
    """All batteries of a robot together.

    Attributes:
        capacity: seconds at mean power when they are full, and a little for rounding; inf for a wired
            robot.
    """

    def __init__(self, kinematics: Kinematics, escapes: Escapes, policies: tuple[Policy, ...]) -> None:
        nominal = _capacity(kinematics)
        self._extra = nominal * ROUNDING if nominal < inf else 0.0
        self.capacity = nominal + self._extra
        self._kinematics, self._escapes = kinematics, escapes
        self._response = response_to("BATTERY_LOW", policies)
        self._needs = lru_cache(maxsize=4)(self._response_needs)  # looked at again and again at one place

    def energy(self, charge: float) -> float | None:
        """Return joules; inf for a wired robot, None where the type does not tell."""
        if charge == inf:
            return inf
        left = max(0.0, charge - self._extra)
        return left * self._kinematics.power if self._kinematics.power > 0.0 else None

    def fault(self, leg: TimedLeg, now: float, flow: Flow) -> Fault | None:
        """Return whether they are empty, or so low that what is left just suffices for the response."""
        if leg.rate <= 0.0 or leg.charge == inf:
            return None
        left = leg.charge_at(now)
        if left <= SLACK:
            return Fault("BATTERY_EMPTY", f"at {now:.0f} s")
        if self._to_spare(leg, now, flow) <= SLACK:
            return Fault("BATTERY_LOW", f"enough for {left:.0f} s")
        return None

    def events(self, leg: TimedLeg, now: float, flow: Flow) -> Iterator[float]:
        """Yield when in this leg they get low, and when they are empty."""
        if leg.rate <= 0.0 or leg.charge == inf:
            return
        early, late = max(leg.begin, now), min(leg.end, leg.empty_at)
        if leg.empty_at <= leg.end:
            yield leg.empty_at
        if late == inf or self._to_spare(leg, late, flow) > 0.0:
            return
        if early == now and self._to_spare(leg, now, flow) <= 0.0:
            return  # they have got low before
        to_spare = self._to_spare_in(leg, flow)
        while late - early > SLACK:
            middle = (early + late) / 2.0
            early, late = (middle, late) if to_spare(middle) > 0.0 else (early, middle)
        yield late

    def _to_spare_in(self, leg: TimedLeg, flow: Flow) -> Callable[[float], float]:
        """Return what gives `_to_spare` at any time of a leg, at little cost where the robot stays."""
        if leg.start != leg.finish:
            return lambda time: self._to_spare(leg, time, flow)
        needs = self._needs(leg.start, False, flow)
        return lambda time: leg.charge_at(time) - needs

    def _to_spare(self, leg: TimedLeg, time: float, flow: Flow) -> float:
        """Return the seconds left beyond what the response takes; inf where it takes none."""
        if self._response in _STAYING:
            return inf
        return leg.charge_at(time) - self._needs(leg.position(time), leg.start != leg.finish, flow)

    def _response_needs(self, here: Position, moving: bool, flow: Flow) -> float:
        path = self._escapes.straight(self._response, here)
        way = response_stretches(path, self._kinematics, flow, moving=moving)
        return sum([each.seconds * each.rate for each in way])


def _capacity(kinematics: Kinematics) -> float:
    if kinematics.endurance < inf:
        return kinematics.endurance
    return kinematics.energy / kinematics.power if kinematics.power > 0.0 else inf
