"""What a target knows of one robot, gathered once."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from mmrs_core.behaviour.earth import degrees_of, metres
from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.behaviour.travel import speed_of
from mmrs_core.contributions.rules import Medium, robot_kind_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.scene import Frame, Point, Position, RobotType


class Degrees:
    """Latitudes and longitudes of points of a frame, each found once: many at a time cost as much as one."""

    def __init__(self, frame: Frame, points: Sequence[Point]) -> None:
        """Find them when the first of them is asked for."""
        self._frame, self._awaited, self._known = frame, points, dict[Point, tuple[float, float]]()

    def at(self, point: Point) -> tuple[float, float]:
        """Return the latitude and longitude of an (east, north) point, in degrees of WGS 84.

        Raises:
            UnsupportedError: the frame has no place on the Earth.
        """
        if point not in self._known:
            self.find([point, *self._awaited])
            self._awaited = ()
        return self._known[point]

    def find(self, points: Iterable[Point]) -> None:
        """Find those of more points, in advance."""
        new = [point for point in dict.fromkeys(points) if point not in self._known]
        self._known |= zip(new, degrees_of(new, self._frame), strict=True)


@dataclass(frozen=True)
class RobotContext:
    """One robot of a behaviour, and where it is.

    Attributes:
        type: None where it was not given.
        zero: height of the robot's own zero above the origin, metres: its home, or the water surface.
        medium: what it moves in.
    """

    robot: RobotProgram
    type: RobotType | None
    frame: Frame
    zero: float
    medium: Medium = "ground"

    @cached_property
    def degrees(self) -> Degrees:
        """Return what knows latitudes and longitudes of its home, and of where its moves lead and look."""
        return Degrees(self.frame, _points(self.robot))

    @property
    def flies(self) -> bool:
        """Return whether the robot moves in the air."""
        return self.medium == "air"

    @property
    def dives(self) -> bool:
        """Return whether the robot moves in water."""
        return self.medium == "water"

    def height(self, position: Position) -> float:
        """Return a position's height above the robot's own zero, metres."""
        return metres(position[2] - self.zero)

    def speed(self, move: Move) -> float | None:
        """Return a move's commanded speed in metres per second; None where it is not known."""
        found = speed_of(move, self.robot, self.type)
        return None if found is None else metres(found)

    def label(self, move: Move) -> str:
        """Return how messages name a move of the robot."""
        return f"robot '{self.robot.id}', move '{move.id}'"


def context_of(robot: RobotProgram, input: TargetInput) -> RobotContext:
    """Return the context of a robot."""
    medium, frame = medium_of(robot, input), input.program.frame
    home = robot.home[2] if robot.home is not None else 0.0
    zero = frame.surface if medium == "water" else home
    return RobotContext(robot, input.types.get(robot.type_name), frame, zero, medium)


def medium_of(robot: RobotProgram, input: TargetInput) -> Medium:
    """Return what a robot moves in: by the kind of its type, else by its moves."""
    type = input.types.get(robot.type_name)
    kind = robot_kind_of(type, input.robot_kinds) if type is not None else None
    if kind is not None:
        return kind.medium
    known = (input.move_kinds.get(move.metaclasses[0]) for move in robot.moves)
    return "air" if any(each is not None and each.leaves == "airborne" for each in known) else "ground"


def uncarried(robot: RobotProgram, input: TargetInput, vehicles: Collection[str]) -> str:
    """Return why no vehicle of these classes carries a robot; empty where its kind names one of them.

    A robot of unknown type or kind is not refused.
    """
    type = input.types.get(robot.type_name)
    kind = robot_kind_of(type, input.robot_kinds) if type is not None else None
    if kind is None or kind.vehicle in vehicles:
        return ""
    named = f"names vehicle '{kind.vehicle}'" if kind.vehicle else "names no vehicle"
    known = ", ".join(sorted(vehicles))
    return (
        f"robot '{robot.id}': is of kind '{kind.name}', which {named}; known are {known} (RobotKind.vehicle)"
    )


def homeless(robot: RobotProgram) -> str:
    """Return the refusal of a robot without a home."""
    return f"robot '{robot.id}': its home is not known, and heights count from there"


def require_home(robot: RobotProgram) -> Position:
    """Return a robot's home.

    Raises:
        UnsupportedError: it has none.
    """
    if robot.home is None:
        raise UnsupportedError(homeless(robot))
    return robot.home


def _points(robot: RobotProgram) -> list[Point]:
    positions = [robot.home]
    for move in robot.moves:
        positions.append(move.target.position if move.target else None)
        positions.append(move.heading.target.position if move.heading else None)
    return [(position[0], position[1]) for position in positions if position is not None]
