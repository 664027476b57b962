"""Whole simulated runs: all robots of a behaviour with backends of one sort, from Start to the end."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition, Sample
from mmrs_core.contributions.rules import RobotKind, robot_kind_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.vehicles import Recorder, VehicleFactory, VehicleInput
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.languages.naming import nearest
from mmrs_core.scene import Name, Policy, RobotType
from mmrs_runtime.engine.clocks import SimulatedClock
from mmrs_runtime.engine.run import run
from mmrs_runtime.engine.terms import TO_THE_END, Ending, Terms
from mmrs_runtime.policies import in_precedence
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.slots import LocalSlots
from mmrs_runtime.vehicle import Vehicle


@dataclass(frozen=True, slots=True)
class SimulatedRun:
    """What happened in a run.

    Attributes:
        records: the steps, in the order in which they were made.
        ending: how it ended.
        tracks: by robot, the track it left; empty where the backend does not record it.
        notes: what was taken for granted, each line with its robot.
    """

    records: tuple[StepRecord, ...]
    ending: Ending
    tracks: Mapping[str, tuple[Sample, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def simulate(
    given: TargetInput,
    backend: VehicleFactory,
    *,
    options: Mapping[str, str] | None = None,
    conditions: Mapping[str, Condition] | None = None,
    terms: Terms = TO_THE_END,
) -> SimulatedRun:
    """Return the simulated run of a behaviour; the same input gives the same run.

    Args:
        given: the behaviour, in still air and water unless the environment defines others; robots flee to
            its emergency areas.
        backend: what moves the robots, in simulated time.
        options: of the backend.
        conditions: by identifier; see `assumed` for fixed answers.
        terms: observers of the run, and what cuts it off.

    Raises:
        UnsupportedError: if a robot type is missing, or robots, moves, actions or conditions are of
            kinds that no plug-in provides; lists them.
        UsageError: if the backend's time is not simulated, or it does not know an option.
    """
    if not backend.simulated:
        raise UsageError(f"backend '{backend.name}': runs in real time; use it with 'mmrs run'")
    program, inputs = given.program, inputs_of(given, options or {})
    refuse_undecided(program, inputs, conditions or {})
    made: list[StepRecord] = []

    def observe(record: StepRecord) -> None:
        made.append(record)
        if terms.observe is not None:
            terms.observe(record)

    connected = {id: backend.connect(each) for id, each in inputs.items()}
    with collector_at_rest():  # what a run makes is kept to its end
        ending = run(
            program.executable,
            connected,
            slots=LocalSlots(program.executable),
            clock=SimulatedClock(),
            conditions=conditions or {},
            policies={id: each.policies for id, each in inputs.items()},
            terms=replace(terms, observe=observe),
        )
    recorders = {id: robot for id, robot in connected.items() if isinstance(robot, Recorder)}
    notes = tuple(f"robot '{id}', {note}" for id, robot in recorders.items() for note in robot.notes)
    return SimulatedRun(tuple(made), ending, _Tracks(recorders), notes)


class _Tracks(Mapping[str, tuple[Sample, ...]]):
    """Tracks of robots, each computed when it is first asked for."""

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


def inputs_of(given: TargetInput, options: Mapping[str, str]) -> dict[str, VehicleInput]:
    """Return what the backend of each robot may use.

    Raises:
        UnsupportedError: if a robot type is missing.
        UsageError: if an option is for a robot that there is not.
    """
    refuse_strange(options, [robot.id for robot in given.program.robots])
    common = {each.name: getattr(given, each.name) for each in fields(TargetInput)}
    found: dict[str, VehicleInput] = {}
    for robot in given.program.robots:
        robot_type = _type_of(given.types, robot.id, robot.type_name)
        policies = _policies(robot_type, given.robot_kinds)
        own = options_for(robot.id, options)
        found[robot.id] = VehicleInput(**common, robot=robot, type=robot_type, options=own, policies=policies)
    return found


def _policies(robot_type: RobotType, kinds: Mapping[Name, RobotKind]) -> tuple[Policy, ...]:
    kind = robot_kind_of(robot_type, kinds)
    return in_precedence(robot_type=robot_type.policies, kind=kind.policies if kind else None)


def _type_of(types: Mapping[str, RobotType], robot: str, name: str) -> RobotType:
    if name not in types:
        raise UnsupportedError(
            f"robot '{robot}': type '{name}' is not known", [f"robot '{robot}': type '{name}'"]
        )
    return types[name]


def asked_by(program: Program) -> tuple[str, ...]:
    """Return the identifiers of all conditions that a program asks for, sorted."""
    asked = {each.condition for robot in program.robots for each in robot.transitions.values()}
    return tuple(sorted(identifier for identifier in asked if identifier is not None))


def refuse_unasked(program: Program, identifiers: Collection[str]) -> None:
    """Check that a program asks for each of these conditions.

    Raises:
        UsageError: if it does not; lists what it asks for.
    """
    asked = asked_by(program)
    for identifier in identifiers:
        if identifier not in asked:
            known, guess = ", ".join(map(repr, asked)) or "none", nearest(identifier, asked)
            raise UsageError(
                f"condition {identifier!r}: no Choice uses it; conditions in use: {known}"
                f"{guess and '; ' + guess}"
            )


def refuse_undecided(program: Program, robots: Container[str], conditions: Container[str]) -> None:
    """Check that each choice of these robots can be decided.

    Raises:
        UnsupportedError: a condition is unknown; lists all of them.
    """
    unknown = [
        f"robot '{robot.id}', after move '{robot.moves[source].id}': condition '{transition.condition}'"
        for robot in program.robots
        if robot.id in robots
        for source, transition in sorted(robot.transitions.items())
        if transition.condition is not None and transition.condition not in conditions
    ]
    if unknown:
        several = f"{len(unknown)} choices have conditions without a decision"
        words = several if len(unknown) > 1 else "one choice has a condition without a decision"
        raise UnsupportedError(words, unknown)


def mixed(
    usual: VehicleFactory, own: Mapping[str, VehicleFactory], robots: Collection[str]
) -> VehicleFactory:
    """Return what makes the usual backend for all robots but those that have their own.

    Raises:
        UsageError: if one of them is not a robot of the program, or simulated time would meet real time.
    """
    if strange := sorted(set(own) - set(robots)):
        raise UsageError(f"backend of '{strange[0]}': no such robot; there are {', '.join(robots)}")
    used = {each.name: each for each in ([] if set(own) == set(robots) else [usual])}
    used |= {each.name: each for each in own.values()}
    if len({each.simulated for each in used.values()}) > 1:
        words = (f"'{each.name}' {'simulated' if each.simulated else 'real'}" for each in used.values())
        raise UsageError(f"backends of one run go by one time: {', '.join(words)}")

    def connect(given: VehicleInput) -> Vehicle:
        factory = own.get(given.robot.id, usual)
        live = given.live
        if live is not None:
            links = {robot: link for robot, link in live.links.items() if own.get(robot, usual) is factory}
            live = replace(live, links=links)
        return factory.connect(replace(given, live=live))

    simulated = all(each.simulated for each in used.values())
    return VehicleFactory(" and ".join(used), "as each robot has it", connect, simulated)


def options_for(robot: str, options: Mapping[str, str]) -> dict[str, str]:
    """Return the options of one robot's backend: those that name it as in ``ROBOT:KEY`` go before others.

    >>> options_for("a", {"seed": "1", "a:seed": "2", "b:noise": "no"})
    {'seed': '2'}
    """
    own = {
        key.removeprefix(f"{robot}:"): text for key, text in options.items() if key.startswith(f"{robot}:")
    }
    return {**{key: text for key, text in options.items() if ":" not in key}, **own}


def refuse_strange(options: Mapping[str, str], robots: Collection[str]) -> None:
    """Check that options name no other robots than these.

    Raises:
        UsageError: if one does.
    """
    for key in options:
        robot, colon, _ = key.rpartition(":")
        if colon and robot not in robots:
            raise UsageError(f"option '{key}': no robot '{robot}'; there are {', '.join(robots)}")
