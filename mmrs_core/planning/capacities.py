"""How much work a robot can do by a time at most: a short look, before it is found out how much it can do.

It is taken to go straight to the nearest portion, and straight home from the nearest one. Launch, climb,
landing and stops count as on its routes to the first portion, and from the first and the last. Were that
ever too little, shares would be found that end later than they need, but none that a robot cannot do.
"""

from __future__ import annotations

from math import inf

from mmrs_core.planning.materials import Material
from mmrs_core.planning.sorties import Pilot
from mmrs_core.planning.states import Ready, State


class Capacity:
    """The seconds of work of a material that a robot in some state can do by when."""

    def __init__(self, pilot: Pilot, material: Material, state: State, ready: Ready) -> None:
        """Find out when it can begin, and how long it takes home.

        Args:
            pilot: of the robot.
            material: for that robot.
            state: of the robot before.
            ready: what the work waits for.
        """
        cruise = pilot.kinematics.cruise
        out = pilot.slower_out(state, material.approach(0))
        out += material.metres_to(state.at) / max(cruise, material.fastest)
        self._begin = max(state.time + out, ready.time, ready.earliest or 0.0)
        self._home = 0.0
        if pilot.robot.return_home:
            ends = material.last(0), material.last(len(material) - 1)
            self._home = min(map(pilot.slower_home, ends))
            self._home += material.metres_from(pilot.robot.home) / cruise
        self._left, self._charge = max(0.0, pilot.charge - state.used), pilot.charge
        recharge = pilot.kinematics.recharge
        self._recharge = inf if recharge is None else recharge + self._home

    def until(self, time: float) -> float:
        """Return the seconds of work that it can do at most and be back by a time."""
        whole = max(0.0, time - self._begin - self._home)
        if whole <= self._left or whole == inf:
            return whole if self._recharge < inf else min(whole, self._left)
        if self._recharge == inf:
            return self._left
        sorties, rest = divmod(whole - self._left, self._recharge + self._charge)
        return self._left + sorties * self._charge + max(0.0, rest - self._recharge)
