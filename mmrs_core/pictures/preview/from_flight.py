"""Makes the picture of a flight, from logs and black boxes, over its plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import dist

from mmrs_core.behaviour.program import BEHAVIOUR, Program, RobotProgram
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import MoveKind
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.pictures.flights.photos import SIMULATED, UNCONFIRMED, Shot, shots_in
from mmrs_core.pictures.flights.planned import Planned, away_of, legs_of, without
from mmrs_core.pictures.flights.tracks import pieces, stretches_of, thinned
from mmrs_core.pictures.preview.from_run import (
    bars_of_records,
    handovers_of,
    legs_of_records,
    picture_of_run,
    reach_of,
)
from mmrs_core.pictures.preview.picture import Arm, Bar, Leg, Mark, Picture, RobotPicture
from mmrs_core.pipeline import BehaviourContext
from mmrs_core.scene import Name

_HOLD = (BEHAVIOUR, "HoldPosition")
_STILL = 0.3
_STAYING = 3.0
"""Metres of movement below which a robot that is to hold its position counts as holding it."""
_LONGEST_UNNAMED = 1.0
"""Longest stretch outside of all moves that is not shown, metres."""


def picture_of_flight(
    program: Program, flight: Flight, planned: Planned, contributed: Contributions, place: BehaviourContext
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
    )
    kinds = contributed.move_kinds
    shots = shots_in(program, flight, place.types, contributed)
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
        self, program: RobotProgram, flown: Flown, kinds: Mapping[Name, MoveKind], shots: Sequence[Shot]
    ) -> None:
        self._program, self._flown, self._kinds, self._shots = program, flown, kinds, shots
        self._moves = {move.id: move for move in program.moves}
        self._track, self.tolerance = thinned(flown.track)
        self._away = away_of(flown, legs_of(program, flown, kinds))

    def over(self, plan: RobotPicture) -> RobotPicture:
        """Return the robot's picture over that of its plan."""
        flown = self._flown
        legs = legs_of_records(
            self._moves,
            flown.records,
            self._track,
            self._kinds,
            end=flown.end,
            still=_STILL,
            holding=_STAYING,
            away=self._away,
        )
        way = sum(dist(a, b) for piece in pieces(self._track) for a, b in pairwise(piece.tolist()))
        known = (("distance", length(way)),) if len(self._track.times) else (("distance", "unknown"),)
        return replace(
            plan,
            legs=tuple(sorted((*legs, *self._between_moves()), key=lambda leg: leg.begin)),
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

    def _between_moves(self) -> Iterator[Leg]:
        """Yield the stretches that belong to no move: those of policies, operators and autopilots."""
        records = self._flown.records
        moving = [(a.time, b.time) for a, b in pairwise(records) if a.label == "begin"]
        busy = [part for move in moving for part in without(move, self._away)]
        since = 0.0
        for begin, end in (*busy, (self._flown.end, self._flown.end)):
            for times, points in stretches_of(self._track, since, begin):
                if reach_of(points) > _LONGEST_UNNAMED:
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
