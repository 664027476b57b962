"""Where a robot is, as its black box has it now and then."""

from __future__ import annotations

from ..records.blackbox import BlackBox
from .state import State
from .words import Place

FIX_SECONDS = 0.19
"""Least time between two fixes: five in a second, and a little for uneven sending."""


def fix(box: BlackBox, state: State, place: Place | None = None) -> None:
    """Write where a robot is; `place` where the state's is older."""
    box.write(
        "fix",
        place=place or state.place,
        speed=round(state.speed, 3),
        heading=round(state.heading, 2),
        energy=state.energy,
        mode=state.mode,
        armed=state.armed,
    )
