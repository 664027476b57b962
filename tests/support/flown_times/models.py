"""Models of a recorded flight, and how long a robot of it is planned to take."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from math import dist
from pathlib import Path

from mmrs_core.analysis.durations import Duration, durations_of
from mmrs_core.analysis.figures import move_kind_of, seconds_of
from mmrs_core.analysis.motion import motions
from mmrs_core.behaviour.program import BEHAVIOUR, RobotProgram
from mmrs_core.cli.behaviours import Loaded, load_behaviour
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.passages import runs_of
from mmrs_core.contributions.rules import RobotKind
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.timing import as_uploaded
from mmrs_core.generation.planned_moves import planned_moves
from mmrs_core.scene import Device, Kinematics, Name, Position, Robot, Scene
from mmrs_mavlink.limits import Limit
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.plans.flight import sorties_of
from mmrs_mavlink.plugin.plans.items import PlanItem, Row, rows_of
from mmrs_mavlink.plugin.plans.surroundings import missions_of

ACCEPTANCE = {"rover-arcs-acceptance-1": 1.0}
"""Metres at which places counted as reached on flights for which ``--acceptance`` was given."""

SPEEDS = {"sub-auto": {"goto_001": 1.0, "goto_002": 1.0}}
"""Speeds of moves, metres per second, that tracks show where others were commanded: that vehicle took no
notice of the change of speed before the first leg of its mission."""

RECHARGE = (BEHAVIOUR, "Recharge")


@dataclass(frozen=True, slots=True)
class Estimate:
    """How long a move is planned, and checked, to take, seconds.

    Attributes:
        moving: expected of its movement.
        whole: expected with its actions.
        bounds: of the check.
    """

    moving: float
    whole: float
    bounds: Duration

    @property
    def least(self) -> float:
        return self.bounds.moved.low - self.bounds.before.low

    @property
    def most(self) -> float:
        return self.bounds.moved.high - self.bounds.before.high


@cache
def opened(folder: Path, *, px4: bool = False) -> tuple[Session, Loaded]:
    """Return the models of a flight; `px4`: its types state that autopilot."""
    session = Session(Settings())
    loaded = load_behaviour(session, folder / "behaviour.xmi")
    if px4:
        pilot = Device("autopilot", {}, {"mavlink.autopilot": "px4"})
        types = {
            name: replace(each, devices={**each.devices, "autopilot": pilot})
            for name, each in loaded.place.types.items()
        }
        loaded = replace(loaded, place=replace(loaded.place, types=types))
    return session, loaded


def _accepting(
    of: Callable[[Robot, Scene], Kinematics], metres: float, robot: Robot, scene: Scene
) -> Kinematics:
    return replace(of(robot, scene), accepts=metres)


class Modelled:
    """One robot of a flight as it is modelled."""

    def __init__(
        self,
        session: Session,
        loaded: Loaded,
        robot: RobotProgram,
        accepts: float | None = None,
        speeds: Mapping[str, float] | None = None,
    ) -> None:
        self.robot, self._accepts, self._speeds = robot, accepts, speeds or {}
        self._contributions, self._program, self._place = session.contributions, loaded.program, loaded.place

    @cached_property
    def legs(self) -> Mapping[str, tuple[Position, ...]]:
        """The paths of the moves that lead somewhere, from the robot's home, by move."""
        home = self.robot.home or (0.0, 0.0, 0.0)
        return {
            self.robot.moves[path.move].id: tuple(
                (p[0] - home[0], p[1] - home[1], p[2] - home[2]) for p in path.points
            )
            for path in motions(self._check(uploaded=False))[self.robot.id].paths
            if dist(path.points[0], path.points[-1]) > 0.0
        }

    @cached_property
    def runs(self) -> list[list[str]]:
        """The runs of the robot, as moves."""
        found = runs_of(self.robot, self._place.types[self.robot.type_name], self._contributions.move_kinds)
        return [[self.robot.moves[index].id for index in run] for run in found]

    @cached_property
    def stays(self) -> set[str]:
        """Moves that last for a time of the program's clock, where the robot is, and are no part of a run."""
        flown = {move for run in self.runs for move in run}
        return {
            move.id
            for move in self.robot.moves
            if move.id not in flown and move.is_a((BEHAVIOUR, "HoldPosition"))
        }

    @cached_property
    def stepped(self) -> set[str]:
        """The moves whose ends show on a track: those that lead to places and are no part of a run."""
        flown = {move for run in self.runs for move in run}
        return {
            move.id
            for move in self.robot.moves
            if move.id not in flown and move.target is not None and move.target.position is not None
        }

    @property
    def takes_off(self) -> bool:
        """Whether the robot takes off."""
        kinds = (move_kind_of(self._check(uploaded=False), move) for move in self.robot.moves)
        return any(kind is not None and kind.manoeuvre == "take_off" for kind in kinds)

    def items(self) -> tuple[PlanItem, ...]:
        """Return the items of the robot's mission."""
        (items, *_) = sorties_of(context_of(self.robot, self._target(uploaded=False)))
        return items

    def rows(self) -> tuple[Row, ...]:
        """Return the items of the robot's mission as files hold them."""
        return rows_of(context_of(self.robot, self._target(uploaded=False)), self.items())

    def limits(self) -> tuple[Limit, ...]:
        """Return what the vehicle must be set to before the robot's mission."""
        missions = missions_of(self._target(uploaded=True))
        return next(each.limits for each in missions if each.context.robot.id == self.robot.id)

    def estimates(self, *, uploaded: bool) -> dict[str, Estimate]:
        """Return how long each move takes but charging, which an operator ends; `uploaded`: as a mission."""
        check = self._check(uploaded=uploaded)
        flown = (replace(move, speed=self._speeds.get(move.id, move.speed)) for move in self.robot.moves)
        robot = replace(self.robot, moves=tuple(flown))
        durations = durations_of(check, robot, motions(check)[robot.id]).of
        type = self._place.types[self.robot.type_name]
        found: dict[str, Estimate] = {}
        for each in planned_moves(robot, self._target(uploaded=uploaded)):
            move = robot.moves[each.index]
            if each.seconds is not None and not move.is_a(RECHARGE):
                acting = sum(seconds_of(action, type) or 0.0 for action in (*move.before, *move.after))
                whole = each.seconds.expected
                found[move.id] = Estimate(whole - acting, whole, durations[each.index])
        return found

    def _kinds(self, *, uploaded: bool) -> Mapping[Name, RobotKind]:
        kinds = self._contributions.robot_kinds
        if self._accepts is not None:
            kinds = {
                name: replace(kind, kinematics=partial(_accepting, kind.kinematics, self._accepts))
                for name, kind in kinds.items()
            }
        return as_uploaded(kinds) if uploaded else kinds

    def _target(self, *, uploaded: bool) -> TargetInput:
        return TargetInput(
            self._program,
            self._place.types,
            self._kinds(uploaded=uploaded),
            self._contributions.move_kinds,
            extensions=self._contributions.extensions,
            environment=self._place.environment or {},
            areas=self._place.areas or (),
            elements=self._place.elements,
        )

    def _check(self, *, uploaded: bool) -> CheckInput:
        return CheckInput(
            self._program,
            self._place.types,
            self._kinds(uploaded=uploaded),
            self._contributions.move_kinds,
            self._place.areas,
            self._place.environment or {},
            self._place.elements,
        )
