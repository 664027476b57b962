"""The range of radios: robots stay in reach of their home, or of relays from which a chain leads there.

Two radios reach each other where their distance is at most the smaller of both ranges; that of the control
station at a robot's home is the robot's own. So a robot is in range in balls about its home and about the
relays with a chain. How far it is inside of one ball is concave along a straight leg, so that the least of
the largest over all balls lies at an end of the leg, or where another ball takes the lead.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import dist

import numpy as np

from mmrs_core.analysis.distance import Floats
from mmrs_core.analysis.figures import MissingFigureError, home_of, type_of
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.stations import Station, stations_of
from mmrs_core.analysis.verdicts import Margin, for_each_robot, judged
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Position
from mmrs_core.scene.attributes import number
from mmrs_core.scene.relays import relays_of

RANGE_NAME = "range"

_HALVINGS = 60
"""Times that a stretch of a leg is halved to find where two balls are equal: to the last digit."""

_EQUAL = 1e-9
"""Metres by which one ball's lead over two equal ones is rounding."""


def least_inside(points: Sequence[Position], stations: Sequence[Station]) -> tuple[float, Position, Station]:
    """Return how far a polyline is inside of the balls at least, metres, where that is, and of which station.

    Where it is outside of all balls, the number is negative.
    """
    centres = np.array([station.centre for station in stations], dtype=np.float64)
    radii = np.array([station.radius for station in stations])
    line = np.array(points, dtype=np.float64)
    inside = radii - np.linalg.norm(line[:, None, :] - centres, axis=2)
    first = inside.argmax(axis=1)
    lowest = int(inside.max(axis=1).argmin())
    best = float(inside[lowest].max()), points[lowest], stations[int(first[lowest])]
    for k in np.flatnonzero(first[:-1] != first[1:]).tolist():
        leg = _Leg(line[k], line[k + 1], centres, radii)
        value, at, station = min(leg.passings(0.0, int(first[k]), 1.0, int(first[k + 1])))
        if value < best[0]:
            best = value, leg.point(at), stations[station]
    return best


@dataclass(frozen=True, slots=True)
class _Leg:
    begin: Floats
    end: Floats
    centres: Floats
    radii: Floats

    def passings(self, low: float, lead: int, high: float, then: int) -> Iterator[tuple[float, float, int]]:
        """Yield (metres inside, share of the leg, station) of each place where another ball takes the lead.

        Args:
            low: share of the leg where one leads.
            lead: its station.
            high: share where another leads.
            then: its station.
        """
        begin, end = low, high
        for _ in range(_HALVINGS):
            middle = (begin + end) / 2.0
            inside = self._inside(middle)
            begin, end = (middle, end) if inside[lead] >= inside[then] else (begin, middle)
        inside = self._inside(begin)
        ahead = int(inside.argmax())
        yield float(inside[ahead]), begin, ahead
        if inside[ahead] > max(inside[lead], inside[then]) + _EQUAL:
            yield from self.passings(low, lead, begin, ahead)
            yield from self.passings(begin, ahead, high, then)

    def _inside(self, share: float) -> Floats:
        place = self.begin + share * (self.end - self.begin)
        inside: Floats = self.radii - np.linalg.norm(self.centres - place, axis=1)
        return inside

    def point(self, share: float) -> Position:
        """Return a place along the leg."""
        east, north, up = (self.begin + share * (self.end - self.begin)).tolist()
        return east, north, up


def _judge(input: CheckInput, robot: RobotProgram) -> Iterator[Verdict]:
    reach = number(type_of(input, robot).part, "communicationRange")
    if reach is None:
        raise MissingFigureError(
            f"{robot.id}: the communicationRange of robot type '{robot.type_name}' is not given"
        )
    relays = relays_of(input.elements)
    stations, left_out = stations_of(home_of(robot), reach, relays)
    motion, error = motions(input)[robot.id], input.program.position_error
    worst: dict[int, Margin] = {}
    for leg in motion.paths:
        found = _margin(robot, leg, stations, error, placed=bool(relays))
        if leg.move not in worst or found.value < worst[leg.move].value:
            worst[leg.move] = found
    caveat = "; ".join(f"relay '{relay.name}' is left out: {why}" for relay, why in left_out)
    for verdict in judged(RANGE_NAME, robot, "m", worst.values(), motion.gaps):
        yield replace(verdict, caveat=caveat)


def _margin(
    robot: RobotProgram, leg: MovePath, stations: Sequence[Station], error: float, *, placed: bool
) -> Margin:
    move, unsure = robot.moves[leg.move], leg.radius + error
    inside, place, station = least_inside(leg.points, stations)
    away, limit = lengths(dist(place, station.centre) + unsure, station.radius)
    there = " at ({:.1f}, {:.1f}, {:.1f})".format(*place) if placed else ""
    words = (
        f"{move.kind} '{move.id}' leads {away} away from {station.words}{there}, the radio reaches {limit}"
    )
    return Margin(inside - unsure, leg.move, words)


RANGE = Check(
    name=RANGE_NAME,
    title="Robots stay in range of their radio: of their home, or of relays with a chain to it.",
    run=for_each_robot(RANGE_NAME, _judge),
    hint="move the home nearer, place a relay, or choose a robot with a larger communicationRange",
)
