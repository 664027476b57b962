"""What of a robot's program is uploaded: runs as one mission, the fence, the rally points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import ceil

from mmrs_runtime.controllers.geodesy import at_height

from ..program import Geographic, GoTo, Look, Object, Place, Robot, Run, TakeOff
from .items import CHANGE_SPEED, FENCE_VERTEX, LOITER, NO_FRAME, RALLY_POINT, WAYPOINT, Item


@dataclass(frozen=True, slots=True)
class UploadedRun:
    """Where a run lies in the mission.

    Attributes:
        first, last: sequence numbers of its items; the item after the last makes the vehicle wait.
        ends: by sequence number, the move that has ended when the item is behind.
        look: where the vehicle or a gimbal on it looks all along; None: the vehicle looks where it goes.
    """

    run: Run
    first: int
    last: int
    ends: dict[int, str]
    look: Look | None = None


@dataclass(frozen=True, slots=True)
class Uploads:
    """All of a program that its vehicle must know before it begins.

    Attributes:
        mission: of all runs; empty where there are none.
        flights: by first move of a run, where it lies in the mission.
        fence: polygons that the vehicle must stay out of. rally: where it may go in an emergency.
        words: what people must know of the fence.
        places: all that the program leads to, which the vehicle's own fences must leave free.
        speed: metres per second, the largest that the program commands.
    """

    mission: tuple[Item, ...] = ()
    flights: Mapping[str, UploadedRun] = field(default_factory=dict)
    fence: tuple[Item, ...] = ()
    rally: tuple[Item, ...] = ()
    places: tuple[Place, ...] = ()
    words: tuple[str, ...] = ()
    speed: float = 0.0


def uploads_of(robot: Robot, *, fenced: bool = True) -> Uploads:
    """Return what a robot's vehicle must know; `fenced`: the areas to stay out of, too."""
    mission, flights = mission_of(robot)
    fence = fence_of(robot) if fenced else ()
    words = robot.tight if fenced else ()
    return Uploads(mission, flights, fence, rally_of(robot), places_in(robot), words, speed_of(robot))


def mission_of(robot: Robot) -> tuple[tuple[Item, ...], dict[str, UploadedRun]]:
    """Return the mission of all runs, and by first move where each lies in it; both may be empty.

    After each run the vehicle waits where it is until the program continues. The mission has no
    take-off, so that a vehicle on the ground never begins it on its own.
    """
    if not robot.runs:
        return (), {}
    items = [_positional(WAYPOINT, robot.home)]
    flights: dict[str, UploadedRun] = {}
    for run in robot.runs:
        first, ends = len(items), dict[int, str]()
        for move, item in _items_of(robot, run):
            if item.command == WAYPOINT:
                ends[len(items)] = move
            items.append(item)
        last = robot.step(run.moves[-1]).movement
        assert isinstance(last, GoTo)
        flights[run.moves[0]] = UploadedRun(run, first, len(items) - 1, ends, last.look)
        assert isinstance(last.at, Geographic)
        items.append(_positional(LOITER, last.at))
    return tuple(items), flights


def fence_of(robot: Robot) -> tuple[Item, ...]:
    """Return the polygons that the vehicle must stay out of."""
    command = FENCE_VERTEX
    return tuple(
        _positional(command, vertex, float(len(polygon))) for polygon in robot.fence for vertex in polygon
    )


def places_in(robot: Robot) -> tuple[Place, ...]:
    """Return all places that a robot's program leads to, above home as far as it takes off to."""
    movements = [step.movement for step in robot.steps]
    gone = [each.at for each in movements if isinstance(each, GoTo) and not isinstance(each.at, Object)]
    climbed = [at_height(robot.home, each.height) for each in movements if isinstance(each, TakeOff)]
    return (*gone, *climbed)


def speed_of(robot: Robot) -> float:
    """Return the largest speed that a robot's program commands, metres per second."""
    movements = (step.movement for step in robot.steps)
    return max((each.speed or 0.0 for each in movements if isinstance(each, GoTo)), default=0.0)


def rally_of(robot: Robot) -> tuple[Item, ...]:
    """Return the places that the vehicle may go to in an emergency."""
    return tuple(_positional(RALLY_POINT, place) for place in robot.rally)


def _items_of(robot: Robot, run: Run) -> Iterator[tuple[str, Item]]:
    speed: float | None = None
    for move, hold in zip(run.moves, run.holds, strict=True):
        movement = robot.step(move).movement
        assert isinstance(movement, GoTo)
        assert isinstance(movement.at, Geographic)
        if movement.speed is not None and movement.speed != speed:
            speed = movement.speed
            yield move, Item(CHANGE_SPEED, (1.0, speed, -1.0, 0.0), frame=NO_FRAME)
        # Vehicles keep whole seconds and cut off the rest: less than one would be no hold at all.
        place = at_height(movement.at, robot.profile.item_height(movement.at.height))
        yield move, _positional(WAYPOINT, place, float(ceil(hold)))


def _positional(command: int, place: Place, first: float = 0.0) -> Item:
    assert isinstance(place, Geographic)
    x, y = round(place.latitude * 1e7), round(place.longitude * 1e7)
    return Item(command, (first, 0.0, 0.0, 0.0), x, y, place.height)
