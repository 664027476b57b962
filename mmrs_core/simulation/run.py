"""Whole simulated runs: all robots of a behaviour with backends of one sort, from Start to the end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition, Sample
from mmrs_core.contributions.rules import MoveKind, RobotKind, robot_kind_of
from mmrs_core.contributions.vehicles import Recorder, VehicleFactory, VehicleInput
from mmrs_core.contributions.wiring import Wirings
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.scene import Area, Name, Policy, RobotType
from mmrs_core.simulation.conditions import refuse_undecided
from mmrs_core.simulation.mixed import options_for, refuse_strange
from mmrs_runtime.engine.clocks import SimulatedClock
from mmrs_runtime.engine.run import run
from mmrs_runtime.engine.terms import TO_THE_END, Ending, Terms
from mmrs_runtime.policies import in_precedence
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.slots import LocalSlots


@dataclass(frozen=True, slots=True)
class Run:
    """What happened in a run.

    Attributes:
        records: the steps, in the order in which they were made.
        ending: how it ended.
        tracks: by robot, the way that it came; empty where the backend does not tell.
        notes: what was taken for granted, each line with its robot.
    """

    records: tuple[StepRecord, ...]
    ending: Ending
    tracks: Mapping[str, tuple[Sample, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def simulate(
    program: Program,
    *,
    backend: VehicleFactory,
    types: Mapping[str, RobotType],
    robot_kinds: Mapping[Name, RobotKind],
    move_kinds: Mapping[Name, MoveKind],
    options: Mapping[str, str] | None = None,
    conditions: Mapping[str, Condition] | None = None,
    environment: Mapping[str, float] | None = None,
    areas: tuple[Area, ...] = (),
    terms: Terms = TO_THE_END,
) -> Run:
    """Return the simulated run of a behaviour; the same input gives the same run.

    Args:
        program: the behaviour.
        backend: what moves the robots, in simulated time.
        types: robot types by name.
        robot_kinds, move_kinds: by metaclass.
        options: of the backend.
        conditions: by identifier; see `assumed` for fixed answers.
        environment: of the context, by attribute name; still air and water where it says nothing.
        areas: of the context as drawn; robots flee to its emergency areas.
        terms: who is told, and what cuts the run off.

    Raises:
        UnsupportedError: if a robot type is missing, or robots, moves, actions or conditions are of
            kinds that nobody contributed; lists them.
        UsageError: if the backend's time is not simulated, or it does not know an option.
    """
    if not backend.simulated:
        raise UsageError(f"backend '{backend.name}': does not simulate, it drives robots")
    given = inputs_of(
        program,
        types=types,
        robot_kinds=robot_kinds,
        move_kinds=move_kinds,
        options=options or {},
        environment=environment or {},
        areas=areas,
    )
    refuse_undecided(program, given, conditions or {})
    made: list[StepRecord] = []

    def observe(record: StepRecord) -> None:
        made.append(record)
        if terms.observe is not None:
            terms.observe(record)

    connected = {id: backend.connect(each) for id, each in given.items()}
    with collector_at_rest():  # what a run makes is kept to its end
        ending = run(
            program.executable,
            connected,
            slots=LocalSlots(program.executable),
            clock=SimulatedClock(),
            conditions=conditions or {},
            policies={id: each.policies for id, each in given.items()},
            terms=replace(terms, observe=observe),
        )
    told = {id: robot for id, robot in connected.items() if isinstance(robot, Recorder)}
    notes = tuple(f"robot '{id}', {note}" for id, robot in told.items() for note in robot.notes)
    return Run(tuple(made), ending, _Tracks(told), notes)


class _Tracks(Mapping[str, tuple[Sample, ...]]):
    """The ways of robots that have come to their ends, each found when it is first asked for."""

    def __init__(self, recorders: Mapping[str, Recorder]) -> None:
        self._recorders = recorders
        self._found: dict[str, tuple[Sample, ...]] = {}

    def __getitem__(self, robot: str) -> tuple[Sample, ...]:
        if robot not in self._found:
            self._found[robot] = self._recorders[robot].track()
        return self._found[robot]

    def __iter__(self) -> Iterator[str]:
        return iter(self._recorders)

    def __len__(self) -> int:
        return len(self._recorders)


def inputs_of(
    program: Program,
    *,
    types: Mapping[str, RobotType],
    robot_kinds: Mapping[Name, RobotKind],
    move_kinds: Mapping[Name, MoveKind],
    options: Mapping[str, str],
    environment: Mapping[str, float],
    areas: tuple[Area, ...],
    device_actions: Wirings | None = None,
) -> dict[str, VehicleInput]:
    """Return what the backend of each robot may use; see `simulate` for the arguments.

    Raises:
        UnsupportedError: if a robot type is missing.
        UsageError: if an option is for a robot that there is not.
    """
    refuse_strange(options, [robot.id for robot in program.robots])
    found: dict[str, VehicleInput] = {}
    for robot in program.robots:
        robot_type = _type_of(types, robot.id, robot.type_name)
        policies = _policies(robot_type, robot_kinds)
        found[robot.id] = VehicleInput(
            program,
            robot,
            robot_type,
            robot_kinds,
            move_kinds,
            environment,
            options_for(robot.id, options),
            policies,
            areas,
            device_actions=device_actions or {},
            types=types,
        )
    return found


def _policies(robot_type: RobotType, kinds: Mapping[Name, RobotKind]) -> tuple[Policy, ...]:
    """Return the policies of a robot type, then those of its kind."""
    kind = robot_kind_of(robot_type, kinds)
    return in_precedence(robot_type=robot_type.policies, kind=kind.policies if kind else None)


def _type_of(types: Mapping[str, RobotType], robot: str, name: str) -> RobotType:
    if name not in types:
        raise UnsupportedError(
            f"robot '{robot}': type '{name}' is not known", [f"robot '{robot}': type '{name}'"]
        )
    return types[name]
