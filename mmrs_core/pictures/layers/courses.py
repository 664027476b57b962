"""The layers of a plan or a flight: where each robot went when, what it did there, and what happened."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from math import dist

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.registry import Contributions
from mmrs_core.drawings.drawing import LeftOut, Property, Role
from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.flights.fixes import datum_of
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.photos import acts_of, shots_in, takes_photo
from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.flights.tracks import timed_pieces
from mmrs_core.pictures.layers.chart import Chart, Drawn
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.pictures.layers.places import colour_of
from mmrs_core.pictures.preview.from_run import handovers_of, track_of
from mmrs_core.pictures.report.events import events_of, readings_of
from mmrs_core.scene import Position, RobotType
from mmrs_core.simulation.run import SimulatedRun

_STAYING = 0.01
"""Metres that a robot may drift and still stays where it is."""


def flight_as_planned(program: Program, run: SimulatedRun) -> Flight:
    """Return a simulated run of a behaviour as the flight that it would be."""
    flown = {
        robot.id: Flown(
            robot.id,
            tuple(record for record in run.records if record.robot == robot.id),
            track_of(run.tracks.get(robot.id, ())),
            simulated=True,
        )
        for robot in program.robots
    }
    return Flight("", flown)


@dataclass(frozen=True, slots=True)
class Courses:
    """Draws what robots did, or are to do.

    Attributes:
        chart: where and when that is.
        program: what they did it by.
        types: of the robots, by name, as far as they are known.
        contributed: what tells photos from other actions.
    """

    chart: Chart
    program: Program
    types: Mapping[str, RobotType]
    contributed: Contributions

    def lines(self, flight: Flight, layer: Layer) -> Iterator[Drawn]:
        """Yield the path or track of each robot, in pieces between gaps."""
        role = Role.PATH if layer is Layer.PATHS else Role.TRACK
        for robot in self.program.robots:
            pieces = timed_pieces(flight.robots[robot.id].track)
            moved = [sum(dist(a, b) for a, b in pairwise(points.tolist())) for _, points in pieces]
            if not pieces:
                yield layer, LeftOut(f"{role} of '{robot.id}'", "is unknown: there is no black box of it")
            elif sum(moved) < _STAYING:
                yield layer, LeftOut(f"{role} of '{robot.id}'", "stays where it is")
                continue
            for (times, points), metres in zip(pieces, moved, strict=True):
                yield replace(
                    self.chart.line(points, times),
                    name=robot.id,
                    description=f"{role} of {robot.id}",
                    role=role,
                    folders=(layer,),
                    properties={
                        "robot": robot.id,
                        "type": robot.type_name,
                        "beginSeconds": round(float(times[0]), 3),
                        "endSeconds": round(float(times[-1]), 3),
                        "length": round(metres, 2),
                    },
                    colour=self._colours[robot.id],
                )

    def points(self, flight: Flight) -> Iterator[Drawn]:
        """Yield where photos were taken and other actions done, what was measured, and what happened."""
        shots = shots_in(self.program, flight, self.types, self.contributed)
        vehicles = tuple(self.contributed.vehicles.values())
        for robot in self.program.robots:
            flown, robot_type = flight.robots[robot.id], self.types.get(robot.type_name)
            for number, shot in enumerate(shots[robot.id], start=1):
                action = shot.action
                more: dict[str, Property] = {"state": shot.state, "move": shot.move, "task": shot.task}
                if action is not None:
                    more |= {"device": action.device, "action": action.name}
                if shot.index is not None:
                    more["index"] = shot.index
                name = f"{robot.id} {number}"
                yield self._point(Layer.PHOTOS, Role.PHOTO, robot.id, name, shot.at, shot.time, more)
            for time, move, action in acts_of(robot, flown):
                if not takes_photo(action, robot_type, vehicles):
                    more = {"move": move.id, "task": move.task, "device": action.device}
                    more["action"] = action.name
                    more |= {f"parameters.{key}": value for key, value in action.parameters}
                    name, at = action.name or action.metaclasses[0][1], flown.track.at(time)
                    yield self._point(Layer.ACTIONS, Role.ACTION, robot.id, name, at, time, more)
            yield from self._measured(robot, flown)
            for event in events_of(flown):
                more = {"kind": event.kind, "why": event.why}
                at = flown.track.at(event.time)
                yield self._point(Layer.EVENTS, Role.EVENT, robot.id, event.what, at, event.time, more)
        yield from self._waits(flight)

    def _measured(self, robot: RobotProgram, flown: Flown) -> Iterator[Drawn]:
        robot_type = self.types.get(robot.type_name)
        datum = datum_of(robot, self.program, robot_type, flown.vehicle, self.contributed.robot_kinds)
        for reading in readings_of(flown, datum, Locator(self.chart.frame).of):
            at = reading.where.position if reading.where is not None else None
            more: dict[str, Property] = {"kind": reading.kind, "content": reading.content}
            name = reading.name
            yield self._point(Layer.MEASUREMENTS, Role.ACTION, robot.id, name, at, reading.time, more)

    def _waits(self, flight: Flight) -> Iterator[Drawn]:
        records = {robot: flown.records for robot, flown in flight.robots.items()}
        for each in handovers_of(self.program, records):
            if each.released > each.since:
                at = flight.robots[each.receiver].track.at(each.since)
                name = f"{each.receiver} waits for {each.sender}"
                more: dict[str, Property] = {"for": each.sender, "task": each.note}
                more["wait"] = round(each.released - each.since, 3)
                yield self._point(Layer.WAITS, Role.EVENT, each.receiver, name, at, each.since, more)

    def _point(
        self,
        layer: Layer,
        role: Role,
        robot: str,
        name: str,
        at: Position | None,
        time: float,
        more: Mapping[str, Property],
    ) -> Drawn:
        """Return something that a robot did or met; `more` without what is empty."""
        if at is None:
            what = f"{role} '{name}' of '{robot}' at {clock(time)}"
            return layer, LeftOut(what, "its position is unknown")
        known = {key: value for key, value in more.items() if value != ""}
        return replace(
            self.chart.point(at, time),
            name=name,
            role=role,
            folders=(layer,),
            properties={"robot": robot, "seconds": round(time, 3), **known},
            colour=self._colours[robot],
        )

    @property
    def _colours(self) -> dict[str, str]:
        return {robot.id: colour_of(index) for index, robot in enumerate(self.program.robots)}
