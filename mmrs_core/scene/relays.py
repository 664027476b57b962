"""The relays of a scene, which pass on the radio of its robots: those of its context, and robots."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from mmrs_core.scene.attributes import number, position, text
from mmrs_core.scene.primitives import Part, Position
from mmrs_core.scene.robots import RobotType
from mmrs_core.scene.works import Work

RELAY = ("urn:mmrs:context:1.0", "Relay")


@dataclass(frozen=True, slots=True)
class Relay:
    """A relay of the context, or a robot that stays somewhere as one.

    Attributes:
        name: its own, or else its path; that of the robot's task.
        position: of its antenna, (east, north, up), metres.
        range: of its radio, metres.
        spread: metres by which it may be elsewhere.
    """

    name: str
    position: Position
    range: float
    spread: float = 0.0


def relays_of(elements: Iterable[Part]) -> tuple[Relay, ...]:
    """Return the relays among the elements of a context, those of types that extend them included.

    Raises:
        InfeasibleError: one has no position.
    """
    return tuple(
        Relay(text(each, "name") or each.place.path, position(each, "position"), number(each, "range") or 0.0)
        for each in elements
        if each.is_a(RELAY)
    )


def relay_range(type: RobotType) -> float | None:
    """Return the range of the relay aboard robots of a type, metres; None where they carry none."""
    return number(type.part, "relayRange")


def radio_range(type: RobotType) -> float | None:
    """Return the range of the radio between robots of a type and home, metres; None where none is stated."""
    return number(type.part, "communicationRange")


def station_of(task: str, work: Work, type: RobotType, error: float) -> Relay | None:
    """Return the relay that a robot of a type is where a work ends; None where it is none.

    Args:
        task: that it is for.
        work: of that task.
        type: of the robot.
        error: of positions, metres.
    """
    range = relay_range(type) if work.relays else None
    return None if range is None else Relay(task, work.strokes[-1].points[-1], range, error)
