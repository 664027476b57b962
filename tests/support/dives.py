"""Dives of simulated vehicles, and what came of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from mmrs_auv.backend import CAN_SIM
from mmrs_auv.backend.rehearsed import RehearsedRobot, rehearsed
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.plugin import mmrs_metamodels
from mmrs_multicopter.testing import robot_program

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Move, MoveTarget, Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.execution import Condition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.grounding.scenes import robot_type_of
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import registry_with
from mmrs_core.scene import Area, Frame, RobotType
from mmrs_core.simulation.run import SimulatedRun, simulate
from mmrs_core.testing.programs import move, program
from mmrs_core.transformation.kinds import MOVE_KINDS
from mmrs_runtime.records.log import LogWriter

POOL = Frame("EPSG:4326", 41.18, -8.7, 0.0, "MSL", surface=0.0)
TYPE = Path(__file__).parents[2] / "examples/pool/robots/pool-auv.xmi"


def diver() -> RobotType:
    """Return the type of the example of a pool."""
    root = read_model(TYPE, registry_with(mmrs_metamodels())).roots[0]
    return robot_type_of(root)  # type: ignore[arg-type]


def swim(id: str, east: float, north: float, depth: float, **changes: object) -> Move:
    """Return a GoTo to a place in the pool."""
    made = replace(move(id, "GoTo"), target=MoveTarget((east, north, -depth)), speed=0.5)
    return replace(made, **changes)  # type: ignore[arg-type]


def dive(*moves: Move, **options: object) -> Program:
    """Return a behaviour of one vehicle that begins at the origin, 0.5 m down."""
    options = {"home": (0.0, 0.0, -0.5), "type_name": "Pool AUV", **options}
    return program(robot_program("naiad", moves, **options), name="dive", frame=POOL)  # type: ignore[arg-type]


@dataclass
class Rehearsed:
    """A run, whether its logs are what the behaviour says, and the robots that made it."""

    run: SimulatedRun
    accepted: bool
    robots: Mapping[str, RehearsedRobot]

    @property
    def fault(self) -> str:
        return next((found.which for found in self.run.ending.faults.values()), "")


def rehearse(
    behaviour: Program,
    folder: Path,
    before: Callable[[RehearsedRobot], None] = lambda robot: None,
    conditions: Mapping[str, Condition] | None = None,
    areas: tuple[Area, ...] = (),
    **options: str,
) -> Rehearsed:
    """SimulatedRun a behaviour with simulated vehicles; `before` may meddle with them."""
    robots: dict[str, RehearsedRobot] = {}
    kind = diver()

    def connect(given: VehicleInput) -> RehearsedRobot:
        robot = robots[given.robot.id] = rehearsed(given)
        before(robot)
        return robot

    kinds = {AUV_KIND.metaclass: AUV_KIND}, {each.metaclass: each for each in MOVE_KINDS}
    given = TargetInput(behaviour, {kind.name: kind}, *kinds, areas=areas)
    backend = replace(CAN_SIM, connect=connect)
    done = simulate(given, backend, options=options, conditions=conditions)
    with LogWriter(folder) as writer:
        for record in done.records:
            writer.write(record)
    return Rehearsed(done, replay(behaviour, read_logs([folder])).accepted, robots)
