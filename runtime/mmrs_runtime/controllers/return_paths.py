"""Return paths: only where the robot's program has led, or still leads, since no other path is verified."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from .geodesy import at_height, distance, distance_to_leg, ends_of
from .vocabulary import GoTo, Hold, Land, Object, Place, Robot, Skip, Step, Stop, Then, Turn

NEAR = 1.0
"""Metres within which two places of a way are one, and a robot is on a leg."""

ALIGNED = 0.1
"""Metres beside a straight leg at which a place lies on it."""

Track = Sequence[tuple[str, Place]]
Steps = list[tuple[int | None, Place]]
_STAYS = (Hold, Turn, Skip)


def way_back(robot: Robot, response: str, track: Track, here: Place) -> Iterator[Place]:
    """Yield the positions of a robot's return path, the last one above where it lands.

    Args:
        robot: its program.
        response: ``RETURN`` or ``EMERGENCY_AREA``; any other has no path.
        track: the positions that it has passed in this sortie, with the moves that ended there.
        here: its position.
    """
    for _, place in steps_back(robot, response, track, here):
        yield place


def steps_back(robot: Robot, response: str, track: Track, here: Place) -> Iterator[tuple[int | None, Place]]:
    """Yield the positions of the return path, each with its number in the track; None: it is not on it.

    The path is cut short wherever it comes back to a position that it has passed before, and leads straight
    through positions on one line. A robot above the position of its take-off has none, and one that
    is nearer to the end of its programmed return continues to that.
    """
    if response not in ("RETURN", "EMERGENCY_AREA") or not track:
        return
    found = _to_area(robot, track, here) if response == "EMERGENCY_AREA" else _home(robot, track, here)
    yield from _straight(here, found)


def _home(robot: Robot, track: Track, here: Place) -> Steps:
    if _above(here, track[0][1]):
        return []
    back: Steps = [(index, track[index][1]) for index in _cut_short(track, here)]
    return _shorter(here, back, [(None, place) for place in _home_ahead(robot, track)])


def _to_area(robot: Robot, track: Track, here: Place) -> Steps:
    escapes, back = dict(robot.escapes), Steps()
    for index in _cut_short(track, here):
        move, place = track[index]
        back.append((index, place))
        if move in escapes:
            back += [(None, place) for place in escapes[move]]
            break
    return _shorter(here, back, _area_ahead(robot, track, here))


def _shorter(here: Place, back: Steps, ahead: Steps) -> Steps:
    if not ahead:
        return back
    ways = [_length(here, [place for _, place in way]) for way in (back, ahead)]
    return ahead if ways[1] < ways[0] else back


def _area_ahead(robot: Robot, track: Track, here: Place) -> Steps:
    """Return the rest of the leg that the robot is on, and the path to an emergency area from its end."""
    steps = {step.move: step for step in robot.steps}
    move, begun = track[-1]
    step = steps.get(move)
    if step is not None and not (isinstance(step.movement, GoTo) and not _ends_at(step.movement, begun)):
        step = steps.get(step.then.move) if isinstance(step.then, Then) else None
    escape = dict(robot.escapes).get(step.move) if step is not None else None
    if step is None or escape is None or not isinstance(step.movement, GoTo):
        return []
    ends = _ends(begun, step.movement) or []
    legs = list(pairwise([begun, *ends]))
    on = next((i for i, leg in enumerate(legs) if distance_to_leg(here, *leg) <= NEAR), None)
    if on is None or distance(begun, here) <= NEAR:
        return []
    return [(None, place) for place in (*ends[on:], *escape)]


def _straight(start: Place, places: Steps) -> Iterator[tuple[int | None, Place]]:
    """Yield places without those on the straight line between the ones before and after them."""
    corner, passed = start, list[Place]()
    for (number, place), (_, following) in pairwise(places):
        passed.append(place)
        if any(distance_to_leg(each, corner, following) > ALIGNED for each in passed):
            corner, passed = place, []
            yield number, place
    yield from places[-1:]


def _cut_short(track: Track, here: Place) -> Iterator[int]:
    """Yield the numbers of the places of a track, from where the robot is back to the first one."""
    index = _joined(track, here)
    while index >= 0:
        yield index
        same = (i for i in range(index + 1) if distance(track[i][1], track[index][1]) <= NEAR)
        index = next(same, index) - 1


def _joined(track: Track, here: Place) -> int:
    """Return the number of the position that begins the first leg of the track on which the robot is."""
    for index, ((_, a), (_, b)) in enumerate(pairwise(track)):
        if distance_to_leg(here, a, b) <= NEAR:
            return index
    return len(track) - 1


def _home_ahead(robot: Robot, track: Track) -> list[Place]:
    """Return the rest of the programmed path to the position of take-off; empty where it leads elsewhere."""
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
