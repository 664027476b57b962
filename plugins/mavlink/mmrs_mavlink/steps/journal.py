"""What a robot writes down while it works, always with the move that it is at."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mmrs_runtime.orders.orders import Receipt

from ..desk import Desk
from ..program import Robot
from ..vehicles.vehicle import Vehicle
from .resuming import progress_of


class Journal:
    """Writes one robot's log and black box.

    Attributes:
        progress: where the robot is in its program.
        reported: what it has reported last: `name` and `content`; empty before it has.
        response: what it does instead of its program, a literal of PolicyResponse or NOTHING; else empty.
    """

    def __init__(self, robot: Robot, vehicle: Vehicle, desk: Desk) -> None:
        """Begin where the log ends.

        Raises:
            Refused: the log is of another program.
        """
        self.progress = progress_of(robot, desk.log.steps)
        self.reported: Mapping[str, object] = {}
        self.response = ""
        self._steps = {step.move: step for step in robot.steps}
        self._vehicle = vehicle
        self._desk = desk

    @property
    def move(self) -> str:
        """Return the move that the robot is at."""
        return self.progress.move

    def write(self, label: str, detail: str = "", slot: str = "", lamport: int | None = None) -> None:
        """Log a step; `lamport` None: the next logical time.

        Raises:
            Fault: it cannot be written.
        """
        logical = self._desk.slots.tick() if lamport is None else lamport
        now = self._desk.clock.now()
        self._desk.log.write(label, self.move, lamport=logical, time=now, detail=detail, slot=slot)
        self.progress = self.progress.then(label, detail, self._steps[self.move])

    def fail(self, event: str) -> None:
        """Log that the program has ended before its end.

        Raises:
            Fault: it cannot be written.
        """
        self.write("fault", event)

    def record(self, what: str, name: str, content: Mapping[str, object]) -> None:
        """Keep something in the black box, with place and move; `what` is ``reported`` or ``measured``."""
        if what == "reported":
            self.reported = {"name": name, "content": dict(content)}
        place = self._vehicle.state().place
        self._desk.box.write(what, name=name, content=dict(content), move=self.move, place=place)

    def ordered(self, receipt: Receipt) -> None:
        """Keep in the black box what was ordered, whether the robot has obeyed, and when."""
        self._desk.box.write("order", **receipt.told)

    def waited(self, slots: Sequence[str], seconds: float) -> None:
        """Keep in the black box for how long the robot has waited for own slots."""
        self._desk.box.write("wait", slots=slots, seconds=round(seconds, 3), move=self.move)

    def decide(self, what: str, why: str, response: str) -> None:
        """Keep in the black box what was decided: an event, its reason, and what the robot does."""
        self._desk.box.write("decision", what=what, why=why, response=response, move=self.move)
