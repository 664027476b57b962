"""Makes the picture of a simulated run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise, zip_longest
from math import dist

import numpy as np

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram
from mmrs_core.contributions.execution import Sample
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pictures.flights.planned import Stretch, without
from mmrs_core.pictures.flights.tracks import Track, stretches_of
from mmrs_core.pictures.preview.features import (
    NO_CONTEXT,
    elements_of,
    gap_of_clearances,
    origin_of,
    symbol_of_robot,
    zones_of,
)
from mmrs_core.pictures.preview.picture import Bar, Handover, Leg, Picture, RobotPicture
from mmrs_core.pipeline import BehaviourContext
from mmrs_core.scene import Name, Position
from mmrs_runtime.records.steps import StepRecord

_STANDSTILL = 1e-3
_HOLD = (BEHAVIOUR, "HoldPosition")
_RECHARGE = (BEHAVIOUR, "Recharge")
_STATES = {"airborne": "launch", "grounded": "recover"}


def picture_of_run(
    program: Program,
    records: Iterable[StepRecord],
    tracks: Mapping[str, Sequence[Sample]],
    move_kinds: Mapping[Name, MoveKind],
    symbols: Mapping[Name, MapSymbol],
    place: BehaviourContext,
) -> Picture:
    """Return what to show of a run.

    Args:
        program: what the robots did.
        records: the run's steps; those of one robot in the order of its log.
        tracks: by robot, the way that it came.
        move_kinds: what tells launches and recoveries apart from other moves.
        symbols: how things look, by metaclass.
        place: what it took place in.
    """
    by_robot: dict[str, list[StepRecord]] = {robot.id: [] for robot in program.robots}
    for record in records:
        by_robot[record.robot].append(record)
    types = place.types
    robots = tuple(
        replace(
            _robot(robot, by_robot[robot.id], tracks.get(robot.id, ()), move_kinds),
            symbol=symbol_of_robot(types[robot.type_name], symbols) if robot.type_name in types else None,
        )
        for robot in program.robots
    )
    clearances = {
        robot.id: types[robot.type_name].half_diagonal + program.position_error
        if robot.type_name in types
        else None
        for robot in program.robots
    }
    zones = zones_of(place.areas or (), clearances)
    return Picture(
        title=program.name,
        origin=origin_of(program.frame),
        robots=robots,
        zones=zones,
        gaps=gap_of_clearances(zones) if place.areas is not None else (NO_CONTEXT,),
        elements=elements_of((*place.elements, *(each.part for each in place.corridors)), symbols),
        handovers=tuple(handovers_of(program, by_robot)),
        makespan=max((steps[-1].time for steps in by_robot.values() if steps), default=0.0),
    )


def _robot(
    robot: RobotProgram,
    records: Sequence[StepRecord],
    track: Sequence[Sample],
    kinds: Mapping[Name, MoveKind],
) -> RobotPicture:
    moves = {move.id: move for move in robot.moves}
    end = records[-1].time if records else 0.0
    flown = sum(dist(a.position, b.position) for a, b in pairwise(track))
    return RobotPicture(
        name=robot.id,
        type_name=robot.type_name,
        home=robot.home or (track[0].position if track else (0.0, 0.0, 0.0)),
        legs=tuple(
            legs_of_records(
                moves, records, track_of(track), kinds, end=end, still=_STANDSTILL, holding=_STANDSTILL
            )
        ),
        bars=tuple(bars_of_records(moves, records, kinds)),
        heights=tuple((sample.time, sample.up) for sample in track),
        summary=(("moves", str(len(robot.moves))), ("distance", length(flown)), ("time", clock(end))),
    )


def track_of(samples: Sequence[Sample]) -> Track:
    """Return the track of a simulated robot; without gaps."""
    return Track(
        np.array([sample.time for sample in samples], dtype=np.float64),
        np.array([sample.position for sample in samples], dtype=np.float64).reshape(-1, 3),
        np.full(len(samples), np.nan),
        np.zeros(len(samples), dtype=bool),
    )


def legs_of_records(
    moves: Mapping[str, Move],
    records: Sequence[StepRecord],
    track: Track,
    kinds: Mapping[Name, MoveKind],
    *,
    end: float,
    still: float,
    holding: float,
    away: Sequence[Stretch] = (),
) -> Iterator[Leg]:
    """Yield where and when a robot carried out its moves.

    Args:
        end: of what is known of it, seconds.
        still: metres within which a robot that does nothing is not shown.
        holding: metres within which a robot that is to hold its position holds it.
        away: when it did something else.
    """
    acts = _acts(records)
    for begin, after in zip_longest(records, records[1:]):
        if begin.label != "begin":
            continue
        move = moves[begin.move]
        kind, words = kind_of_leg(move, kinds), f"move {move.id}"
        positions = (track.at(time) for time in acts.get((move.id, begin.seq), ()))
        acted = tuple(position for position in positions if position is not None)
        for since, until in without((begin.time, after.time if after is not None else end), away):
            for times, points in stretches_of(track, since, until):
                first, last, reach = times[0], times[-1], reach_of(points)
                if move.is_a(_HOLD) and reach < holding:
                    yield Leg("hold", points[:1], first, last, move.task, actions=acted, moves=words)
                elif reach > still or acted:
                    yield Leg(kind, points, first, last, move.task, actions=acted, moves=words, times=times)
                acted = ()


def reach_of(points: Sequence[Position]) -> float:
    """Return the diagonal of the box around points, metres."""
    return float(np.linalg.norm(np.ptp(np.asarray(points), axis=0)))


def _acts(records: Iterable[StepRecord]) -> dict[tuple[str, int], list[float]]:
    """Return when device actions were done, by move and the number of the step that began it."""
    acts: dict[tuple[str, int], list[float]] = {}
    before: list[float] = []
    begun: tuple[str, int] | None = None
    for record in records:
        if record.label == "begin":
            begun = (record.move, record.seq)
            acts[begun] = before
        elif record.label == "act":
            after = begun is not None and record.detail.startswith("post")
            (acts[begun] if after and begun else before).append(record.time)
        elif record.label in ("take", "choose"):
            before = []
    return acts


def kind_of_leg(move: Move, kinds: Mapping[Name, MoveKind]) -> str:
    """Return the kind of the leg that a move that moves is."""
    name = most_specific(move.metaclasses, kinds)
    state = kinds[name].leaves if name is not None else None
    if state in _STATES:
        return _STATES[state]
    return "transit" if move.rule == "transit" or not (move.task or move.before or move.after) else "work"


def bars_of_records(
    moves: Mapping[str, Move], records: Sequence[StepRecord], kinds: Mapping[Name, MoveKind]
) -> Iterator[Bar]:
    """Yield a bar for every stretch of time between two steps: its kind is that of the later step."""
    for record, following in pairwise(records):
        if following.time <= record.time:
            continue
        move = moves[following.move]
        if following.label in ("take", "choose") or (following.label == "fault" and record.label != "begin"):
            kind = "wait"
        elif following.label == "act":
            kind = "work"
        elif move.is_a(_RECHARGE):
            kind = "recharge"
        else:
            kind = "hold" if move.is_a(_HOLD) else kind_of_leg(move, kinds)
        yield Bar(kind, record.time, following.time, move.task, f"move {move.id}")


def handovers_of(program: Program, by_robot: Mapping[str, Sequence[StepRecord]]) -> Iterator[Handover]:
    """Yield which robot released which, and since when the other had waited.

    Args:
        program: the behaviour.
        by_robot: the steps of each robot, in the order of its log.
    """
    waits = list(_waits(program, by_robot))
    for robot in program.robots:
        moves = {move.id: move for move in robot.moves}
        for record in by_robot[robot.id]:
            if record.label != "ntf":
                continue
            action = moves[record.move].action(record.detail)
            for slot in action.sets if action.active else ():
                yield from (
                    Handover(robot.id, record.time, owner, begin, time, moves[record.move].task)
                    for owner, name, begin, time in waits
                    if (owner, name) == slot and owner != robot.id and begin <= record.time <= time
                )


def _waits(
    program: Program, by_robot: Mapping[str, Sequence[StepRecord]]
) -> Iterator[tuple[str, str, float, float]]:
    """Yield (robot, slot, since, until) for every slot that a robot waited for until it continued."""
    for robot in program.robots:
        index = {move.id: i for i, move in enumerate(robot.moves)}
        for before, record in pairwise(by_robot[robot.id]):
            transition = robot.transitions.get(index[record.move])
            if record.label == "take" and transition is not None and record.time > before.time:
                yield from ((robot.id, slot, before.time, record.time) for slot in transition.waits)
