"""Makes the picture of a flight, from logs and black boxes, over its plan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise, zip_longest
from math import dist

import numpy as np

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pictures.flights.away import away_of, without
from mmrs_core.pictures.flights.photos import SIMULATED, UNCONFIRMED, Shot, shots_in
from mmrs_core.pictures.flights.planned import Planned, legs_of
from mmrs_core.pictures.flights.tracks import Piece, pieces, stretches_of, thinned
from mmrs_core.pictures.flights.values import Flight, Flown
from mmrs_core.pictures.preview.from_run import (
    bars_of_records,
    handovers_of,
    kind_of_leg,
    picture_of_run,
)
from mmrs_core.pictures.preview.picture import Arm, Bar, Leg, Mark, Picture, RobotPicture
from mmrs_core.pipeline import Place
from mmrs_core.scene import Name, Part, Position
from mmrs_runtime.records.steps import StepRecord

_HOLD = (BEHAVIOUR, "HoldPosition")
_STILL = 0.3
_STAYING = 3.0
"""Metres of movement below which a robot that is to hold its position counts as holding it."""
_LONGEST_UNNAMED = 1.0
"""Longest stretch outside of all moves that is not shown, metres."""


def picture_of_flight(
    program: Program,
    flight: Flight,
    planned: Planned,
    contributed: Contributions,
    place: Place,
    elements: Iterable[Part] = (),
) -> Picture:
    """Return what to show of a flight; tracks are thinned out by a tolerance that a note gives."""
    run = planned.run
    plan = picture_of_run(
        program,
        run.records if run else (),
        run.tracks if run else {},
        contributed.move_kinds,
        contributed.map_symbols,
        place,
        elements,
    )
    kinds = contributed.move_kinds
    vehicles = contributed.vehicles.values()
    shots = shots_in(program, flight, place.types, contributed.robot_kinds, vehicles)
    shown = [_Shown(robot, flight.robots[robot.id], kinds, shots[robot.id]) for robot in program.robots]
    robots = tuple(each.over(picture) for each, picture in zip(shown, plan.robots, strict=True))
    coarsest = max(each.tolerance for each in shown) if shown else 0.0
    return replace(
        plan,
        robots=robots,
        handovers=tuple(handovers_of(program, {id: flown.records for id, flown in flight.robots.items()})),
        makespan=max((flown.end for flown in flight.robots.values()), default=0.0),
        notes=(*_notes(flight, coarsest), *planned.notes),
        flown=True,
    )


def _notes(flight: Flight, tolerance: float) -> Iterator[str]:
    if any(flown.simulated for flown in flight.robots.values()):
        yield "this run had no vehicles: it was simulated"
    else:
        yield f"tracks are drawn within {tolerance:g} m of the reported positions"
    for robot, flown in flight.robots.items():
        if not len(flown.track.times):
            yield f"{robot}: its track is unknown, there is no black box of it"
        elif gaps := flown.track.gaps:
            whole = sum(until - since for since, until in gaps)
            yield f"{robot}: no positions for {clock(whole)} in {len(gaps)} gaps"
    yield from flight.damages


class _Shown:
    """One robot of a flight."""

    def __init__(
        self,
        program: RobotProgram,
        flown: Flown,
        kinds: Mapping[Name, MoveKind],
        shots: Sequence[Shot],
    ) -> None:
        self._program, self._flown, self._kinds, self._shots = program, flown, kinds, shots
        self._moves = {move.id: move for move in program.moves}
        self._track, self.tolerance = thinned(flown.track)
        self._away = away_of(flown, legs_of(program, flown, kinds))

    def over(self, plan: RobotPicture) -> RobotPicture:
        """Return the robot's picture over that of its plan."""
        flown = self._flown
        legs = sorted((*self._legs(), *self._between_moves()), key=lambda leg: leg.begin)
        way = sum(dist(a, b) for piece in pieces(self._track) for a, b in pairwise(piece.tolist()))
        known = (("distance", length(way)),) if len(self._track.times) else (("distance", "unknown"),)
        return replace(
            plan,
            legs=tuple(legs),
            bars=tuple(sorted(self._bars(), key=lambda bar: bar.begin)),
            heights=tuple(zip(self._track.times.tolist(), self._track.positions[:, 2].tolist(), strict=True)),
            planned=tuple(leg.points for leg in plan.legs if not leg.stays),
            planned_heights=plan.heights,
            arms=(Arm("as planned", plan.bars[0].begin, plan.bars[-1].end, plan.bars),) if plan.bars else (),
            marks=tuple(self._marks()),
            summary=(
                ("moves", _moves_done(self._program, flown)),
                *known,
                ("time", clock(flown.program_time)),
            ),
        )

    def _legs(self) -> Iterator[Leg]:
        records = self._flown.records
        acts = _acts(records)
        for begin, after in zip_longest(records, records[1:]):
            if begin.label != "begin":
                continue
            move = self._moves[begin.move]
            end = after.time if after is not None else self._flown.end
            acted = (self._flown.track.at(time) for time in acts.get((move.id, begin.seq), ()))
            yield from self._leg(move, begin.time, end, tuple(each for each in acted if each is not None))

    def _leg(self, move: Move, begin: float, end: float, acted: tuple[Position, ...]) -> Iterator[Leg]:
        kind, moves = kind_of_leg(move, self._kinds), f"move {move.id}"
        for times, points in self._pieces(begin, end):
            reach = _reach(points)
            if move.is_a(_HOLD) and reach < _STAYING:
                yield Leg("hold", points[:1], times[0], times[-1], move.task, actions=acted, moves=moves)
            elif reach > _STILL or acted:
                yield Leg(
                    kind, points, times[0], times[-1], move.task, actions=acted, moves=moves, times=times
                )
            acted = ()

    def _pieces(self, begin: float, end: float) -> Iterator[Piece]:
        for since, until in without((begin, end), self._away):
            yield from stretches_of(self._track, since, until)

    def _between_moves(self) -> Iterator[Leg]:
        """Yield the stretches that belong to no move: those of policies, operators and autopilots."""
        records = self._flown.records
        moving = [(a.time, b.time) for a, b in pairwise(records) if a.label == "begin"]
        busy = [part for move in moving for part in without(move, self._away)]
        since = 0.0
        for begin, end in (*busy, (self._flown.end, self._flown.end)):
            for times, points in stretches_of(self._track, since, begin):
                if _reach(points) > _LONGEST_UNNAMED:
                    note = "off-plan"
                    yield Leg("response", points, times[0], times[-1], note=note, times=times)
            since = max(since, end)

    def _bars(self) -> Iterator[Bar]:
        """Yield what the robot spent its time on, by the log; responses of policies take precedence."""
        for bar in bars_of_records(self._moves, self._flown.records, self._kinds):
            for begin, end in without((bar.begin, bar.end), self._away):
                yield replace(bar, begin=begin, end=end)
        faults = [record.time for record in self._flown.records[-1:] if record.label == "fault"]
        until = faults[0] if faults else self._flown.end
        for begin, end in self._away:
            if begin < until:
                yield Bar("response", begin, min(end, until))
        yield from self._after_fault()

    def _after_fault(self) -> Iterator[Bar]:
        last = self._flown.records[-1] if self._flown.records else None
        if last is not None and last.label == "fault" and self._flown.end > last.time:
            yield Bar("response", last.time, self._flown.end, note=f"after {last.detail}")

    def _marks(self) -> Iterator[Mark]:
        for shot in self._shots:
            if shot.at is not None and shot.state != SIMULATED:
                kind = "missing" if shot.state == UNCONFIRMED else "photo"
                yield Mark(kind, shot.at, f"photo at {clock(shot.time)}: {shot.state}")
        for record in self._flown.records:
            at = self._flown.track.at(record.time) if record.label == "fault" else None
            if at is not None:
                yield Mark("fault", at, f"{record.detail} at {clock(record.time)}, move {record.move}")
        for entry in (*self._flown.answered, *self._flown.given_up):
            if (at := self._flown.track.at(entry.time)) is not None:
                what, why = entry.content.get("what"), entry.content.get("why")
                yield Mark("fault", at, f"{what} at {clock(entry.time)}: {why}")


def _moves_done(program: RobotProgram, flown: Flown) -> str:
    done = len({record.move for record in flown.records if record.label == "end"})
    return f"{done} of {len(program.moves)}"


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


def _reach(points: Sequence[Position]) -> float:
    """Return the diagonal of the box around points, metres."""
    return float(np.linalg.norm(np.ptp(np.asarray(points), axis=0)))
