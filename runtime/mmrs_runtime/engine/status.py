"""Status of the robots of a run, for queries while it is in progress."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING

from ..faults import LINK_LOST
from ..policies import NOTHING

if TYPE_CHECKING:
    from ..vehicle import Vehicle
    from .life import Life


WAITS = "waits for its vehicle"
HELD_EARLY = "is held before it begins"
WORKS = "works"
HELD = "is held"
RESPONDS = "responds"
TAKEN = "under external control"
SUSPENDED = "waits for its battery"
LOST = "has ended by a lost link"
ENDED = "has ended"


def if_held(phase: str) -> str:
    """Return the phase of a robot that is held, or is to be, given what it would be at otherwise."""
    return {WAITS: HELD_EARLY, WORKS: HELD}.get(phase, phase)


def answering(response: str) -> dict[str, object]:
    """Return the status of a robot that carries out a response, as JSON has it."""
    return {"phase": TAKEN} if response == NOTHING else {"phase": RESPONDS, "response": response}


class StatusBoard:
    """Knows how robots are; any thread may ask.

    Attributes:
        held: robots that are to be held as soon as they could begin.
    """

    def __init__(self) -> None:
        """Create without robots."""
        self.held: Collection[str] = ()
        self._vehicles: Mapping[str, Vehicle] | None = None
        self._robots: Mapping[str, Life] = {}

    def connect(self, vehicles: Mapping[str, Vehicle]) -> None:
        """Take the vehicles of all robots that have something left to do."""
        self._vehicles = dict(vehicles)

    def begin(self, robots: Iterable[Life]) -> None:
        """Take the robots that now begin."""
        self._robots = {robot.id: robot for robot in robots}

    def status(self, robot: str) -> Mapping[str, object]:
        """Return a robot's status, as JSON has it."""
        life = self._robots.get(robot)
        vehicle = (self._vehicles or {}).get(robot)
        phase = self._phase(robot, life)
        held = life.held if life is not None else robot in self.held
        found: dict[str, object] = {"phase": if_held(phase) if held else phase}
        if life is not None:
            found |= _at(life)
        if vehicle is not None:
            found |= vehicle.status()
        if life is not None and _responds(life, armed=found.get("armed") is True):
            found |= answering(life.halt.response)
        if life is not None and life.questions.asked:
            found["asks"] = life.questions.asked
        if vehicle is not None and vehicle.reported:
            found["reported"] = vehicle.reported
        return found

    def _phase(self, robot: str, life: Life | None) -> str:
        if life is None:
            return WAITS if self._vehicles is None or robot in self._vehicles else ENDED
        if life.is_preparing:
            return WAITS
        if life.point.is_final or life.is_absent:
            return LOST if life.halt.is_for(LINK_LOST) else ENDED
        return SUSPENDED if life.suspended else WORKS


def _at(life: Life) -> Mapping[str, object]:
    """Return which step a robot has made last, and when, if it has made any."""
    if (last := life.last) is None:
        return {"move": life.point.move}
    return {"move": last.move, "step": last.label, "time": last.time}


def _responds(life: Life, *, armed: bool) -> bool:
    """Return whether a robot does, or is held by, what has broken its program off."""
    halt = life.halt
    lost = halt.is_for(LINK_LOST) and not halt.stopping
    answers = halt.fault is not None and not life.is_absent and not lost
    return answers and (halt.stopping or armed)
