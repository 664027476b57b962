"""Minimal behaviours with one element of the Behaviour Language more than others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, MoveTarget, Program, RobotProgram, Transition
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import Medium, MoveSpec, RobotKind, robot_kind_of
from mmrs_core.contributions.samples import DEVICE
from mmrs_core.contributions.targets import Target, TargetInput
from mmrs_core.errors import InternalError
from mmrs_core.scene import Frame, Name, RobotType, Value

MOVE = (BEHAVIOUR, "Move")
ALPHA, BETA = "alpha", "beta"
EARTH = Frame("EPSG:4326", 42.37, 13.35, 720.0, "MSL")
HEIGHTS: Mapping[Medium, float] = {"air": 20.0, "ground": 0.0, "water": -5.0}
"""Metres above home at which sample robots move."""
RISE = 3.0
"""Metres by which a move changes the height of a sample robot, where its path depends on that."""


@dataclass(frozen=True, slots=True)
class Probe:
    """A behaviour with an element, and the same behaviour without it.

    Attributes:
        group: what sort of element it is.
        element: its metaclass, feature or meaning, such as ``GoTo.speed``.
    """

    group: str
    element: str
    given: TargetInput
    without: TargetInput


class Sample:
    """Robots of one kind, whose moves are those that the kind makes.

    Attributes:
        name: of the kind, in words.
        type: of the robots.
        here, there: two positions that they go to.
        above: a position at another height, for moves that get there in a way of their own.
        launch, recover: moves that bring them to their height, and down.
        first, second: moves to the two positions; the last move of each has the identifier ``a`` or ``b``.
    """

    def __init__(self, kind: RobotKind, contributions: Contributions) -> None:
        """Make the moves of the kind.

        Raises:
            InternalError: the kind has no sample type.
        """
        if kind.sample is None:
            raise InternalError(f"robot kind '{kind.name}' has no sample type")
        self._contributions = contributions
        self._kinds = {name: replace(each, policies={}) for name, each in contributions.robot_kinds.items()}
        height = HEIGHTS[kind.medium]
        self.name = kind.name.replace("_", " ")
        self.type: RobotType = kind.sample
        self.here, self.there = (0.0, 30.0, height), (25.0, 30.0, height)
        self.above = (25.0, 30.0, height + RISE)
        self.launch = self._made(kind.launch(height), "up")
        self.first = self._made(kind.travel(((0.0, 0.0, height), self.here)), "a")
        self.second = self._made(kind.travel((self.here, self.there)), "b")
        self.recover = self._made(kind.recover(), "down")

    @property
    def journey(self) -> tuple[Move, ...]:
        """Return moves to one position and down."""
        return self.journey_with()

    def journey_with(self, *more: Move) -> tuple[Move, ...]:
        """Return moves to one position, others there, and down."""
        return (*self.launch, *self.first, *more, *self.recover)

    @cached_property
    def plain(self) -> TargetInput:
        """Return one robot that makes the simple journey."""
        return self.given(self.robot(ALPHA, self.journey))

    def given(self, *robots: RobotProgram, type: RobotType | None = None) -> TargetInput:
        """Return what a target gets of these robots; of this type, or of the sample's own."""
        made, program = type or self.type, Program("mission", EARTH, robots)
        return TargetInput(program, {made.name: made}, self._kinds, self._contributions.move_kinds)

    def robot(self, id: str, moves: Iterable[Move], **transitions: Transition) -> RobotProgram:
        """Return a robot that makes these moves one after the other, between Start and Stop.

        Args:
            id: of the robot.
            moves: between Start and Stop.
            transitions: what follows a move, by the move's identifier, where that is not merely the next; the
                move that it comes from does not matter.
        """
        every = (move("start", "Start"), *moves, move("stop", "Stop"))
        plain = {index: Transition(index, index + 1) for index in range(len(every) - 1)}
        names = {each.id: index for index, each in enumerate(every)}
        given = {names[name]: replace(each, source=names[name]) for name, each in transitions.items()}
        home = (0.0, 0.0, 0.0) if id == ALPHA else (60.0, 0.0, 0.0)
        last = len(every) - 1
        return RobotProgram(id, self.type.name, "NORMAL", 0.0, home, (), every, {**plain, **given}, 0, last)

    def on_the_way(self, *inserted: Move) -> tuple[Move, ...]:
        """Return moves to two positions and down, with moves between the two positions."""
        return (*self.launch, *self.first, *inserted, *self.second, *self.recover)

    def after(self, id: str, beyond: int = 1) -> int:
        """Return the index of a move that follows another on the way, Start being 0."""
        return next(index for index, each in enumerate(self.on_the_way(), 1) if each.id == id) + beyond

    def inserted(self, *new: Move) -> tuple[TargetInput, TargetInput]:
        """Return a behaviour with moves between two positions, and without them."""
        longer, shorter = self.robot(ALPHA, self.on_the_way(*new)), self.robot(ALPHA, self.on_the_way())
        return self.given(longer), self.given(shorter)

    def wired(self, properties: Mapping[str, str]) -> RobotType:
        """Return the type with other properties of its device."""
        device = self.type.devices[DEVICE]
        return replace(self.type, devices={DEVICE: replace(device, properties=properties)})

    def _made(self, specs: tuple[MoveSpec, ...], id: str) -> tuple[Move, ...]:
        return tuple(
            Move(
                id if spec is specs[-1] else f"{id}{number}",
                self._contributions.languages.metaclass(*spec.metaclass).ancestry,
                spec.attributes,
                target=MoveTarget(spec.target) if spec.target is not None else None,
                speed=1.0 if spec.target is not None else None,
            )
            for number, spec in enumerate(specs)
        )


@dataclass(frozen=True, slots=True)
class Samples:
    """What a target is tried with.

    Attributes:
        target: that is tried.
        base: robots of the kind that it is made for.
        every: robots of all kinds with a sample, sorted by name.
        carried: those of them that the target does not refuse.
        ground: the core's plain robots.
        swimming: robots in water; None where no plug-in provides any.
    """

    target: Target
    base: Sample
    every: tuple[Sample, ...]
    carried: tuple[Sample, ...]
    ground: Sample
    swimming: Sample | None


def samples_of(target: Target, contributions: Contributions) -> Samples:
    """Return what a target is tried with: by the robot kinds that are installed."""
    known = contributions.robot_kinds
    kinds = sorted((kind for kind in known.values() if _has_sample(kind, known)), key=lambda kind: kind.name)
    made = {kind.name: Sample(kind, contributions) for kind in kinds}
    ground = made["plain_robot"]
    base = next((made[kind.name] for kind in kinds if kind.vehicle == target.tried_with), ground)
    carried = tuple(each for each in made.values() if not tuple(target.refusals(each.plain)))
    swimming = next((made[kind.name] for kind in kinds if kind.medium == "water"), None)
    return Samples(target, base, tuple(made.values()), carried, ground, swimming)


def _has_sample(kind: RobotKind, known: Mapping[Name, RobotKind]) -> bool:
    """Return whether a kind has a sample of its own; one that is made of another kind may hold that one's."""
    return kind.sample is not None and robot_kind_of(kind.sample, known) is kind


def move(id: str, kind: str, *more: tuple[str, str], **attributes: Value) -> Move:
    """Return a move of the Behaviour Language; `more`: metaclasses between its own and Move."""
    return Move(id, ((BEHAVIOUR, kind), *more, MOVE), attributes)


def action(kind: str, *more: str, name: str = "", device: str = "") -> Action:
    """Return an action of a metaclass of the Behaviour Language; `more`: its supertypes but Action."""
    kinds = tuple((BEHAVIOUR, each) for each in (kind, *more, "Action"))
    return Action(kinds, name, device)


def changed(base: TargetInput, change: Callable[[RobotProgram], RobotProgram]) -> TargetInput:
    """Return an input whose first robot is another."""
    first, *others = base.program.robots
    return replace(base, program=replace(base.program, robots=(change(first), *others)))


def with_move(base: TargetInput, id: str, /, **changes: object) -> TargetInput:
    """Return an input in which a move of the first robot has other values."""

    def change(robot: RobotProgram) -> RobotProgram:
        moves = (replace(each, **changes) if each.id == id else each for each in robot.moves)  # type: ignore[arg-type]
        return replace(robot, moves=tuple(moves))

    return changed(base, change)
