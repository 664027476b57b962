"""Tasks: what was asked, and how much of it was achieved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from mmrs_core.behaviour.program import Move, Program
from mmrs_core.pictures.flights.flight import Flight
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.flights.tracks import Track, along
from mmrs_core.pictures.report.contents import TaskReport, TaskStatus
from mmrs_core.pictures.report.visits import Visit, visits_of
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.records.steps import StepRecord

_ALL = 0.9995
_SHORTEST = 1e-3


@dataclass(slots=True)
class _Work:
    """One task: what was to be done and was, in seconds of the plan, and when."""

    asked: float = 0.0
    achieved: float = 0.0
    robots: dict[str, None] = field(default_factory=dict)
    begins: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)
    planned_begins: list[float] = field(default_factory=list)
    planned_ends: list[float] = field(default_factory=list)


def task_reports(
    program: Program, flight: Flight, plan: SimulatedRun | None, legs: Mapping[str, Sequence[PlannedLeg]]
) -> tuple[TaskReport, ...]:
    """Return every task that moves serve, in their order.

    The part that was done is of the planned time of the moves that serve it; of a move that was begun
    and not ended, it is the part of its path up to the last known position. Without a plan, every move
    counts the same, and those that were never reached count as asked for.

    Args:
        legs: of each robot, with the planned path of each begun move.
    """
    works: dict[str, _Work] = {}
    for robot in program.robots:
        moves = {move.id: move for move in robot.moves}
        for move in robot.moves:
            if move.works:
                works.setdefault(move.task, _Work())
        records = flight.robots[robot.id].records
        flown = _by_move(visits_of(records), moves)
        planned = _by_move(visits_of(_of(plan, robot.id)), moves) if plan is not None else None
        partly = _partly(legs.get(robot.id, ()), flight.robots[robot.id].track)
        for id in moves:
            if moves[id].works:
                visits = flown.get(id, [])
                asked = planned.get(id, []) if planned is not None else None
                _count(works[moves[id].task], robot.id, visits, asked, partly.get(id, 0.0))
    return tuple(_report(name, work) for name, work in works.items())


def _of(plan: SimulatedRun, robot: str) -> Iterator[StepRecord]:
    return (record for record in plan.records if record.robot == robot)


def _by_move(visits: Sequence[Visit], moves: Mapping[str, Move]) -> dict[str, list[Visit]]:
    found: dict[str, list[Visit]] = {}
    for visit in visits:
        if visit.move in moves:
            found.setdefault(visit.move, []).append(visit)
    return found


def _count(
    work: _Work, robot: str, flown: Sequence[Visit], planned: Sequence[Visit] | None, part: float
) -> None:
    times = len(planned) if planned is not None else max(len(flown), 1)
    times = max(times, len(flown))
    if not times:
        return
    work.robots[robot] = None
    seconds = _seconds(planned) if planned else 1.0
    complete = sum(visit.complete for visit in flown)
    work.asked += times * seconds
    work.achieved += min(complete + (part if complete < len(flown) else 0.0), times) * seconds
    work.begins += [visit.begun for visit in flown if visit.begun is not None]
    work.ends += [visit.done for visit in flown if visit.complete]
    work.planned_begins += [visit.begun for visit in planned or () if visit.begun is not None]
    work.planned_ends += [visit.done for visit in planned or ()]


def _seconds(planned: Sequence[Visit]) -> float:
    return max(max(visit.done - visit.entered for visit in planned), _SHORTEST)


def _partly(legs: Sequence[PlannedLeg], track: Track) -> dict[str, float]:
    """Return by move that was begun and not ended the completed part of its path, 0 to 1."""
    parts: dict[str, float] = {}
    for leg in legs:
        inside = (track.times >= leg.begin) & (track.times <= leg.end)
        if not leg.ended and len(leg.way) > 1 and inside.any():
            parts[leg.move.id] = float(np.max(along(track.positions[inside], np.array(leg.way))))
    return parts


def _report(name: str, work: _Work) -> TaskReport:
    part = work.achieved / work.asked if work.asked else 0.0
    if not work.asked:
        status = TaskStatus.NOT_CHOSEN
    elif part >= _ALL:
        status = TaskStatus.DONE
    else:
        status = TaskStatus.PART if part > 0 else TaskStatus.NOT_DONE
    planned = (min(work.planned_begins), max(work.planned_ends)) if work.planned_begins else None
    end = max(work.ends, default=None) if status is TaskStatus.DONE else None
    flown = (min(work.begins), end) if work.begins else None
    return TaskReport(name, status, part, tuple(work.robots), planned, flown)
