"""Makes the picture of a simulated run."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import dist

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram
from mmrs_core.contributions.execution import Sample
from mmrs_core.contributions.rules import MoveKind, most_specific
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pictures.preview.features import elements_of, origin_of, symbol_of_robot, zones_of
from mmrs_core.pictures.preview.picture import Bar, Handover, Leg, Picture, RobotPicture
from mmrs_core.pipeline import Place
from mmrs_core.scene import Name, Part, Position
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
    place: Place,
    elements: Iterable[Part] = (),
) -> Picture:
    """Return what to show of a run.

    Args:
        program: what the robots did.
        records: the run's steps; those of one robot in the order of its log.
        tracks: by robot, the way that it came.
        move_kinds: what tells launches and recoveries apart from other moves.
        symbols: how things look, by metaclass.
        place: what it took place in.
        elements: context elements of plug-ins.
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
    known = (types[robot.type_name] for robot in program.robots if robot.type_name in types)
    clearances = [robot_type.half_diagonal + program.position_error for robot_type in known]
    return Picture(
        title=program.name,
        origin=origin_of(program.frame),
        robots=robots,
        zones=zones_of(place.areas or (), clearances),
        elements=elements_of(elements, symbols),
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
    way = _Track(track)
    flown = sum(dist(a, b) for a, b in pairwise(way.positions))
    return RobotPicture(
        name=robot.id,
        type_name=robot.type_name,
        home=robot.home or (way.positions or [(0.0, 0.0, 0.0)])[0],
        legs=tuple(_legs(moves, records, way, kinds)),
        bars=tuple(bars_of_records(moves, records, kinds)),
        heights=tuple((sample.time, sample.up) for sample in track),
        summary=(("moves", str(len(robot.moves))), ("distance", length(flown)), ("time", clock(end))),
    )


def _legs(
    moves: Mapping[str, Move],
    records: Sequence[StepRecord],
    track: _Track,
    kinds: Mapping[Name, MoveKind],
) -> Iterator[Leg]:
    acts: dict[str, list[float]] = {}
    for record in records:
        if record.label == "act":
            acts.setdefault(record.move, []).append(record.time)
    for begin, end in movements(records):
        points, times = track.between(begin.time, end.time)
        move = moves[begin.move]
        if not points:
            continue
        done = tuple(track.at(time) for time in acts.get(move.id, ()))
        stays = sum(dist(a, b) for a, b in pairwise(points)) < _STANDSTILL
        if stays and not done and (move.is_a(_RECHARGE) or not move.is_a(_HOLD)):
            continue
        kind = "hold" if stays and move.is_a(_HOLD) else kind_of_leg(move, kinds)
        way = points[:1] if stays else points
        paced = () if stays else times
        yield Leg(
            kind, way, begin.time, end.time, move.task, actions=done, moves=f"move {move.id}", times=paced
        )


def movements(records: Sequence[StepRecord]) -> Iterator[tuple[StepRecord, StepRecord]]:
    """Yield every begin of a move with the step after it."""
    for record, following in pairwise(records):
        if record.label == "begin":
            yield record, following


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


class _Track:
    """The way of a robot, asked for by time.

    Attributes:
        positions: all corners of the way.
    """

    def __init__(self, samples: Sequence[Sample]) -> None:
        self._times = [sample.time for sample in samples]
        self.positions: list[Position] = [sample.position for sample in samples]

    def between(self, begin: float, end: float) -> tuple[tuple[Position, ...], tuple[float, ...]]:
        """Return the corners from begin to end, first and last interpolated, and when it was there.

        Both are empty where nothing is known.
        """
        if not self.positions:
            return (), ()
        inside = slice(bisect_right(self._times, begin), bisect_left(self._times, end))
        corners = (self.at(begin), *self.positions[inside], self.at(end))
        return corners, (begin, *self._times[inside], end)

    def at(self, time: float) -> Position:
        """Return where the robot was; before the first sample and after the last it stood still."""
        after = bisect_left(self._times, time)
        if after == 0 or after == len(self._times):
            return self.positions[min(after, len(self._times) - 1)]
        since, until = self._times[after - 1], self._times[after]
        part = (time - since) / (until - since)
        one, two = self.positions[after - 1], self.positions[after]
        return (
            one[0] + part * (two[0] - one[0]),
            one[1] + part * (two[1] - one[1]),
            one[2] + part * (two[2] - one[2]),
        )
