"""What should have happened: the behaviour as simulated, and the ways that its moves should go."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from mmrs_core.behaviour.program import Move, Program, RobotProgram
from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.cli.behaviours import Loaded
from mmrs_core.cli.flights.values import Flight
from mmrs_core.cli.journey import Workshop
from mmrs_core.cli.simulation import fly
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.errors import MmrsError
from mmrs_core.runtime.run import Run
from mmrs_core.scene import Name, Position


@dataclass(frozen=True, slots=True)
class Planned:
    """What should have happened.

    Attributes:
        run: as simulated, from when the flight's first step was; None where it cannot be simulated.
        notes: what was taken for granted, or why there is no run, for people.
    """

    run: Run | None
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
    workshop: Workshop, loaded: Loaded, flight: Flight, assume: Mapping[str, bool] | None = None
) -> Planned:
    """Return what should have happened in a flight.

    Args:
        assume: what conditions answer that the flight never asked, by identifier.

    Raises:
        typer.BadParameter: if nothing in the behaviour asks for one of the conditions.
    """
    program = loaded.program
    answers, notes = _answers(program, flight)
    known = {**(assume or {}), **answers}
    contributed = workshop.contributions.conditions
    guessed = [each for each in _asked(program) if each not in known and each not in contributed]
    notes += [f"condition '{each}' was never asked; the plan takes it that it holds" for each in guessed]
    try:
        run = fly(workshop, program, loaded.place, {**dict.fromkeys(guessed, True), **known})
    except MmrsError as error:
        return Planned(None, (*notes, f"times and energy as planned are not known: {error}"))
    begun = min((flown.records[0].time for flown in flight.robots.values() if flown.records), default=0.0)
    return Planned(_later(run, begun), (*notes, *run.notes))


def _later(run: Run, seconds: float) -> Run:
    """Return a run that begins so much later: when the flight does, whose vehicles had to get ready."""
    if seconds <= 0:
        return run
    return replace(
        run,
        records=tuple(replace(record, time=record.time + seconds) for record in run.records),
        tracks={
            robot: tuple(replace(sample, time=sample.time + seconds) for sample in track)
            for robot, track in run.tracks.items()
        },
    )


def _answers(program: Program, flight: Flight) -> tuple[dict[str, bool], list[str]]:
    """Return what conditions answered first, and for which they did not always answer the same."""
    answers: dict[str, bool] = {}
    notes: list[str] = []
    for robot in program.robots:
        index = {move.id: i for i, move in enumerate(robot.moves)}
        flown = flight.robots.get(robot.id)
        for record in flown.records if flown else ():
            transition = robot.transitions.get(index.get(record.move, -1))
            if record.label == "choose" and transition is not None and transition.condition is not None:
                holds = record.detail == "true"
                if answers.setdefault(transition.condition, holds) is not holds:
                    notes.append(
                        f"condition '{transition.condition}' was answered both ways;"
                        " the plan takes its first answer"
                    )
    return answers, list(dict.fromkeys(notes))


def _asked(program: Program) -> Iterator[str]:
    transitions = (each for robot in program.robots for each in robot.transitions.values())
    yield from sorted({each.condition for each in transitions if each.condition is not None})


def legs_of(
    robot: RobotProgram, records: Sequence[StepRecord], last: float, kinds: Mapping[Name, MoveKind]
) -> tuple[PlannedLeg, ...]:
    """Return every move that a robot began, with the way that it should have gone.

    Args:
        records: of the robot, in order.
        last: when the last thing is known of it.
        kinds: of moves, by metaclass.
    """
    moves = {move.id: move for move in robot.moves}
    here: Position | None = robot.home if robot.home is not None else (0.0, 0.0, 0.0)
    legs: list[PlannedLeg] = []
    for record, after in zip_longest(records, records[1:]):
        move = moves.get(record.move)
        if record.label != "begin" or move is None:
            continue
        way = _way(move, here, robot.home, kinds)
        end = max(after.time if after is not None else last, record.time)
        legs.append(PlannedLeg(move, record.time, end, after is not None and after.label == "end", way))
        here = way[-1] if way else None
    return tuple(legs)


def _way(
    move: Move, here: Position | None, home: Position | None, kinds: Mapping[Name, MoveKind]
) -> tuple[Position, ...]:
    name = most_specific(move.metaclasses, kinds)
    if name is None:
        return ()
    if here is None:
        # Where it came from is not known: an object without a place. Where it leads to may be.
        position = move.target.position if move.target is not None else None
        return (position,) if position is not None and move.distance == 0 else ()
    return kinds[name].path(move, here, home) or ()
