"""Where the robots of a behaviour come down in an emergency: each of them elsewhere, if there is room."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.geometry.refuges import refuge_points
from mmrs_core.scene import Area, AreaUse, Point, RobotType


@dataclass(frozen=True, slots=True)
class Refuges:
    """Where a robot comes down in an emergency.

    Attributes:
        points: (east, north) of one in each emergency area that is large enough, metres.
        shared: what people must know of them; empty where all of them are the robot's own.
    """

    points: tuple[Point, ...] = ()
    shared: str = ""


def refuges_of(
    robot: RobotProgram,
    program: Program,
    types: Mapping[str, RobotType],
    areas: Iterable[Area],
    spare: float = 0.0,
) -> Refuges:
    """Return where a robot comes down: each of the fleet at points of its own, far from one another.

    They are at least the mission's minimum separation apart, and so far that no two robots touch. Above
    and below them nothing is in the way, and no robot comes too near to a forbidden area.

    Args:
        robot: of the program.
        program: of the whole fleet.
        types: of robots, by name, as far as they are known.
        areas: of the context as drawn, those to keep from as well.
        spare: metres to the edges of areas beside what must be kept.
    """
    clearance = {each.id: _clearance(each, program, types) for each in program.robots}
    widest = max(clearance.values()) + spare
    apart = max(2.0 * widest, program.minimum_separation or 0.0)
    heeded = [area for area in areas if area.concerns(robot.type_name)]
    own = [area for area in heeded if area.use is AreaUse.EMERGENCY]
    number, count = list(clearance).index(robot.id), len(clearance)
    low, high = _heights(program)
    others = [a for a in heeded if a.use is not AreaUse.EMERGENCY and a.low <= high and a.high >= low]

    def found_in(area: Area, keep: float, count: int) -> tuple[Point, ...]:
        barred = [(area.shell, area.safety_distance + keep) for area in others]
        return refuge_points(area.shell, area.safety_distance + keep, apart, count, barred)

    found = [found_in(area, widest, count) for area in own]
    if points := tuple(places[number] for places in found if number < len(places)):
        return Refuges(points)
    keep = clearance[robot.id] + spare
    alone = {area.name: found_in(area, keep, 1) for area in own}
    names = ", ".join(f"'{name}'" for name, places in alone.items() if places)
    words = f"in an emergency it may come down where others do: there is no room for all of them in {names}"
    shared = words if names and count > 1 else ""
    return Refuges(tuple(places[0] for places in alone.values() if places), shared)


def _clearance(robot: RobotProgram, program: Program, types: Mapping[str, RobotType]) -> float:
    type = types.get(robot.type_name)
    return program.position_error + (type.half_diagonal if type is not None else 0.0)


def _heights(program: Program) -> tuple[float, float]:
    """Return the lowest and the highest place of the fleet's moves, homes and the origin, metres."""
    homes = [robot.home for robot in program.robots]
    targets = [move.target.position for robot in program.robots for move in robot.moves if move.target]
    heights = [0.0, *(place[2] for place in (*homes, *targets) if place is not None)]
    return min(heights), max(heights)
