"""The step rules of the Behaviour Language as pure functions.

Each robot is at a control point; a step of one robot leads it to its next point and may set slots.
Steps of different robots interleave. Slots are latches: passing a wait leaves them as they are.
All awaited slots are tested in one state, after the actions that follow the movement. A Choice may take
either branch here; the engine asks its condition once, at the instant when it fires.

Robots run by `steps`, `fault` and `missing`, and the check of synchronisation reads a behaviour by `steps`;
`recorded_step` finds the step of a log record. States of all robots together (`initial`, `enabled`, `apply`,
`is_success`, `is_deadlock`) are the oracle that the engine and that check are tested against, over every
interleaving.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from .program import Choose, ExecutableRobot, Notify, Program, SlotId
from .records.steps import StepRecord


class Phase(Enum):
    """How far a robot is with a move; the values of BEFORE and AFTER stand in the logs."""

    BEFORE = "pre"
    READY = "ready"
    BUSY = "busy"
    AFTER = "post"
    OUT = "out"
    DONE = "done"
    FAILED = "failed"


class Point(NamedTuple):
    """A control point: a move, how far the robot is with it, and at which action."""

    move: str
    phase: Phase
    action: int = 0

    @property
    def is_final(self) -> bool:
        """Return whether the robot makes no further step, whatever the others do."""
        return self.phase is Phase.DONE or self.phase is Phase.FAILED


class PossibleStep(NamedTuple):
    """A step that a robot may make.

    Attributes:
        robot, label, move, detail, slot: as in `mmrs_runtime.records.steps.StepRecord`.
        leads_to: where the robot is afterwards.
        sets: the slots that it sets to `active`; empty unless the label is ``ntf``.
    """

    robot: str
    label: str
    move: str
    detail: str
    slot: str
    leads_to: Point
    sets: tuple[SlotId, ...] = ()
    active: bool = True


@dataclass(frozen=True, slots=True)
class Waiting:
    """A robot that waits after a move, and the own slots that it lacks.

    >>> print(Waiting("Brezza", "goto_3", ("north ended by Alba", "go")))
    'Brezza' waits after 'goto_3' for 'north ended by Alba', 'go'
    """

    robot: str
    move: str
    slots: tuple[str, ...]

    def __str__(self) -> str:
        """Return it as people read it."""
        return f"{self.robot!r} waits after {self.move!r} for {', '.join(map(repr, self.slots))}"


class Outcome(Enum):
    """How a run ended."""

    SUCCESS = "success"
    FAILED = "failed"
    STUCK = "stuck"
    INCOMPLETE = "incomplete"


@dataclass(frozen=True, slots=True)
class GlobalState:
    """Where all robots are, in the program's order, and which slots are active."""

    points: tuple[Point, ...]
    active: frozenset[SlotId] = frozenset()


def initial(program: Program) -> GlobalState:
    """Return the state in which every run begins."""
    return GlobalState(tuple(entry(robot, robot.start) for robot in program.robots))


def entry(robot: ExecutableRobot, move: str) -> Point:
    """Return the first control point of a move."""
    return Point(move, Phase.BEFORE if robot.by_id[move].before else Phase.READY)


def steps(robot: ExecutableRobot, point: Point, active: Set[SlotId]) -> tuple[PossibleStep, ...]:
    """Return the steps that the robot may make; two only at a Choice, none if it waits or is final.

    A fault may happen at any point and is not among them.
    """
    phase = point.phase
    if phase is Phase.BEFORE or phase is Phase.AFTER:
        return (_action_step(robot, point),)
    if phase is Phase.READY:
        return (PossibleStep(robot.id, "begin", point.move, "", "", Point(point.move, Phase.BUSY)),)
    if phase is Phase.BUSY:
        return (PossibleStep(robot.id, "end", point.move, "", "", _after_movement(robot, point.move)),)
    if phase is Phase.OUT and not missing(robot, point, active):
        return _ways_on(robot, point)
    return ()


def fault(robot: ExecutableRobot, point: Point, which: str) -> PossibleStep:
    """Return the step by which a robot that is not at a final point stops for good."""
    return PossibleStep(robot.id, "fault", point.move, which, "", Point(point.move, Phase.FAILED))


def recorded_step(
    record: StepRecord, robot: ExecutableRobot, point: Point, active: Set[SlotId]
) -> PossibleStep | None:
    """Return the step of a robot from a point that a record belongs to; None: it can make no such step."""
    if record.label == "fault":
        may = not point.is_final and not record.slot and record.move == point.move
        return fault(robot, point, record.detail) if may else None
    wanted = (record.label, record.move, record.detail, record.slot)
    possible = steps(robot, point, active)
    return next((s for s in possible if (s.label, s.move, s.detail, s.slot) == wanted), None)


def missing(robot: ExecutableRobot, point: Point, active: Set[SlotId]) -> tuple[str, ...]:
    """Return the names of the slots that hold the robot up at the end of a move; empty elsewhere."""
    return tuple(slot[1] for slot in awaited(robot, point) if slot not in active)


def awaited(robot: ExecutableRobot, point: Point) -> tuple[SlotId, ...]:
    """Return the own slots that must be active before the robot continues; none but at the end of a move."""
    if point.phase is not Phase.OUT:
        return ()
    then = robot.by_id[point.move].then
    return tuple((robot.id, name) for name in then.waits) if then is not None else ()


def action_at(robot: ExecutableRobot, point: Point) -> object | None:
    """Return the action that the robot is about to do; None where it is about to do none."""
    move = robot.by_id[point.move]
    if point.phase is Phase.BEFORE:
        return move.before[point.action]
    return move.after[point.action] if point.phase is Phase.AFTER else None


def slot_text(notify: Notify) -> str:
    """Return the slots that a notify sets as logs write them."""
    names = " ".join(f"{robot}.{slot}" for robot, slot in notify.slots)
    return ("+" if notify.active else "-") + names


def enabled(program: Program, state: GlobalState) -> Iterator[PossibleStep]:
    """Yield every step that some robot may make in that state."""
    for robot, point in zip(program.robots, state.points, strict=True):
        yield from steps(robot, point, state.active)


def apply(program: Program, state: GlobalState, step: PossibleStep) -> GlobalState:
    """Return the state after an enabled step."""
    points = tuple(
        step.leads_to if robot.id == step.robot else point
        for robot, point in zip(program.robots, state.points, strict=True)
    )
    return GlobalState(points, frozenset(with_slots(state.active, step)))


def with_slots(active: Set[SlotId], step: PossibleStep) -> Set[SlotId]:
    """Return which slots are active after a step."""
    if not step.sets:
        return active
    return active | set(step.sets) if step.active else active - set(step.sets)


def waiting(program: Program, state: GlobalState) -> tuple[Waiting, ...]:
    """Return the robots that wait in that state."""
    return tuple(
        Waiting(robot.id, point.move, lacking)
        for robot, point in zip(program.robots, state.points, strict=True)
        if (lacking := missing(robot, point, state.active))
    )


def is_success(state: GlobalState) -> bool:
    """Return whether every robot has done all that it should."""
    return all(point.phase is Phase.DONE for point in state.points)


def is_deadlock(program: Program, state: GlobalState) -> bool:
    """Return whether no step is possible any more although not every robot has come to its end."""
    return not is_success(state) and next(enabled(program, state), None) is None


def _action_step(robot: ExecutableRobot, point: Point) -> PossibleStep:
    move = robot.by_id[point.move]
    before = point.phase is Phase.BEFORE
    actions = move.before if before else move.after
    action = actions[point.action]
    if point.action + 1 < len(actions):
        leads_to = Point(point.move, point.phase, point.action + 1)
    else:
        leads_to = Point(point.move, Phase.READY) if before else _out(robot, point.move)
    detail = f"{point.phase.value}:{point.action}"
    if isinstance(action, Notify):
        text = slot_text(action)
        return PossibleStep(robot.id, "ntf", move.id, detail, text, leads_to, action.slots, action.active)
    return PossibleStep(robot.id, "act", move.id, detail, "", leads_to)


def _after_movement(robot: ExecutableRobot, move: str) -> Point:
    return Point(move, Phase.AFTER) if robot.by_id[move].after else _out(robot, move)


def _out(robot: ExecutableRobot, move: str) -> Point:
    return Point(move, Phase.DONE if robot.by_id[move].then is None else Phase.OUT)


def _ways_on(robot: ExecutableRobot, point: Point) -> tuple[PossibleStep, ...]:
    then = robot.by_id[point.move].then
    if then is None:
        return ()
    if not isinstance(then, Choose):
        return (PossibleStep(robot.id, "take", point.move, then.move, "", entry(robot, then.move)),)
    return tuple(
        PossibleStep(robot.id, "choose", point.move, detail, "", entry(robot, way))
        for detail, way in (("true", then.move), ("false", then.otherwise))
    )
