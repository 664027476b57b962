"""Makes the report of a flight from its logs, its black boxes and its plan."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import dist

import numpy as np

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.contributions.registry import Contributions
from mmrs_core.pictures.flights.fixes import Datum, datum_of
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.photos import shots_in
from mmrs_core.pictures.flights.planned import AWAY, Planned, PlannedLeg, legs_of
from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.flights.tracks import pieces
from mmrs_core.pictures.report.contents import (
    Approach,
    LinkReport,
    PhotoReport,
    Report,
    RobotReport,
    Separation,
)
from mmrs_core.pictures.report.deviations import deviation_of
from mmrs_core.pictures.report.distances import approaches_of, in_motion, separations_of
from mmrs_core.pictures.report.energies import energy_of
from mmrs_core.pictures.report.events import events_of, injected_by, readings_of, without_secrets
from mmrs_core.pictures.report.tasks import task_reports
from mmrs_core.pictures.report.visits import move_reports, wait_reports
from mmrs_core.pipeline import BehaviourContext
from mmrs_runtime.records.entries import number_of
from mmrs_runtime.semantics import Outcome

_SORT = re.compile(r"(udp|tcp|serial|simulation|can)", re.IGNORECASE)
_ACCEPTED = frozenset({"ACCEPTED", "IN_PROGRESS"})


@dataclass(frozen=True, slots=True)
class Given:
    """All that a report is made of."""

    program: Program
    place: BehaviourContext
    flight: Flight
    planned: Planned
    contributions: Contributions

    def legs(self) -> dict[str, tuple[PlannedLeg, ...]]:
        """Return the moves that each robot began, with their planned paths."""
        return {
            robot.id: legs_of(robot, flown, self.contributions.move_kinds)
            for robot in self.program.robots
            for flown in (self.flight.robots[robot.id],)
        }


def report_of(given: Given) -> Report:
    """Return the report of a flight."""
    program, flight, plan = given.program, given.flight, given.planned.run
    legs, places = given.legs(), Locator(program.frame)
    records = [record for flown in flight.robots.values() for record in flown.records]
    judged = replay(program, records, partial=True)
    robots = [flight.robots[robot.id] for robot in program.robots]
    deviations = (deviation_of(flown, legs[flown.robot], places.of) for flown in robots)
    links = (link_of(flown) for flown in robots)
    return Report(
        title=program.name,
        run=flight.run,
        begun=flight.begun,
        duration=max((flown.end for flown in robots), default=0.0),
        simulated=any(flown.simulated for flown in robots),
        outcome=judged.outcome.value if flight.whole else Outcome.INCOMPLETE.value,
        complaints=tuple(map(str, judged.complaints)) if flight.whole else (),
        injected=tuple(
            dict.fromkeys(injected_by(entry) for flown in robots for entry in flown.of_kind("injected"))
        ),
        robots=tuple(_robot(robot, given, judged) for robot in program.robots),
        tasks=task_reports(program, flight, plan, legs),
        deviations=tuple(each for each in deviations if each is not None),
        moves=move_reports(program, flight, plan),
        waits=wait_reports(program, flight, plan),
        energies=tuple(energy_of(flown, plan, program.reserve) for flown in robots),
        approaches=tuple(_approaches(given, places)),
        separations=tuple(_separations(given, legs, places)),
        photos=tuple(_photos(given, places)),
        readings=tuple(
            reading
            for robot, flown in zip(program.robots, robots, strict=True)
            for reading in readings_of(flown, _datum(given, robot), places.of)
        ),
        events=tuple(sorted((e for flown in robots for e in events_of(flown)), key=lambda e: e.time)),
        links=tuple(link for link in links if link is not None),
        unknown=tuple(map(without_secrets, _unknown(given))),
    )


def _datum(given: Given, robot: RobotProgram) -> Datum:
    type, vehicle = given.place.types.get(robot.type_name), given.flight.robots[robot.id].vehicle
    return datum_of(robot, given.program, type, vehicle, given.contributions.robot_kinds)


def _robot(robot: RobotProgram, given: Given, judged: ReplayResult) -> RobotReport:
    flown, plan = given.flight.robots[robot.id], given.planned.run
    track = plan.tracks.get(robot.id, ()) if plan is not None else ()
    steps = [record for record in (plan.records if plan is not None else ()) if record.robot == robot.id]
    ended = {record.move for record in flown.records if record.label == "end"}
    return RobotReport(
        robot.id,
        robot.type_name,
        _ending(robot, flown, judged),
        _length(flown) if len(flown.track.times) else None,
        sum(dist(a.position, b.position) for a, b in pairwise(track)) if track else None,
        flown.program_time,
        steps[-1].time - steps[0].time if steps else None,
        (len(ended), len(robot.moves)),
    )


def _ending(robot: RobotProgram, flown: Flown, judged: ReplayResult) -> str:
    if not flown.records:
        return f"not started: {flown.given_up[-1].content.get('what')}" if flown.given_up else "no log"
    last = flown.records[-1]
    if last.label == "fault":
        return last.detail.partition(":")[0]
    if last.move == robot.moves[robot.stop].id and last.label == "end":
        return "completed"
    if flown.given_up and flown.given_up[-1].time >= last.time:
        return str(flown.given_up[-1].content.get("what"))
    left = [each for each in flown.of_kind("decision") if each.time >= last.time]
    if left and left[-1].content.get("response") in AWAY:
        return f"suspended: {without_secrets(str(left[-1].content.get('what')))}"
    waits = next((each.slots for each in judged.waiting if each.robot == robot.id), ())
    return f"waiting for {', '.join(waits)}" if waits else "log ends before the program"


def _length(flown: Flown) -> float:
    return float(sum(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum() for piece in pieces(flown.track)))


def _approaches(given: Given, places: Locator) -> Iterator[Approach]:
    for robot in given.program.robots:
        robot_type = given.place.types.get(robot.type_name)
        own = robot_type.half_diagonal + given.program.position_error if robot_type is not None else None
        areas = [area for area in given.place.areas or () if area.concerns(robot.type_name)]
        track, error = given.flight.robots[robot.id].track, given.program.position_error
        yield from approaches_of(robot.id, track, areas, own, places.of, error)


def _separations(
    given: Given, legs: Mapping[str, tuple[PlannedLeg, ...]], places: Locator
) -> Iterator[Separation]:
    program = given.program
    apart, flown = program.minimum_separation, given.flight.robots
    moving = [(flown[robot.id], in_motion(flown[robot.id], legs[robot.id])) for robot in program.robots]
    errors = 2 * program.position_error
    yield from separations_of(moving, None if apart is None else apart + errors, places.of, errors)


def _photos(given: Given, places: Locator) -> Iterator[PhotoReport]:
    found = shots_in(given.program, given.flight, given.place.types, given.contributions)
    for robot, shots in found.items():
        for shot in shots:
            where = places.of(shot.at) if shot.at is not None else None
            yield PhotoReport(robot, shot.time, shot.state, shot.index, shot.task, shot.move, where)


def _unknown(given: Given) -> Iterator[str]:
    for robot, flown in given.flight.robots.items():
        if not flown.records and not flown.given_up:
            yield f"{robot}: no log: what it did is unknown"
        if not len(flown.track.times):
            yield f"{robot}: no black box with positions: its track is unknown"
        elif not np.isfinite(flown.track.energies).any():
            yield f"{robot}: no battery data: what it used is unknown"
    if not given.flight.whole:
        yield "logs are missing or damaged: whether they match the behaviour cannot be judged"
    if given.place.areas is None:
        yield "no context: distances to forbidden areas and obstacles are unknown"
    yield from given.flight.damages
    yield from given.planned.notes


def link_of(flown: Flown) -> LinkReport | None:
    """Return the quality of the link to a robot; None where there is no black box of it."""
    if not len(flown.track.times) and not flown.entries:
        return None
    commands = flown.of_kind("command")
    tries = [number_of(entry.content.get("tries")) or 1.0 for entry in commands]
    seconds = [found for entry in commands if (found := number_of(entry.content.get("seconds"))) is not None]
    gaps = [until - since for since, until in flown.track.gaps]
    starts = flown.of_kind("start")
    start = starts[0].content if starts else {}
    words = [str(start[name]) for name in ("vehicle", "firmware") if start.get(name)]
    return LinkReport(
        flown.robot,
        ", ".join(words),
        _sort(start.get("link")),
        len(flown.track.times),
        len(gaps),
        max(gaps, default=0.0),
        sum(gaps),
        dict(flown.counted),
        len(commands),
        sum(each > 1 for each in tries),
        sum(str(entry.content.get("result", "")) not in _ACCEPTED for entry in commands),
        max(seconds, default=None),
    )


def _sort(link: object) -> str:
    """Return the kind of a link, without any address or path."""
    if not isinstance(link, str) or not link:
        return ""
    found = _SORT.match(link)
    return found[0].lower() if found else "serial"
