"""Conditions that choose a branch by the energy that a drone has left."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_core.contributions.execution import Condition, RobotState

KILOJOULES = (50, 100, 200, 500, 1000)
"""From a small camera drone's battery, about 200 kJ, up to a large hexacopter's, some 2000 kJ."""


def _more_than(joules: float) -> Callable[[RobotState], bool]:
    def holds(state: RobotState) -> bool:
        """Return whether more energy is left; raise ValueError where it is unknown."""
        if state.energy is None:
            raise ValueError("the energy that is left is not known")
        return state.energy > joules

    return holds


CONDITIONS = tuple(
    Condition(f"energy_above_{amount}_kJ", _more_than(1000.0 * amount)) for amount in KILOJOULES
)
