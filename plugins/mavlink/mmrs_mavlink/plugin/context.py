"""What targets for vehicles of these classes know of one robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.resources import files
from pathlib import Path

from mmrs_core.behaviour.program import Action, Move, MoveTarget, RobotProgram
from mmrs_core.contributions.rules import Medium, MoveKind
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.context import RobotContext
from mmrs_core.scene import Name, Position
from mmrs_mavlink.plugin.vehicles import manoeuvre_of, profile_of, uncarried
from mmrs_mavlink.plugin.wiring import wiring_of
from mmrs_mavlink.profiles import ARDUROVER, VehicleProfile
from mmrs_mavlink.wiring import Wiring, Wirings


def templates_of(target: str) -> Path:
    """Return the folder of a target's templates."""
    return Path(str(files("mmrs_mavlink"))) / "templates" / target


@dataclass(frozen=True)
class VehicleContext(RobotContext):
    """One robot of a behaviour, and the profile of the vehicle that carries it.

    Attributes:
        wirings: those of plug-ins.
        moves: kinds of moves, by metaclass.
    """

    profile: VehicleProfile = ARDUROVER
    wirings: Wirings = field(default_factory=dict)
    moves: Mapping[Name, MoveKind] = field(default_factory=dict)

    def wiring(self, action: Action) -> Wiring:
        """Return how a device action of the robot is carried out."""
        return wiring_of(action, self.type, self.wirings)

    def manoeuvre(self, move: Move) -> str:
        """Return what the vehicle does to make a move; empty where the kind of the move does not state it."""
        return manoeuvre_of(move.metaclasses[0], self.moves)

    def climb(self, move: Move) -> float:
        """Return how far a move climbs, metres; 0 for one without a movement of its own."""
        path = self.path(move)
        return path[-1][2] if path else 0.0

    def path(self, move: Move) -> tuple[Position, ...] | None:
        """Return the path of a move from the origin, whatever the home; None where it is unknown."""
        return self.moves[move.metaclasses[0]].path(move, (0.0, 0.0, 0.0), None)

    def legs(self, move: Move) -> str:
        """Return how a move goes to a target at another height: ``direct``, ``level first``, ``climb first``.

        These are the paths with at most one corner, above or below an end; any other counts as direct.
        """
        east, north, up = goal = (10.0, 10.0, 10.0)
        leading = replace(move, target=MoveTarget(goal), distance=0.0)
        path = self.moves[move.metaclasses[0]].path(leading, (0.0, 0.0, 0.0), None)
        corners = {(east, north, 0.0): "level first", (0.0, 0.0, up): "climb first"}
        return corners.get(path[1], "direct") if path is not None and len(path) == 3 else "direct"


def context_of(robot: RobotProgram, input: TargetInput) -> VehicleContext:
    """Return what there is to know of a robot.

    Raises:
        UnsupportedError: no vehicle carries the robot.
    """
    type = input.types.get(robot.type_name)
    profile = _profile_of(robot, input)
    if profile is None:
        raise UnsupportedError(vehicleless(robot, input))
    frame = input.program.frame
    home = robot.home[2] if robot.home is not None else 0.0
    zero = frame.surface if profile.dives else home
    medium: Medium = "air" if profile.flies else "water" if profile.dives else "ground"
    wirings = input.extensions.get("device_actions", {})
    return VehicleContext(robot, type, frame, zero, medium, profile, wirings, input.move_kinds)


def vehicleless(robot: RobotProgram, input: TargetInput) -> str:
    """Return why no vehicle carries a robot; empty where one does."""
    return uncarried(robot.id, input.types.get(robot.type_name), input.robot_kinds, input.extensions)


def neighbours_of(robot: RobotProgram, input: TargetInput) -> tuple[tuple[str, Position], ...]:
    """Return the homes on the Earth of other robots with vehicles of the same profile, by robot."""
    if input.program.frame.is_local:
        return ()
    profiles = {each.id: _profile_of(each, input) for each in input.program.robots}
    return tuple(
        (each.id, each.home)
        for each in input.program.robots
        if each.id != robot.id and each.home is not None and profiles[each.id] == profiles[robot.id]
    )


def _profile_of(robot: RobotProgram, input: TargetInput) -> VehicleProfile | None:
    type = input.types.get(robot.type_name)
    return profile_of(robot, type, input.robot_kinds, input.move_kinds, input.extensions)
