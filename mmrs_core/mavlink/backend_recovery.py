"""The way back to where a robot's program was broken off: as it came, from its last take-off on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import hypot

from mmrs_core.flight.faults import Refused
from mmrs_core.flight.places import distance, ends_of, offset
from mmrs_core.flight.program import GoTo, Land, Place, Recharge, Robot, Start, TakeOff
from mmrs_core.flight.vehicle import Vehicle
from mmrs_core.mavlink.backend_moves import IN_THE_AIR, Moves
from mmrs_core.mavlink.backend_worker import Job

ON_THE_WAY = 5.0
"""Metres that a vehicle may be off the way that it came, to go on from there."""


def sortie_of(robot: Robot, passed: Sequence[str]) -> tuple[str, ...]:
    """Return the moves since the robot stood where its batteries can be changed, the last of them last."""
    steps = {step.move: step.movement for step in robot.steps}
    begin = 0
    for index, move in enumerate(passed):
        movement = steps[move]
        if isinstance(movement, Land | Recharge | Start):
            begin = index + 1
        elif isinstance(movement, TakeOff):
            begin = index
    return tuple(passed[begin:])


def way_back(robot: Robot, moves: Moves, vehicle: Vehicle, passed: Sequence[str], begun: str) -> Job:
    """Return what brings a vehicle to where it was when it ended the last of these moves.

    A vehicle on the ground takes off and flies the whole way. One that is on its way goes on from
    there; one that is anywhere else is refused, since nobody has checked a way from there.

    Args:
        robot: its program.
        moves: of the same vehicle.
        vehicle: ready to move.
        passed: moves that the robot has ended, in order.
        begun: the move that it will begin once more; may be empty.
    """
    job = Job()

    def look_up() -> None:
        sortie = sortie_of(robot, passed)
        here = vehicle.state().place
        lands = bool(begun) and moves.kind(begun) is Land
        if not sortie or (lands and here.height <= IN_THE_AIR):
            return
        way = list(_places(robot, moves, sortie))
        first, climbs = _joins(robot, here, way)
        moves.track = list(way[:first])
        if climbs is not None:
            move, height = climbs
            job.then(lambda: moves.climb(move, height), *_legs(moves, vehicle, way[1:]))
        else:
            job.then(*_legs(moves, vehicle, way[first:]))

    job.append(look_up)
    return job


def _joins(
    robot: Robot, here: Place, way: Sequence[tuple[str, Place]]
) -> tuple[int, tuple[str, float] | None]:
    """Return from which place of the way on it is flown, and the take-off where there must be one.

    Raises:
        Refused: the vehicle is neither on the ground nor on its way.
    """
    steps = {step.move: step.movement for step in robot.steps}
    first = steps[way[0][0]]
    if isinstance(first, TakeOff) and here.height <= IN_THE_AIR:
        return 0, (way[0][0], first.height)
    places = [robot.home, *(place for _, place in way)]
    gaps = [_gap(here, places[i], places[i + 1]) for i in range(len(places) - 1)]
    nearest = min(range(len(gaps)), key=gaps.__getitem__)
    if gaps[nearest] > ON_THE_WAY:
        raise Refused(
            f"the vehicle is {gaps[nearest]:.0f} m off the way that it came; bring it home before it goes on"
        )
    return nearest, None


def _places(robot: Robot, moves: Moves, sortie: Sequence[str]) -> Iterator[tuple[str, Place]]:
    steps = {step.move: step.movement for step in robot.steps}
    here = robot.home
    for move in sortie:
        movement = steps[move]
        if isinstance(movement, TakeOff):
            here = moves.above_home(movement.height)
            yield move, here
        elif isinstance(movement, GoTo):
            for end in ends_of(here, moves.target_of(movement), movement.legs, movement.distance):
                here = end
                yield move, end


def _legs(moves: Moves, vehicle: Vehicle, way: Sequence[tuple[str, Place]]) -> list[Callable[[], None]]:
    def leg(move: str, place: Place) -> Callable[[], None]:
        def go() -> None:
            vehicle.go_to(place, moves.speed_of(move), None, True)
            moves.track.append((move, place))

        return go

    return [leg(move, place) for move, place in way]


def _gap(here: Place, a: Place, b: Place) -> float:
    """Return the metres from a place to a straight leg."""
    whole, part = offset(a, b), offset(a, here)
    length = distance(a, b)
    share = sum(p * w for p, w in zip(part, whole, strict=True)) / length**2 if length else 0.0
    share = min(1.0, max(0.0, share))
    return hypot(*(p - share * w for p, w in zip(part, whole, strict=True)))
