"""Backends as vehicles of the engine: those that are asked again and again how they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mmrs_core.behaviour.program import Action, Move
from mmrs_core.contributions.abilities import (
    Bearing,
    Closing,
    Doubting,
    Learning,
    Noting,
    Pausable,
    Preparing,
    Recognising,
    Recovering,
    Telling,
    Watched,
)
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.execution import RobotState
from mmrs_core.errors import InternalError
from mmrs_core.scene import Position
from mmrs_runtime.vehicle import Vehicle


def vehicle_of(made: Backend | Vehicle) -> Vehicle:
    """Return what a factory has made as a vehicle."""
    return made if isinstance(made, Vehicle) else PolledVehicle(made)


class PolledVehicle(Vehicle):
    """A backend, and which abilities it has."""

    def __init__(self, backend: Backend) -> None:
        """Ask this backend."""
        self.backend = backend
        self._bears = False

    def do(self, order: object, now: float, *, through: bool = False) -> None:
        """Begin a movement or an action."""
        self.done, self.trouble = False, None
        if isinstance(order, Move):
            self.backend.begin(order, now, through=through)
        elif isinstance(order, Action):
            self.backend.act(order, now)
        else:
            raise InternalError(f"{order!r}: neither a move nor an action")

    def respond(self, response: str, now: float) -> None:
        """Carry out a response."""
        self.done, self.trouble = False, None
        self.backend.stop(now, response)

    def state(self, now: float) -> RobotState:
        """Return what is known of the robot."""
        return self.backend.state(now)

    def look(self, now: float) -> float:
        """Ask for faults, and then whether it has finished."""
        self.trouble = self.backend.fault(now)
        self.done = (self.trouble is None or self._bears) and self.backend.finished(now)
        self._bears = False
        event = self.backend.next_event(now)
        return now if event is None else event

    def wait(self, now: float) -> None:
        """Hold the pose."""
        self.backend.wait(now)

    def bear(self, now: float) -> bool:
        """Go on in spite of a fault, if the backend can."""
        self._bears = not isinstance(self.backend, Bearing) or self.backend.bear(now)
        return self._bears

    def prepare(self, now: float) -> bool:
        """Begin to get ready, if that takes any time."""
        if not isinstance(self.backend, Preparing):
            return False
        self.done, self.trouble = False, None
        self.backend.prepare(now)
        return True

    def known(self, now: float) -> bool:
        """Return whether it is known to be the robot's."""
        return isinstance(self.backend, Recognising) and self.backend.known(now)

    def recover(self, passed: Sequence[str], begun: str, now: float) -> bool:
        """Begin to bring the robot back, if the backend knows how."""
        if not isinstance(self.backend, Recovering):
            return False
        self.done, self.trouble = False, None
        self.backend.recover(passed, begun, now)
        return True

    def hindrance(self, passed: Sequence[str], begun: str, now: float) -> str:
        """Return why the robot could not be brought back now, or nothing."""
        return self.backend.hindrance(passed, begun, now) if isinstance(self.backend, Recovering) else ""

    @property
    def comes_home(self) -> bool:
        """Return whether the backend knows the way back."""
        return isinstance(self.backend, Recovering)

    def away(self, now: float) -> str:
        """Return why the robot does not stand at home, or nothing."""
        return self.backend.away(now) if isinstance(self.backend, Recovering) else ""

    def moves(self, now: float) -> bool:
        """Return whether the robot was seen to be under way."""
        return isinstance(self.backend, Recovering) and self.backend.moves(now)

    @property
    def pauses(self) -> bool:
        """Return whether it can halt in the middle of anything."""
        return isinstance(self.backend, Pausable)

    def pause(self, now: float) -> None:
        """Begin to halt."""
        if isinstance(self.backend, Pausable):
            self.backend.pause(now)

    def resume(self, now: float) -> None:
        """Go on."""
        if isinstance(self.backend, Pausable):
            self.backend.resume(now)

    def paused(self, now: float) -> bool:
        """Return whether it halts."""
        return isinstance(self.backend, Pausable) and self.backend.paused(now)

    def obeys(self, now: float) -> bool:
        """Return whether it has confirmed the response."""
        return isinstance(self.backend, Watched) and self.backend.obeys(now)

    def watched(self, now: float) -> bool:
        """Return whether somebody must stay with it."""
        return isinstance(self.backend, Watched) and self.backend.watched(now)

    def undone(self, now: float) -> str:
        """Return why the response is not carried out, or nothing."""
        return self.backend.undone(now) if isinstance(self.backend, Watched) else ""

    def reachable(self, now: float) -> bool:
        """Return whether it was heard of lately."""
        return not isinstance(self.backend, Watched) or self.backend.reachable(now)

    def in_doubt(self, now: float) -> bool:
        """Return whether it is being found out who has it."""
        return isinstance(self.backend, Doubting) and self.backend.in_doubt(now)

    def told(self) -> Mapping[str, object]:
        """Return what the robot has told last."""
        return self.backend.told() if isinstance(self.backend, Telling) else {}

    def note(self, kind: str, content: Mapping[str, object]) -> None:
        """Keep something in the black box, if there is one."""
        if isinstance(self.backend, Noting):
            self.backend.note(kind, content)

    def learn(self, places: Mapping[str, Position]) -> None:
        """Take note of where others have detected things."""
        if isinstance(self.backend, Learning):
            self.backend.learn(places)

    def close(self) -> None:
        """Release what it holds."""
        if isinstance(self.backend, Closing):
            self.backend.close()
