"""A robot of a behaviour as a program of the runtime: as text, or as a value."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

from mmrs_core.behaviour.earth import metres
from mmrs_core.behaviour.program import Program, RobotProgram, Transition
from mmrs_core.behaviour.travel import cruise_of
from mmrs_core.behaviour.walk import in_order
from mmrs_core.contributions.targets import TargetInput, TracedStep
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.escaping import Call, Constant
from mmrs_core.generation.python.moves import action_of, movement_of, objects_of, place_of
from mmrs_core.generation.safety import explicit, policies_of
from mmrs_core.scene import Policy
from mmrs_runtime.records.steps import log_name

if TYPE_CHECKING:
    from mmrs_core.generation.python.driver import PythonDriver

    Driver = PythonDriver[Any]


@dataclass(frozen=True, slots=True)
class StepView:
    """One step as the template sees it."""

    call: Call
    task: str
    rule: str
    trace: TracedStep


@dataclass(frozen=True, slots=True)
class RobotView:
    """One robot as the template sees it.

    Attributes:
        words: of the runtime that its program needs.
        head: what is said of it before its steps, by name.
        names: values that the program says by a name, with that name.
    """

    id: str
    mission: str
    words: tuple[str, ...]
    head: tuple[tuple[str, object], ...]
    steps: tuple[StepView, ...]
    conditions: tuple[str, ...]
    objects: tuple[str, ...]
    names: tuple[tuple[str, object], ...] = ()

    def trace(self, name: str) -> TracedStep:
        """Return what a line of the head serves: no move, but the robot."""
        return TracedStep(name, self.id, "")


def robot_view(robot: RobotProgram, input: TargetInput, driver: Driver) -> RobotView:
    """Return a robot as the template sees it.

    Raises:
        UnsupportedError: places are in degrees, and the behaviour has none.
    """
    context = driver.context(robot, input)
    traced = zip(_ordered(robot), trace_of(robot), strict=True)
    steps = tuple(_step(index, context, step, driver) for index, step in traced)
    said = (*_head(context, input, driver), *driver.head(context, input))
    head = tuple(each for each in said if each[1] != ())
    calls = [step.call for step in steps]
    return RobotView(
        robot.id,
        input.program.name,
        tuple(sorted({"Robot", *_words((head, calls))})),
        head,
        steps,
        conditions_of(robot),
        objects_in(robot),
        tuple({**dict(sorted(_constants(calls))), **dict(_constants(head))}.items()),
    )


def program_of(robot: RobotProgram, input: TargetInput, driver: Driver, words: ModuleType) -> Any:
    """Return the program that a controller of a robot carries out, made with the words of a module.

    Raises:
        UnsupportedError: places are in degrees, and the behaviour has none.
    """
    view = robot_view(robot, input, driver)
    steps = tuple(step.call for step in view.steps)
    return built(Call("Robot", (), (*view.head, ("steps", steps))), words)


def built(value: object, words: ModuleType) -> Any:
    """Return a value with every call in it made, with the words of a module.

    >>> from mmrs_runtime.controllers import vocabulary
    >>> built((Call("Hold", (3.0,)), "as it is"), vocabulary)
    (Hold(seconds=3.0), 'as it is')
    """
    if isinstance(value, Constant):
        return built(value.value, words)
    if isinstance(value, Call):
        word = getattr(words, value.function)
        named = {name: built(each, words) for name, each in value.named}
        return word(*(built(each, words) for each in value.positional), **named)
    return tuple(built(each, words) for each in value) if isinstance(value, tuple | list) else value


def conditions_of(robot: RobotProgram) -> tuple[str, ...]:
    """Return the identifiers of the conditions that a robot's Choices ask for, sorted."""
    return tuple(sorted({t.condition for t in robot.transitions.values() if t.condition is not None}))


def objects_in(robot: RobotProgram) -> tuple[str, ...]:
    """Return the descriptions of the objects that a robot goes to or points at, sorted."""
    return tuple(sorted({found for move in robot.moves for found in objects_of(move)}))


def deciding(robots: Iterable[RobotProgram]) -> dict[str, tuple[TracedStep, ...]]:
    """Return, for each condition, the moves after which it is asked for; sorted by condition."""
    return _by_name(
        (transition.condition, TracedStep("choice", robot.id, move.id, move.task, move.rule))
        for robot in robots
        for index, move in enumerate(robot.moves)
        if (transition := robot.transitions.get(index)) is not None and transition.condition is not None
    )


def seeking(robots: Iterable[RobotProgram]) -> dict[str, tuple[TracedStep, ...]]:
    """Return, for each object's description, the moves that need its place; sorted by description."""
    return _by_name(
        (found, TracedStep("object", robot.id, move.id, move.task, move.rule))
        for robot in robots
        for move in robot.moves
        for found in objects_of(move)
    )


def _by_name(pairs: Iterable[tuple[str | None, TracedStep]]) -> dict[str, tuple[TracedStep, ...]]:
    found: dict[str, tuple[TracedStep, ...]] = {}
    for name, step in pairs:
        if name is not None:
            found[name] = (*found.get(name, ()), step)
    return dict(sorted(found.items()))


def trace_of(robot: RobotProgram) -> tuple[TracedStep, ...]:
    """Return which step serves which move and task."""
    moves = [robot.moves[index] for index in _ordered(robot)]
    return tuple(
        TracedStep(f"step {number}", robot.id, move.id, move.task, move.rule)
        for number, move in enumerate(moves)
    )


def senders_of(
    robot: RobotProgram, program: Program, *, active: bool
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return, for each slot that is ever activated, or deactivated, the robots that do."""
    found: dict[str, dict[str, None]] = {}
    for sender in program.robots:
        for (owner, slot), value in sender.settings:
            if owner == robot.id and value is active:
                found.setdefault(slot, {})[sender.id] = None
    return tuple((slot, tuple(senders)) for slot, senders in sorted(found.items()))


def _ordered(robot: RobotProgram) -> tuple[int, ...]:
    reached = in_order(robot)
    return (*reached, *(index for index in range(len(robot.moves)) if index not in set(reached)))


def _step(index: int, context: RobotContext, trace: TracedStep, driver: Driver) -> StepView:
    robot = context.robot
    move, transition = robot.moves[index], robot.transitions.get(index)
    named: list[tuple[str, object]] = []
    for name, actions in (("before", move.before), ("after", move.after)):
        if actions:
            named.append((name, tuple(action_of(action, context, driver) for action in actions)))
    if transition is not None:
        named.append(("then", _then(transition, robot)))
    named += [(name, value) for name, value in (("task", move.task), ("rule", move.rule)) if value]
    call = Call("Step", (move.id, movement_of(move, context, driver)), tuple(named))
    return StepView(call, move.task, move.rule, trace)


def _then(transition: Transition, robot: RobotProgram) -> Call:
    named: list[tuple[str, object]] = []
    if transition.waits:
        named.append(("waits", transition.waits))
    if transition.policies:
        named.append(("policies", tuple(_policy(explicit(policy)) for policy in transition.policies)))
    to = robot.moves[transition.to].id
    if transition.condition is not None and transition.otherwise is not None:
        otherwise = robot.moves[transition.otherwise].id
        return Call("Choose", (transition.condition, to, otherwise), tuple(named))
    if transition.fluid:
        named.append(("fluid", True))
    return Call("Then", (to,), tuple(named))


def _head(context: RobotContext, input: TargetInput, driver: Driver) -> Iterator[tuple[str, object]]:
    robot, program = context.robot, input.program
    yield "id", robot.id
    yield "mission", program.name
    yield "plan", program.fingerprint
    yield "fleet", tuple(each.id for each in program.robots)
    yield "log", log_name(robot.id)
    yield "vehicle", driver.vehicle(context)
    yield "home", place_of(robot.home or (0.0, 0.0, 0.0), context)
    yield "start", robot.moves[robot.start].id
    yield "slots", robot.slots
    yield "senders", senders_of(robot, program, active=True)
    yield "resets", senders_of(robot, program, active=False)
    yield "volatile", tuple(sorted(program.volatile & {slot for slot, _ in robot.settings}))
    yield "policies", tuple(_policy(policy) for policy in policies_of(robot, input))
    yield "reserve", program.reserve
    if (cruise := cruise_of(robot, context.type)) is not None:
        yield "cruise", metres(cruise)


def _policy(policy: Policy) -> Call:
    after = () if policy.after is None else (policy.after,)
    return Call("Policy", (policy.event, policy.response, *after))


def _words(value: object) -> Iterator[str]:
    """Yield the functions of all calls in a value."""
    if isinstance(value, Call):
        yield value.function
    for each in _parts(value):
        yield from _words(each)


def _constants(value: object) -> Iterator[tuple[str, object]]:
    """Yield the constants in a value, those that are said in another one before it."""
    for each in _parts(value):
        yield from _constants(each)
    if isinstance(value, Constant):
        yield value.name, value.value


def _parts(value: object) -> Iterable[object]:
    if isinstance(value, Constant):
        return (value.value,)
    if isinstance(value, Call):
        return (*value.positional, *(each for _, each in value.named))
    return value if isinstance(value, tuple | list) else ()
