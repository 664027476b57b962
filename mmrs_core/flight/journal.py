"""What a robot writes down while it works, always with the move that it is at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict

from .desk import Desk
from .program import Robot
from .vehicle import Vehicle


class Journal:
    """Writes one robot's log and records.

    Attributes:
        move: the move that the robot is at.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle, desk: Desk) -> None:
        """Begin at the first move."""
        self.move = robot.start
        self._robot = robot
        self._vehicle = vehicle
        self._desk = desk

    def write(self, label: str, detail: str = "", slot: str = "", lamport: int | None = None) -> None:
        """Log a step; `lamport` None: the next logical time.

        Raises:
            Fault: it cannot be written.
        """
        logical = self._desk.slots.tick() if lamport is None else lamport
        now = self._desk.clock.now()
        self._desk.log.write(label, self.move, lamport=logical, time=now, detail=detail, slot=slot)

    def fail(self, event: str) -> None:
        """Log that the program has ended before its end.

        Raises:
            Fault: it cannot be written.
        """
        self.write("fault", event)

    def record(self, what: str, name: str, content: Mapping[str, object]) -> None:
        """Keep something in the records, with time, place and move.

        Raises:
            Fault: it cannot be written.
        """
        state = self._vehicle.state()
        self._desk.records.add(
            robot=self._robot.id,
            time=round(state.time, 3),
            place=asdict(state.place),
            move=self.move,
            what=what,
            name=name,
            content=dict(content),
        )
