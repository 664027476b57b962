"""What should have happened: the behaviour as simulated, choosing as the flight did, and its paths.

Robots are off their paths while they follow a policy: returning, at home, and coming back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest

import numpy as np

from mmrs_core.behaviour.program import Move, Program, RobotProgram
from mmrs_core.contributions.execution import Condition, RobotState
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.errors import MmrsError
from mmrs_core.geometry.frames import Floats
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.tracks import Track, nearest
from mmrs_core.pipeline import BehaviourContext, conditions_for, input_of
from mmrs_core.scene import Name, Position
from mmrs_core.simulation.run import SimulatedRun, refuse_unasked, simulate

AWAY = frozenset({"RETURN", "LAND", "EMERGENCY_AREA", "SURFACE", "STOP_THRUST"})
"""Responses by which a robot leaves its path."""
BACK = 2.0
"""Metres from its path within which a robot that was away is back."""

Stretch = tuple[float, float]
BACKEND = "simulation"
_LONGEST = 100
"""How often a Choice repeats its last logged answer before it answers otherwise.

The log of a flight that was aborted in a loop has no answer that ends the loop, but its plan must end.
"""


@dataclass(frozen=True, slots=True)
class Planned:
    """What should have happened.

    Attributes:
        run: as simulated, from when the flight's first step was; None where it cannot be simulated.
        notes: what was assumed, or why there is no run.
    """

    run: SimulatedRun | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PlannedLeg:
    """A move that a robot began, and its planned path.

    Attributes:
        begin: when it began; end: when its next step was, or the end of the robot's record.
        ended: whether it came to its end.
        way: straight legs from where the robot should have been; empty where unknown.
    """

    move: Move
    begin: float
    end: float
    ended: bool
    way: tuple[Position, ...]


def planned_for(
    program: Program,
    place: BehaviourContext,
    contributions: Contributions,
    flight: Flight,
    assume: Mapping[str, bool] | None = None,
) -> Planned:
    """Return what should have happened in a flight.

    Args:
        assume: outcomes of conditions that the flight never evaluated, by identifier.

    Raises:
        UsageError: if no Choice asks for one of the conditions.
    """
    reported = assume or {}
    refuse_unasked(program, reported)
    known = conditions_for(program, contributions, {}, asks=False)
    choosing = choosing_as(flight, program, reported, known)
    notes = tuple(choosing.notes)
    try:
        run = simulate(
            input_of(choosing.program, place, contributions),
            contributions.vehicles[BACKEND],
            conditions=choosing.conditions,
        )
    except MmrsError as error:
        return Planned(None, (*notes, f"planned times and energy are unknown: {error}"))
    begun = min((flown.records[0].time for flown in flight.robots.values() if flown.records), default=0.0)
    return Planned(_later(run, begun), (*notes, *run.notes))


def _later(run: SimulatedRun, seconds: float) -> SimulatedRun:
    """Return a run that begins later: when the flight does, after the preparation of its vehicles."""
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
    """Return every move that a robot began, with its planned path.

    Each begins where the one before should have ended; after a move to an object that the robot had to
    find, at the robot's position.
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


@dataclass(slots=True)
class Choosing:
    """A behaviour whose Choices are decided as in a flight.

    Attributes:
        program: the behaviour, each Choice with a condition of its own.
        conditions: by their identifiers there.
        notes: outcomes that were assumed.
    """

    program: Program
    conditions: dict[str, Condition] = field(default_factory=dict)
    notes: dict[str, None] = field(default_factory=dict)


def choosing_as(
    flight: Flight, program: Program, assume: Mapping[str, bool], known: Mapping[str, Condition]
) -> Choosing:
    """Return a behaviour that chooses as a flight did.

    A Choice that the flight never reached has the assumed outcome. Without one, its condition decides as
    it did elsewhere in the flight, then by the state of the robot, and last it holds, which a note says.

    Args:
        assume: outcomes by condition identifier.
        known: conditions that decide by the state of the robot, by identifier.
    """
    elsewhere = _first_answers(flight, program)
    made = Choosing(program)

    def decided(robot: RobotProgram, move: int, condition: str) -> Callable[[RobotState], bool]:
        answers = list(_answers(flight, robot, robot.moves[move].id))
        if answers:
            return _in_order(answers)
        fixed = assume.get(condition, elsewhere.get(condition))
        if fixed is None and condition in known:
            return known[condition].holds
        if fixed is None:
            made.notes[f"condition '{condition}' was never evaluated; the plan assumes that it holds"] = None
        return _in_order([True if fixed is None else fixed])

    robots = []
    for robot in program.robots:
        transitions = dict(robot.transitions)
        for move, transition in robot.transitions.items():
            if transition.condition is not None:
                own = f"{robot.id}, {robot.moves[move].id}: {transition.condition}"
                made.conditions[own] = Condition(own, decided(robot, move, transition.condition))
                transitions[move] = replace(transition, condition=own)
        robots.append(replace(robot, transitions=transitions))
    made.program = replace(program, robots=tuple(robots))
    return made


def _answers(flight: Flight, robot: RobotProgram, move: str) -> Iterator[bool]:
    flown = flight.robots.get(robot.id)
    for record in flown.records if flown is not None else ():
        if record.label == "choose" and record.move == move:
            yield record.detail == "true"


def _first_answers(flight: Flight, program: Program) -> dict[str, bool]:
    """Return what each condition answered first, by identifier."""
    answers: dict[str, bool] = {}
    for robot in program.robots:
        for move, transition in robot.transitions.items():
            if transition.condition is not None:
                for answer in _answers(flight, robot, robot.moves[move].id):
                    answers.setdefault(transition.condition, answer)
    return answers


def _in_order(answers: Sequence[bool]) -> Callable[[RobotState], bool]:
    asked = 0

    def holds(state: RobotState) -> bool:
        nonlocal asked
        asked += 1
        if asked <= len(answers):
            return answers[asked - 1]
        return answers[-1] is (asked <= len(answers) + _LONGEST)

    return holds


def away_of(flown: Flown, legs: Sequence[PlannedLeg]) -> tuple[Stretch, ...]:
    """Return when a robot was off its paths, by the decisions in its black box.

    It is back at the nearest point to the path that it left, or to the position at which it waited. A
    robot that never comes back is away to the end.
    """
    stretches: list[Stretch] = []
    for decision in flown.of_kind("decision"):
        done = stretches and decision.time <= stretches[-1][1]
        if decision.content.get("response") in AWAY and not done:
            stretches.append((decision.time, _back(flown, decision.time, legs)))
    return tuple(stretches)


def without(stretch: Stretch, away: Iterable[Stretch]) -> list[Stretch]:
    """Return what is left of a stretch of time.

    >>> without((0.0, 10.0), [(2.0, 4.0), (9.0, 20.0)])
    [(0.0, 2.0), (4.0, 9.0)]
    """
    since, end = stretch
    left: list[Stretch] = []
    for begin, until in away:
        if until > since and begin < end:
            left += [(since, begin)] if begin > since else []
            since = max(since, until)
    return [*left, (since, end)] if since < end else left


def _back(flown: Flown, time: float, legs: Sequence[PlannedLeg]) -> float:
    track = flown.track
    way = _left_path(track, time, legs)
    first = int(np.searchsorted(track.times, time))
    if way is None or first >= len(track.times):
        return flown.end
    positions = track.positions[first:]
    off = np.linalg.norm(positions - nearest(positions, way)[0], axis=1)
    gone = np.flatnonzero(off > BACK)
    if not len(gone):
        return time
    near = np.flatnonzero(off[gone[0] :] <= BACK)
    if not len(near):
        return flown.end
    at = int(gone[0] + near[0])
    while at + 1 < len(off) and off[at + 1] < off[at]:
        at += 1
    return float(track.times[first + at])


def _left_path(track: Track, time: float, legs: Sequence[PlannedLeg]) -> Floats | None:
    on = next((leg.way for leg in legs if leg.begin <= time <= leg.end and leg.way), None)
    at = track.at(time)
    if on is not None:
        return np.array(on)
    return None if at is None else np.array([at])
