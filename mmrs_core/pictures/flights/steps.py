"""Where robots were at each of their steps."""

from __future__ import annotations

from dataclasses import dataclass

from mmrs_core.behaviour.program import Program
from mmrs_core.pictures.flights.places import Place, Places
from mmrs_core.pictures.flights.values import Flight
from mmrs_runtime.records.steps import merge


@dataclass(frozen=True, slots=True)
class PlacedStep:
    """A step of a log. Attributes: `words` say which one; `where` is None where nobody knows."""

    robot: str
    seq: int
    time: float
    words: str
    where: Place | None


def steps_of(flight: Flight, program: Program) -> tuple[PlacedStep, ...]:
    """Return the steps of all robots in one order in which they may have happened, each with its place."""
    places = Places(program.frame)
    placed = []
    for record in merge(record for flown in flight.robots.values() for record in flown.records):
        at = flight.robots[record.robot].track.at(record.time)
        words = " ".join(each for each in (record.label, record.move, record.detail, record.slot) if each)
        where = places.of(at) if at is not None else None
        placed.append(PlacedStep(record.robot, record.seq, record.time, words, where))
    return tuple(placed)
