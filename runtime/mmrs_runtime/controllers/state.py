"""What is known of a robot, as its vehicle tells it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .. import vehicle
from ..records.blackbox import plain
from .vocabulary import Local, Place


@dataclass(frozen=True, slots=True)
class State:
    """A robot's own state, with which conditions are asked.

    Attributes:
        time: seconds of the run. place: position. speed: metres per second.
        heading: degrees clockwise from north. energy: fraction of the battery that is left, 0 to 1, or
            None where the vehicle does not report it.
        wind: metres per second; wind_from: degrees clockwise from north; None where unknown.
        detected: names of the vehicle's detections so far. places: their positions, as far as known.
        found: names of detections of it, or of a robot that has notified it since.
        answers: answers of the operator, by question, that no choice has used up.
        mode: in the runtime's words (``guided``, ``auto``, ``hold``, ``land`` …) or, where it has none
            for it, the vehicle's number. armed: whether the vehicle is armed.
    """

    time: float
    place: Place
    speed: float
    heading: float
    energy: float | None
    mode: str = ""
    armed: bool = False
    wind: float | None = None
    wind_from: float | None = None
    detected: frozenset[str] = frozenset()
    places: Mapping[str, Place] = field(default_factory=dict)
    found: frozenset[str] = frozenset()
    answers: Mapping[str, bool] = field(default_factory=dict)

    @property
    def charge(self) -> float | None:
        """Return the part of the battery that is left, as the standard conditions call it."""
        return self.energy


def status_of(state: State) -> dict[str, object]:
    """Return a vehicle's status, as JSON has it."""
    found = {
        "mode": state.mode,
        "armed": state.armed,
        "energy": state.energy,
        "place": state.place,
        "speed": round(state.speed, 2),
    }
    return {name: plain(value) for name, value in found.items()}


@dataclass(frozen=True, slots=True)
class KnownState(vehicle.VehicleState):
    """What the engine knows of a robot; `own`: its vehicle's state, if it has one."""

    own: State | None = None


def in_words(state: vehicle.VehicleState) -> State:
    """Return what is known of a robot in the words of controllers, which its vehicle need not use itself."""
    if isinstance(state, KnownState) and state.own is not None:
        return state.own
    east, north, up = state.position
    place, detected = Local(north, east, up), state.detected
    return State(
        state.time, place, state.speed, state.heading, state.charge, wind=state.wind, detected=detected
    )
