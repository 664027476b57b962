"""What should have happened: the behaviour as simulated, and the ways that its moves should go."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import zip_longest

from mmrs_core.behaviour.program import Move, Program, RobotProgram
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.errors import MmrsError
from mmrs_core.pictures.flights.answers import choosing_as
from mmrs_core.pictures.flights.values import Flight, Flown
from mmrs_core.pipeline import Place, conditions_for
from mmrs_core.scene import Name, Position
from mmrs_core.simulation.run import SimulatedRun, refuse_unasked, simulate

BACKEND = "simulation"


@dataclass(frozen=True, slots=True)
class Planned:
    """What should have happened.

    Attributes:
        run: as simulated, from when the flight's first step was; None where it cannot be simulated.
        notes: what was taken for granted, or why there is no run, for people.
    """

    run: SimulatedRun | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PlannedLeg:
    """A move that a robot began, and the way that it should have gone.

    Attributes:
        begin: when it began; end: when its next step was, or the last thing was known of the robot.
        ended: whether it came to its end.
        way: straight legs, the first point where the robot should have been; empty where nobody knows.
    """

    move: Move
    begin: float
    end: float
    ended: bool
    way: tuple[Position, ...]


def planned_for(
    program: Program,
    place: Place,
    contributions: Contributions,
    flight: Flight,
    assume: Mapping[str, bool] | None = None,
) -> Planned:
    """Return what should have happened in a flight.

    Args:
        assume: what conditions answer that the flight never asked, by identifier.

    Raises:
        UsageError: if no Choice asks for one of the conditions.
    """
    told = assume or {}
    refuse_unasked(program, told)
    known = conditions_for(program, contributions, {}, asks=False)
    choosing = choosing_as(flight, program, told, known)
    notes = tuple(choosing.notes)
    try:
        run = simulate(
            choosing.program,
            backend=contributions.vehicles[BACKEND],
            types=place.types,
            robot_kinds=contributions.robot_kinds,
            move_kinds=contributions.move_kinds,
            conditions=choosing.conditions,
            environment=place.environment,
            areas=place.areas or (),
        )
    except MmrsError as error:
        return Planned(None, (*notes, f"times and energy as planned are not known: {error}"))
    begun = min((flown.records[0].time for flown in flight.robots.values() if flown.records), default=0.0)
    return Planned(_later(run, begun), (*notes, *run.notes))


def _later(run: SimulatedRun, seconds: float) -> SimulatedRun:
    """Return a run that begins so much later: when the flight does, whose vehicles had to get ready."""
    if seconds <= 0:
        return run
    return replace(
        run,
        records=tuple(record._replace(time=record.time + seconds) for record in run.records),
        tracks={
            robot: tuple(replace(sample, time=sample.time + seconds) for sample in track)
            for robot, track in run.tracks.items()
        },
    )


def legs_of(robot: RobotProgram, flown: Flown, kinds: Mapping[Name, MoveKind]) -> tuple[PlannedLeg, ...]:
    """Return every move that a robot began, with the way that it should have gone.

    Each begins where the one before should have ended; after a move to an object, whose place the robot
    had to find, where the robot was.
    """
    moves = {move.id: move for move in robot.moves}
    here: Position | None = robot.home if robot.home is not None else (0.0, 0.0, 0.0)
    legs: list[PlannedLeg] = []
    for record, after in zip_longest(flown.records, flown.records[1:]):
        move = moves.get(record.move)
        if record.label != "begin" or move is None:
            continue
        here = here if here is not None else flown.track.at(record.time)
        way = _way(move, here, robot.home, kinds)
        end = max(after.time if after is not None else flown.end, record.time)
        legs.append(PlannedLeg(move, record.time, end, after is not None and after.label == "end", way))
        here = way[-1] if way else None
    return tuple(legs)


def _way(
    move: Move, here: Position | None, home: Position | None, kinds: Mapping[Name, MoveKind]
) -> tuple[Position, ...]:
    name = most_specific(move.metaclasses, kinds)
    searches = move.target is not None and move.target.description is not None
    if name is None or here is None or searches:
        return ()
    return kinds[name].path(move, here, home) or ()
