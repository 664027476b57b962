"""Ways back: only where the robot's program has led, or still leads, since nobody has checked others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from ..places import at_height, distance, distance_to_leg, ends_of
from ..program import GoTo, Hold, Land, Object, Place, Robot, Skip, Step, Stop, Then, Turn

NEAR = 1.0
"""Metres within which two places of a way are one, and a robot is on a leg."""

Track = Sequence[tuple[str, Place]]
_STAYS = (Hold, Turn, Skip)


def way_back(robot: Robot, response: str, track: Track, here: Place | None = None) -> Iterator[Place]:
    """Yield the places by which a robot goes back, the last one above where it comes down.

    Args:
        robot: its program.
        response: ``RETURN`` or ``EMERGENCY_AREA``; to any other there is no way.
        track: the places that it has passed in this sortie, with the moves that ended there.
        here: where it is; None: where its track ends.
    """
    for _, place in steps_back(robot, response, track, here):
        yield place


def steps_back(
    robot: Robot, response: str, track: Track, here: Place | None = None
) -> Iterator[tuple[int | None, Place]]:
    """Yield the places of the way back, each with its number in the track; None: it is not on it.

    The way is cut short wherever it comes back to a place that it has passed before. A robot that is
    above the place where it took off has none, and one that is nearer to the end of its programmed way
    home goes on to that.
    """
    if response not in ("RETURN", "EMERGENCY_AREA") or not track:
        return
    if response == "EMERGENCY_AREA":
        yield from _to_area(robot, track, here)
        return
    start = track[-1][1] if here is None else here
    if _above(start, track[0][1]):
        return
    back = [(index, track[index][1]) for index in _cut_short(track, here)]
    ahead = _home_ahead(robot, track)
    if ahead and here is not None and _length(here, ahead) < _length(here, [place for _, place in back]):
        yield from ((None, place) for place in ahead)
    else:
        yield from back


def _to_area(robot: Robot, track: Track, here: Place | None) -> Iterator[tuple[int | None, Place]]:
    escapes = dict(robot.escapes)
    for index in _cut_short(track, here):
        move, place = track[index]
        yield index, place
        if move in escapes:
            yield None, escapes[move]
            return


def _cut_short(track: Track, here: Place | None) -> Iterator[int]:
    """Yield the numbers of the places of a track, from where the robot is back to the first one."""
    index = len(track) - 1 if here is None else _joined(track, here)
    while index >= 0:
        yield index
        same = (i for i in range(index + 1) if distance(track[i][1], track[index][1]) <= NEAR)
        index = next(same, index) - 1


def _joined(track: Track, here: Place) -> int:
    """Return the number of the place that begins the first leg of the track on which the robot is."""
    for index, ((_, a), (_, b)) in enumerate(pairwise(track)):
        if distance_to_leg(here, a, b) <= NEAR:
            return index
    return len(track) - 1


def _home_ahead(robot: Robot, track: Track) -> list[Place]:
    """Return the rest of the programmed way to where the robot took off; empty where it leads elsewhere."""
    steps = {step.move: step for step in robot.steps}
    move, here = track[-1]
    step: Step | None = steps.get(move)
    places: list[Place] = []
    if step is not None and isinstance(step.movement, GoTo) and not _ends_at(step.movement, here):
        places += _ends(here, step.movement) or []
    for _ in robot.steps:
        if step is None or not isinstance(step.then, Then):
            return []
        step = steps.get(step.then.move)
        movement = step.movement if step is not None else None
        if isinstance(movement, GoTo):
            more = _ends(places[-1] if places else here, movement)
            if more is None:
                return []
            places += more
        elif isinstance(movement, Land | Stop):
            return places if places and _above(places[-1], track[0][1]) else []
        elif not isinstance(movement, _STAYS):
            return []
    return []


def _ends(here: Place, movement: GoTo) -> list[Place] | None:
    if isinstance(movement.at, Object):
        return None
    return list(ends_of(here, movement.at, movement.legs, movement.distance))


def _ends_at(movement: GoTo, place: Place) -> bool:
    return isinstance(movement.at, Object) or distance(movement.at, place) <= NEAR + movement.distance


def _above(place: Place, below: Place) -> bool:
    return distance(at_height(place, 0.0), at_height(below, 0.0)) <= NEAR


def _length(here: Place, places: Sequence[Place]) -> float:
    return sum(distance(a, b) for a, b in pairwise([here, *places]))
