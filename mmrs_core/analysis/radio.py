"""The range of radios: robots stay in reach of their home, or of relays from which a chain leads there.

Two radios reach each other where their distance is at most the smaller of both ranges; that of the control
station at a robot's home is the robot's own. So a robot is in range in balls about its home and about the
relays with a chain; robots that are relays count while they certainly are (see `relay_robots`). How far it is
inside of one ball is concave along a straight leg, so that the least of the largest over all balls lies at an
end of the leg, or where another ball takes the lead.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import dist

import numpy as np

from mmrs_core.analysis.distance import Floats
from mmrs_core.analysis.figures import MissingFigureError, home_of, type_of
from mmrs_core.analysis.motion import MovePath, motions
from mmrs_core.analysis.relay_robots import certain_stands, stands_of
from mmrs_core.analysis.stations import Station, stations_of
from mmrs_core.analysis.verdicts import TOLERANCE, Margin, for_each_robot, judged
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Position
from mmrs_core.scene.attributes import number
from mmrs_core.scene.relays import Relay, relays_of

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
    radio = _Radio(input, robot, reach, relays)
    stations, left_out = stations_of(home_of(robot), reach, relays)
    worst: dict[int, Margin] = {}
    motion = motions(input)[robot.id]
    for leg in motion.paths:
        found = radio.margin(leg, stations)
        if leg.move not in worst or found.value < worst[leg.move].value:
            worst[leg.move] = found
    caveat = "; ".join(f"relay '{relay.name}' is left out: {why}" for relay, why in left_out)
    for verdict in judged(RANGE_NAME, robot, "m", worst.values(), motion.gaps):
        yield replace(verdict, caveat=caveat)


@dataclass(frozen=True, slots=True)
class _Radio:
    """What a robot's radio reaches, within `reach` metres, over relays of the context and other robots."""

    input: CheckInput
    robot: RobotProgram
    reach: float
    relays: Sequence[Relay]

    def margin(self, leg: MovePath, stations: Sequence[Station]) -> Margin:
        """Return how far a path is inside of what is reached at least.

        Where it is outside of what home and the relays of the context reach, the robots count that certainly
        are relays during the move, and where it ends those that are during the wait after it.
        """
        found = self._over(leg, stations)
        if found.value >= -TOLERANCE or all(
            stand.after[0] == self.robot.id for stand in stands_of(self.input)
        ):
            return found
        found = self._during(leg, waiting=False)
        end = replace(leg, points=leg.points[-1:])
        if leg.move != self.robot.stop and self._over(end, stations).value < -TOLERANCE:
            found = min(found, self._during(end, waiting=True), key=lambda each: each.value)
        return found

    def _during(self, leg: MovePath, *, waiting: bool) -> Margin:
        certain = certain_stands(self.input, self.robot, leg.move, waiting=waiting)
        found = self._over(leg, self._stations(certain))
        if found.value >= -TOLERANCE:
            return found
        others = [each.relay for each in stands_of(self.input) if each.after[0] != self.robot.id]
        doubtful = {each.name for each in others} - {each.name for each in certain}
        if not doubtful or self._over(leg, self._stations(others)).value < -TOLERANCE:
            return found
        alone = {
            each.name
            for each in others
            if self._over(leg, self._stations([*certain, each])).value >= -TOLERANCE
        }
        names = [f"'{name}'" for name in sorted(doubtful & alone or doubtful)]
        when = "during the wait after it" if waiting else "throughout"
        are = " or ".join(names) + " is a relay" if alone else " and ".join(names) + " are relays"
        words = f"it is not certain that {are} {when}"
        return replace(found, message=f"{found.message}; {words}")

    def _stations(self, robots: Sequence[Relay]) -> list[Station]:
        return stations_of(home_of(self.robot), self.reach, (*self.relays, *robots))[0]

    def _over(self, leg: MovePath, stations: Sequence[Station]) -> Margin:
        move, unsure = self.robot.moves[leg.move], leg.radius + self.input.program.position_error
        inside, place, station = least_inside(leg.points, stations)
        away, limit = lengths(dist(place, station.centre) + unsure, station.radius)
        placed = bool(self.relays) or len(stations) > 1
        there = " at ({:.1f}, {:.1f}, {:.1f})".format(*place) if placed else ""
        words = (
            f"{move.kind} '{move.id}' leads {away} away from {station.words}{there},"
            f" the radio reaches {limit}"
        )
        return Margin(inside - unsure, leg.move, words)


RANGE = Check(
    name=RANGE_NAME,
    title="Robots stay in range of their radio: of their home, or of relays with a chain to it.",
    run=for_each_robot(RANGE_NAME, _judge),
    hint="move the home nearer, place a relay, or choose a robot with a larger communicationRange",
)
