"""Photos: those that were commanded, those that the vehicle confirmed, and their positions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.pictures.flights.fixes import Datum, datum_of
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.planning.devices import figure
from mmrs_core.scene import DISTANCE, Position, RobotType
from mmrs_runtime.records.entries import number_of

TAKEN, UNCONFIRMED, SIMULATED = "taken", "not confirmed", "simulated"
_LIKE_PHOTO = re.compile(r"photo|picture|image|snap|capture|trigger", re.IGNORECASE)
Act: TypeAlias = tuple[float, Move, Action]
"""When an action was carried out, for which move, and which."""

_MATCHING = 10.0
"""Seconds between the step that commanded a photo and its confirmation, at most."""


@dataclass(frozen=True, slots=True)
class Shot:
    """A photo.

    Attributes:
        time: of its confirmation, else of the step that commanded it; seconds of the run.
        at: the position that the vehicle reported, else that of the robot; None where unknown.
        state: ``taken``, ``not confirmed``, or ``simulated``.
        index: the vehicle's own; None where it has none.
        move, task: that it was commanded for; empty for others.
        action: that commanded it; None for those others.
    """

    time: float
    at: Position | None
    state: str
    index: int | None = None
    move: str = ""
    task: str = ""
    action: Action | None = None


def shots_in(
    program: Program, flight: Flight, types: Mapping[str, RobotType], contributions: Contributions
) -> dict[str, tuple[Shot, ...]]:
    """Return all photos of a flight, by robot; types by name, as far as known."""
    kinds, known = contributions.robot_kinds, tuple(contributions.vehicles.values())
    return {
        robot.id: shots_of(
            robot,
            flown := flight.robots[robot.id],
            datum_of(robot, program, types.get(robot.type_name), flown.vehicle, kinds),
            types.get(robot.type_name),
            known,
        )
        for robot in program.robots
    }


def shots_of(
    robot: RobotProgram,
    flown: Flown,
    datum: Datum,
    robot_type: RobotType | None = None,
    vehicles: Iterable[VehicleFactory] = (),
) -> tuple[Shot, ...]:
    """Return all photos of a robot by time, each commanded one matched with the nearest confirmation."""
    done = SIMULATED if flown.simulated else TAKEN
    taken = [*_taken(flown, datum, done)]
    shots: list[Shot] = []
    known = tuple(vehicles)
    acts = [act for act in acts_of(robot, flown) if takes_photo(act[2], robot_type, known)]
    for time, move, action in _each_photo(acts, flown, [shot.time for shot in taken]):
        near = min(taken, key=lambda shot: abs(shot.time - time), default=None)
        if near is not None and abs(near.time - time) <= _MATCHING:
            taken.remove(near)
            shots.append(Shot(near.time, near.at, done, near.index, move.id, move.task, action))
        else:
            state = done if flown.simulated or _devices_confirm(flown) else UNCONFIRMED
            shots.append(Shot(time, flown.track.at(time), state, None, move.id, move.task, action))
    return tuple(sorted([*shots, *taken], key=lambda shot: shot.time))


def takes_photo(action: Action, robot_type: RobotType | None, vehicles: Iterable[VehicleFactory]) -> bool:
    """Return whether an action takes photos: by its device on these vehicles, else by its name."""
    if not action.device:
        return False
    found = (each.takes_photo(action, robot_type) for each in vehicles) if robot_type is not None else ()
    known = [taken for taken in found if taken is not None]
    return any(known) if known else bool(_LIKE_PHOTO.search(action.name))


def _each_photo(acts: Iterable[Act], flown: Flown, taken: Sequence[float]) -> Iterator[Act]:
    """Yield the acts that take a photo, and after those by distance, when the next ones were due.

    Args:
        taken: when the vehicle has confirmed photos.
    """
    repeated: dict[str, tuple[Act, float]] = {}
    for act in acts:
        device = act[2].device
        if device in repeated:
            begun, every = repeated.pop(device)
            yield from ((at, *begun[1:]) for at in flown.track.times_at_each(every, begun[0], act[0], taken))
        yield act
        distance = figure(dict(act[2].parameters), DISTANCE)
        if distance is not None:
            repeated[device] = act, distance
    for begun, every in repeated.values():
        yield from ((at, *begun[1:]) for at in flown.track.times_at_each(every, begun[0], flown.end, taken))


def _devices_confirm(flown: Flown) -> bool:
    """Return whether an action counts as done only once its device has reported so, as on a CAN bus."""
    return any(entry.content.get("confirms") is True for entry in flown.of_kind("start"))


def _taken(flown: Flown, datum: Datum, state: str) -> Iterator[Shot]:
    for entry in flown.of_kind("photo"):
        index = number_of(entry.content.get("index"))
        place = entry.content.get("place")
        # Cameras without a position report 0, 0.
        unknown = isinstance(place, dict) and not (place.get("latitude", 1) or place.get("longitude", 1))
        at = None if unknown else datum.position(place)
        at = at if at is not None else flown.track.at(entry.time)
        yield Shot(entry.time, at, state, None if index is None else int(index))


def acts_of(robot: RobotProgram, flown: Flown) -> Iterator[Act]:
    """Yield the device actions that a robot carried out by its log: when, for which move, and which."""
    moves = {move.id: move for move in robot.moves}
    for record in flown.records:
        if record.label == "act":
            move = moves[record.move]
            yield record.time, move, move.action(record.detail)
