"""What orders of a program are to the vehicle that carries them out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from auv_vessel.decision.duties import Duty
from auv_vessel.sheet import Vector
from mmrs_runtime.policies import Policy
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Fault, Position

NO_WAY = "unknown path to where its program was interrupted"


class NoWayError(Exception):
    """No clear path is known."""


@dataclass(frozen=True, slots=True)
class Waters:
    """The frame of a program, and the world of a vehicle: north, east and down from the surface, metres.

    Attributes:
        surface: height of the water surface above the frame's origin.
        north, east: where the origin is.
    """

    surface: float = 0.0
    north: float = 0.0
    east: float = 0.0

    def below(self, position: Position) -> Vector:
        """Return metres north, east and below the surface."""
        east, north, up = position
        return (north + self.north, east + self.east, self.surface - up)

    def above(self, place: Vector) -> Position:
        """Return metres east, north and up of the origin."""
        north, east, depth = place
        return (east - self.east, north - self.north, self.surface - depth)


class Orders(Protocol):
    """What the orders of one robot's program are to its vehicle, and the ways that the robot knows.

    All places are metres north, east and below the surface.

    Attributes:
        policies: what is to be done when something goes wrong, the first that fits.
        reserve: part of the battery that must be left.
        waters: the frame of the program.
        home: where the program begins.
    """

    policies: Sequence[Policy]
    reserve: float
    waters: Waters
    home: Vector

    def duty(self, order: object, here: Vector, *, through: bool) -> Duty | Fault:
        """Return what a movement or an action is; a fault where no device does it.

        Args:
            order: of the program.
            here: where the vehicle is.
            through: it need not stop at the end of a movement.
        """
        ...

    def reports(self, order: object) -> Mapping[str, object] | None:
        """Return what an action reports, with its `name`; None: it does not report."""
        ...

    def learn(self, name: str, place: Vector) -> None:
        """Take note of where another robot has detected an object."""
        ...

    def escape(self, response: str, here: Vector) -> Duty:
        """Return the way that RETURN or EMERGENCY_AREA leads from where the vehicle is."""
        ...

    def back(self, passed: Sequence[str], begun: str, here: Vector) -> Duty:
        """Return the path to where the last of the moves ended that the robot has passed.

        Raises:
            NoWayError: no path is known.
        """
        ...


def notes_in(box: BlackBox | None) -> Callable[[str, Mapping[str, object]], None]:
    """Return what notes things in a black box, where there is one."""

    def note(kind: str, content: Mapping[str, object]) -> None:
        if box is not None:
            box.write(kind, **content)

    return note
