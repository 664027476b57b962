"""How often sightings with a score are right, as measured on pictures whose truth is known."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from auv_vessel.body.surroundings import BUOY, GATE, PATH

_SCORES: Final = (0.0, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)
_RIGHT: Final[Mapping[str, tuple[float, ...]]] = {
    BUOY: (0.05, 0.16, 0.3, 0.6, 0.75, 0.88, 0.92, 0.96, 0.99, 0.99),
    GATE: (0.2, 0.4, 0.5, 0.6, 0.75, 0.88, 0.95, 0.97, 0.98, 0.99),
    PATH: (0.2, 0.4, 0.5, 0.6, 0.75, 0.88, 0.95, 0.98, 0.99, 0.99),
}
"""Part of sightings that have the right name, and a place within 0.3 m or a tenth of the distance of the
true one; `benchmarks/auv_vision.py` measures it. Of gates and paths few have low scores: those are guesses
on the safe side."""


def confidence_of(kind: str, score: float) -> float:
    """Return how often a sighting of that kind with that score, from 0 to 1, is right."""
    return float(np.interp(score, _SCORES, _RIGHT[kind]))
