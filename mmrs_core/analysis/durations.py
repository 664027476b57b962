"""How long each move of a robot takes at least and at most, its actions included."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf

from mmrs_core.analysis.figures import MissingFigureError, kinematics_of, move_kind_of, seconds_of, type_of
from mmrs_core.analysis.motion import Motion, MovePath
from mmrs_core.analysis.verdicts import UnknownMove
from mmrs_core.behaviour.program import BEHAVIOUR, Action, Move, RobotProgram, SlotId
from mmrs_core.behaviour.walk import reachable_moves, reversed_graph, successors
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.passages import Passages
from mmrs_core.scene import Kinematics, Name, RobotType
from mmrs_core.scene.timing import STANDING, MoveSeconds, Push, acting
from mmrs_runtime.timing import IDEAL, LegTiming

HOLD: Name = (BEHAVIOUR, "HoldPosition")


@dataclass(frozen=True, slots=True)
class Span:
    """Between `low` and `high` seconds."""

    low: float = 0.0
    high: float = 0.0

    def __add__(self, other: Span) -> Span:
        """Return the span of one thing after the other."""
        return Span(self.low + other.low, self.high + other.high)


UNKNOWN = Span(0.0, inf)


@dataclass(frozen=True, slots=True)
class Setting:
    """Slots that a move sets, and how long after its begin it does so."""

    slots: tuple[SlotId, ...]
    active: bool
    after: Span


@dataclass(frozen=True, slots=True)
class Duration:
    """How long a move takes.

    Attributes:
        before: the actions before the movement. moved: with the movement. whole: with the actions
            after it as well.
        settings: which slots are set when.
    """

    before: Span
    moved: Span
    whole: Span
    settings: tuple[Setting, ...] = ()


@dataclass(frozen=True, slots=True)
class Durations:
    """Attributes: the duration of each reachable move of a robot by index; what is not known."""

    of: Mapping[int, Duration]
    gaps: tuple[UnknownMove, ...]


def durations_of(input: CheckInput, robot: RobotProgram, motion: Motion) -> Durations:
    """Return the durations of one robot's moves: of several ways that a move may lead, the extremes."""
    moves = sorted(reachable_moves(robot))
    try:
        kinematics, robot_type = kinematics_of(input, robot), type_of(input, robot)
    except MissingFigureError as missing:
        gap = UnknownMove(robot.start, str(missing).removeprefix(f"{robot.id}: "))
        unclear = {index: robot.moves[index] for index in moves}
        return Durations(
            {index: _with_actions(move, _least(move), None) for index, move in unclear.items()}, (gap,)
        )
    legs: dict[int, list[MovePath]] = defaultdict(list)
    for leg in motion.paths:
        legs[leg.move].append(leg)
    local = input.program.frame.is_local
    passages = Passages(robot, robot_type, input.move_kinds, kinematics, local=local)
    passed, begun = _passed(robot, passages, legs, kinematics.cruise), _begun(robot, passages, legs)
    gaps = {gap.move: gap for gap in motion.gaps}
    found: dict[int, Duration] = {}
    for index in moves:
        move = robot.moves[index]
        flows = replace(move, flows=index in passed)
        push, facing = begun.get(index, (None, None))
        known = replace(passages.kinematics(move), push=push, facing=facing, entering=passed.get(index, 0.0))
        moving = _least(move) if index in gaps else _moving(input, robot, flows, legs[index], known)
        if index not in gaps and (saved := passages.saved(move)) is not None:
            stepped = _moving(input, robot, move, legs[index], kinematics)
            quicker = moving.high - (1.0 + known.timing.spread) * saved
            moving = replace(moving, high=min(moving.high, max(quicker, stepped.high)))
        found[index] = _with_actions(move, moving, robot_type, kinematics.timing)
        if index not in gaps and found[index].whole.high == inf:
            gaps[index] = UnknownMove(index, _why_unbounded(move, robot_type))
    return Durations(found, tuple(gaps[index] for index in sorted(gaps)))


def _least(move: Move) -> Span:
    """Return what is known of a move wherever it is made: robots hold for as long as the move says."""
    held = move.attributes.get("duration") if move.is_a(HOLD) else None
    return Span(float(held), inf) if isinstance(held, int | float) else UNKNOWN


def _why_unbounded(move: Move, robot_type: RobotType) -> str:
    for action in (*move.before, *move.after):
        if seconds_of(action, robot_type) is None:
            return f"how long action '{action.name}' of device '{action.device}' takes is not known"
    return "nothing bounds how long it takes"


def _passed(
    robot: RobotProgram, passages: Passages, legs: Mapping[int, list[MovePath]], cruise: float
) -> dict[int, float]:
    """Return with which speed at most the robot enters the moves that it begins or ends without a stop."""
    found: dict[int, float] = {}
    for source, transition in robot.transitions.items():
        move = robot.moves[source]
        if any(passages.ahead(move, leg.points) for leg in legs.get(source, ())):
            found.setdefault(source, 0.0)
            found[transition.to] = max(found.get(transition.to, 0.0), move.speed or cruise)
    return found


def _begun(
    robot: RobotProgram, passages: Passages, legs: Mapping[int, list[MovePath]]
) -> dict[int, tuple[Push | None, float | None]]:
    """Return with which push, and looking where, the robot begins those moves that it makes in one order."""
    graph = successors(robot)
    before = reversed_graph(graph)
    found: dict[int, tuple[Push | None, float | None]] = {}
    index = robot.start
    push: Push | None = STANDING
    facing: float | None = None
    while index not in found and len(before[index]) <= 1:
        found[index] = (push, facing)
        paths = legs.get(index, [])
        known = len(paths) == 1 and paths[0].radius == 0.0
        move = robot.moves[index]
        push = passages.push(move, paths[0].points, push) if known else None
        facing = passages.facing(move, paths[0].points, facing) if known else None
        index = graph[index][0] if len(graph[index]) == 1 else index
    return found


def _moving(
    input: CheckInput, robot: RobotProgram, move: Move, legs: Iterable[MovePath], kinematics: Kinematics
) -> Span:
    kind = move_kind_of(input, move)
    if kind is None:
        return UNKNOWN
    spans = [
        _spread(leg, kind.seconds(move, leg.points, kinematics, robot.travel_mode), move, kinematics)
        for leg in legs
    ]
    if not spans:
        return UNKNOWN
    return Span(min(span.low for span in spans), max(span.high for span in spans))


def _spread(leg: MovePath, seconds: MoveSeconds, move: Move, kinematics: Kinematics) -> Span:
    """Return the span where the path may be longer or shorter by what is not known of its ends."""
    if leg.radius == 0.0 or len(leg.points) == 1:
        return Span(seconds.shortest, seconds.longest)
    slowest = min(move.speed or kinematics.cruise, kinematics.climb, kinematics.descent)
    more = leg.radius / slowest if slowest > 0.0 else inf
    return Span(max(0.0, seconds.shortest - more), seconds.longest + more)


def _with_actions(
    move: Move, moving: Span, robot_type: RobotType | None, timing: LegTiming = IDEAL
) -> Duration:
    before, first = _actions(move.before, Span(), robot_type, timing)
    after, second = _actions(move.after, before + moving, robot_type, timing)
    return Duration(before, before + moving, after, (*first, *second))


def _actions(
    actions: Iterable[Action], begin: Span, robot_type: RobotType | None, timing: LegTiming
) -> tuple[Span, list[Setting]]:
    settings: list[Setting] = []
    now = begin
    for action in actions:
        now = now + _acting(action, robot_type, timing)
        if action.sets:
            settings.append(Setting(action.sets, action.active, now))
    return now, settings


def _acting(action: Action, robot_type: RobotType | None, timing: LegTiming) -> Span:
    """Return how long an action takes: none unless it is a device's."""
    if not action.device:
        return Span()
    seconds = seconds_of(action, robot_type) if robot_type else None
    if seconds is None:
        return UNKNOWN
    found = acting(seconds, timing)
    return Span(found.shortest, found.longest)
