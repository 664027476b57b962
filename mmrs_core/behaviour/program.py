"""A behaviour as engines use it: plain frozen values in the local frame, references resolved.

Made from a BL model by `mmrs_core.behaviour.reading.program_of`. Everything that a model may leave
implicit is explicit here: transitions are indexed by the move that they leave, notify actions name
the (robot, slot) pairs that they set, positions are (east, north, up) in metres.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cached_property
from hashlib import sha256

from mmrs_core.diagnostics import Place
from mmrs_core.languages.uris import BEHAVIOUR as BEHAVIOUR
from mmrs_core.scene import Frame, Metaclasses, Name, Policy, Position, TravelMode, Value
from mmrs_core.scene.headings import bearing
from mmrs_runtime import program as engine
from mmrs_runtime.program import SlotId as SlotId

DEVICE_ACTION: Name = (BEHAVIOUR, "DeviceAction")
FEEDBACK: Name = (BEHAVIOUR, "Feedback")
NOTIFY: Name = (BEHAVIOUR, "Notify")


@dataclass(frozen=True, slots=True)
class MoveTarget:
    """What a move leads to or a heading points at.

    Attributes:
        position: of a coordinate, or where an object is expected; None for an object without a place.
        description: of an object; None for a coordinate.
        tolerance: metres that an object may be from its position; 0 for a coordinate, None if unknown.
        name: of the target in the model; may be empty.
    """

    position: Position | None
    description: str | None = None
    tolerance: float | None = 0.0
    name: str = ""


@dataclass(frozen=True, slots=True)
class Heading:
    """An orientation: a device (empty: the front) points at a target, turned by an angle in degrees."""

    target: MoveTarget
    device: str = ""
    angle_degrees: float = 0.0

    def seen_from(self, place: Position) -> float | None:
        """Return the degrees clockwise from north in which a robot at a place looks; None: unknown."""
        direction = None if self.target.position is None else bearing(place, self.target.position)
        return None if direction is None else (direction - self.angle_degrees) % 360.0


@dataclass(frozen=True, slots=True)
class Action:
    """An action before or after a movement.

    Attributes:
        metaclasses: (nsURI, name), most specific first.
        name: the device action's name, or the action's own name.
        device: identifier of the device; empty unless a device acts.
        parameters: (key, value) pairs of a device action, or the payload of a feedback.
        sets: the slots that a notify sets, each as (robot, slot); empty for other actions.
        active: the value that they are set to.
    """

    metaclasses: Metaclasses
    name: str = ""
    device: str = ""
    parameters: tuple[tuple[str, str], ...] = ()
    sets: tuple[SlotId, ...] = ()
    active: bool = True
    place: Place = Place()

    def is_a(self, name: Name) -> bool:
        """Return whether the action is of that metaclass or a subclass of it."""
        return name in self.metaclasses

    @property
    def notifies(self) -> bool:
        """Return whether the action sets slots."""
        return NOTIFY in self.metaclasses


ASIDE = frozenset({"launch", "transit", "recover", "wait", "recharge", "choice", "notify"})
"""Rules of moves that only lead to a task."""


@dataclass(frozen=True, slots=True)
class Move:
    """An atomic movement.

    Attributes:
        id: unique in the robot: the move's name, or ``moves.<index>`` where it has none.
        metaclasses: (nsURI, name), most specific first.
        attributes: plain attributes by feature name, such as ``duration``, those of plug-ins included.
        target, distance, heading, speed: of a GoTo; heading also of a HeadTo. Metres, metres per second.
        before, after: pre- and post-actions in order.
        flows: whether the robot may go into it, or out of it, without a stop.
        task, rule: what the move serves and which rule made it; empty where nothing is said.
    """

    id: str
    metaclasses: Metaclasses
    attributes: Mapping[str, Value] = field(default_factory=dict)
    target: MoveTarget | None = None
    distance: float = 0.0
    heading: Heading | None = None
    speed: float | None = None
    before: tuple[Action, ...] = ()
    after: tuple[Action, ...] = ()
    flows: bool = False
    task: str = ""
    rule: str = ""
    place: Place = Place()

    def is_a(self, name: Name) -> bool:
        """Return whether the move is of that metaclass or a subclass of it."""
        return name in self.metaclasses

    @property
    def kind(self) -> str:
        """Return the name of the most specific metaclass."""
        return self.metaclasses[0][1]

    @property
    def works(self) -> bool:
        """Return whether it is work on its task, and not only transit."""
        return bool(self.task) and self.rule not in ASIDE

    def action(self, detail: str) -> Action:
        """Return the action that a step names: ``pre:0`` is the first before the movement, or ``post:0``."""
        side, _, index = detail.partition(":")
        return (self.before if side == "pre" else self.after)[int(index)]


@dataclass(frozen=True, slots=True)
class Transition:
    """What follows a move; moves are given by their index in the robot.

    Attributes:
        waits: names of own slots that must all be active.
        condition: identifier of a Choice; None for a plain transition.
        otherwise: the next move of a Choice whose condition does not hold.
    """

    source: int
    to: int
    waits: tuple[str, ...] = ()
    fluid: bool = False
    condition: str | None = None
    otherwise: int | None = None
    policies: tuple[Policy, ...] = ()
    place: Place = Place()

    @property
    def next_moves(self) -> tuple[int, ...]:
        """Return the indices of possible next moves."""
        return (self.to,) if self.otherwise is None else (self.to, self.otherwise)


@dataclass(frozen=True, slots=True)
class RobotProgram:
    """All that one robot does.

    Attributes:
        home: where it is at the beginning; None where the model leaves it open.
        moves: in the model's order.
        transitions: by index of the move that they leave; every move but Stop has one.
        start, stop: indices of the only Start and the only Stop.
    """

    id: str
    type_name: str
    travel_mode: TravelMode
    payload: float
    home: Position | None
    slots: tuple[str, ...]
    moves: tuple[Move, ...]
    transitions: Mapping[int, Transition]
    start: int
    stop: int
    policies: tuple[Policy, ...] = ()
    place: Place = Place()

    def move(self, id: str) -> Move:
        """Return the move of that identifier."""
        return next(move for move in self.moves if move.id == id)

    @property
    def settings(self) -> Iterator[tuple[SlotId, bool]]:
        """Yield each slot that it sets or resets, with the value, as often as it does."""
        actions = (action for move in self.moves for action in (*move.before, *move.after))
        return ((slot, action.active) for action in actions for slot in action.sets)


@dataclass(frozen=True)
class Program:
    """The behaviour of all robots.

    Attributes:
        position_error: metres that a robot may be from where it believes to be.
        minimum_separation: metres between robots; None: not asked for.
        reserve: part of lifetime and energy that must remain unused, 0 to 1.
        accepted_unknowns: names of the checks whose properties may remain unknown.
        idle: robots without a program, which stand at their homes.
    """

    name: str
    frame: Frame
    robots: tuple[RobotProgram, ...]
    position_error: float = 0.0
    minimum_separation: float | None = None
    reserve: float = 0.2
    accepted_unknowns: tuple[str, ...] = ()
    idle: tuple[RobotProgram, ...] = ()

    @cached_property
    def fingerprint(self) -> str:
        """Return what differs where two plans of the mission do, whatever files they were read from.

        Idle robots make no difference.
        """
        return fingerprint(
            {each.name: getattr(self, each.name) for each in fields(self) if each.name != "idle"}
        )

    @cached_property
    def volatile(self) -> frozenset[SlotId]:
        """Return the slots that any robot resets; all others are latched: once active, they stay so."""
        return frozenset(slot for robot in self.robots for slot, active in robot.settings if not active)

    @cached_property
    def executable(self) -> engine.Program:
        """Return the behaviour as the engine executes it, with the grounded moves as orders."""
        return lowered(self)

    @cached_property
    def shared(self) -> engine.Program:
        """Return it as the processes that share its robots know it, which must have the same plan."""
        return replace(self.executable, fingerprint=self.fingerprint)

    def robot(self, id: str) -> RobotProgram:
        """Return the robot of that identifier."""
        return next(robot for robot in self.robots if robot.id == id)


_DIGITS = 16


def fingerprint(value: object) -> str:
    """Return sixteen hexadecimal digits that differ where values do.

    Where they were read from makes no difference.
    """
    text = json.dumps(_plain(value), sort_keys=True, separators=(",", ":"))
    return sha256(text.encode()).hexdigest()[:_DIGITS]


def _plain(value: object) -> object:
    """Return a value as JSON can hold it, without the places of its source."""
    if is_dataclass(value) and not isinstance(value, type):
        own = {each.name: getattr(value, each.name) for each in fields(value)}
        return {name: _plain(part) for name, part in own.items() if not isinstance(part, Place)}
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def lowered(program: Program) -> engine.Program:
    """Return what the engine executes, for vehicles that understand grounded moves, as simulated ones do."""
    return engine.Program(
        tuple(_lowered_robot(robot, program.reserve) for robot in program.robots), program.name
    )


def _lowered_robot(robot: RobotProgram, reserve: float) -> engine.ExecutableRobot:
    moves = tuple(_lowered_move(robot, index, move) for index, move in enumerate(robot.moves))
    start = robot.moves[robot.start].id
    return engine.ExecutableRobot(robot.id, moves, start, robot.slots, robot.policies, reserve)


def _lowered_move(robot: RobotProgram, index: int, move: Move) -> engine.Move:
    transition = robot.transitions.get(index) if index != robot.stop else None
    then = None if transition is None else _lowered_transition(robot, transition)
    before, after = tuple(map(_lowered_action, move.before)), tuple(map(_lowered_action, move.after))
    return engine.Move(move.id, move, before, after, then)


def _lowered_transition(robot: RobotProgram, given: Transition) -> engine.Then | engine.Choose:
    to = robot.moves[given.to].id
    if given.condition is None or given.otherwise is None:
        return engine.Then(to, given.waits, given.fluid, given.policies)
    return engine.Choose(given.condition, to, robot.moves[given.otherwise].id, given.waits, given.policies)


def _lowered_action(action: Action) -> object:
    return engine.Notify(action.sets, action.active) if action.notifies else action
