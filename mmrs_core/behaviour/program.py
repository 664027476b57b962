"""A behaviour as engines use it: plain frozen values in the local frame, references resolved.

Made from a BL model by `mmrs_core.behaviour.reading.program_of`. Everything that a model may leave
implicit is explicit here: transitions are indexed by the move that they leave, notify actions name
the (robot, slot) pairs that they set, positions are (east, north, up) in metres.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property

from mmrs_core.behaviour.fingerprint import fingerprint
from mmrs_core.diagnostics import Place
from mmrs_core.scene import Frame, Metaclasses, Name, Policy, Position, TravelMode, Value
from mmrs_runtime.program import Program as ExecutableProgram
from mmrs_runtime.program import SlotId as SlotId

BEHAVIOUR = "urn:mmrs:behaviour:1.0"
DEVICE_ACTION: Name = (BEHAVIOUR, "DeviceAction")
FEEDBACK: Name = (BEHAVIOUR, "Feedback")
NOTIFY: Name = (BEHAVIOUR, "Notify")


@dataclass(frozen=True, slots=True)
class Target:
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

    target: Target
    device: str = ""
    angle_degrees: float = 0.0


@dataclass(frozen=True, slots=True)
class Action:
    """An action before or after a movement.

    Attributes:
        metaclasses: (nsURI, name), most specific first.
        name: the device action's name, or the action's own name.
        device: identifier of the device; empty unless a device acts.
        parameters: (key, value) pairs of a device action, or the payload of a feedback.
        sets: the slots that a notify sets, resolved once; empty for other actions.
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


@dataclass(frozen=True, slots=True)
class Move:
    """An atomic movement.

    Attributes:
        id: unique in the robot: the move's name, or ``moves.<index>`` where it has none.
        metaclasses: (nsURI, name), most specific first.
        attributes: plain attributes by feature name (``duration``, ``altitude``, ``trajectory`` …),
            those of plug-ins included.
        target, distance, heading, speed: of a GoTo; heading also of a HeadTo. Metres, metres per second.
        before, after: pre- and post-actions in order.
        flows: whether the robot may go into it, or out of it, without a stop.
        task, rule: what the move serves and which rule made it; empty where nothing is said.
    """

    id: str
    metaclasses: Metaclasses
    attributes: Mapping[str, Value] = field(default_factory=dict)
    target: Target | None = None
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
        """Return the name of the most specific metaclass, for people."""
        return self.metaclasses[0][1]

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
        otherwise: where a Choice goes on when its condition does not hold.
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
    def ways(self) -> tuple[int, ...]:
        """Return the indices of all moves that may follow."""
        return (self.to,) if self.otherwise is None else (self.to, self.otherwise)


@dataclass(frozen=True, slots=True)
class RobotProgram:
    """All that one robot does.

    Attributes:
        home: where it is at the beginning; None where the model does not say.
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
        idle: robots that nobody runs, and that stand at their homes.
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

        Robots that nobody runs make no difference.
        """
        return fingerprint(
            {each.name: getattr(self, each.name) for each in fields(self) if each.name != "idle"}
        )

    @cached_property
    def volatile(self) -> frozenset[SlotId]:
        """Return the slots that any robot resets; all others are latched: once active, they stay so."""
        return frozenset(slot for robot in self.robots for slot, active in robot.settings if not active)

    @cached_property
    def executable(self) -> ExecutableProgram:
        """Return the behaviour as the engine executes it, with the grounded moves as orders."""
        from mmrs_core.behaviour.lowering import lowered

        return lowered(self)

    @cached_property
    def shared(self) -> ExecutableProgram:
        """Return it as the processes that share its robots know it, which must have the same plan."""
        return replace(self.executable, fingerprint=self.fingerprint)

    def robot(self, id: str) -> RobotProgram:
        """Return the robot of that identifier."""
        return next(robot for robot in self.robots if robot.id == id)
