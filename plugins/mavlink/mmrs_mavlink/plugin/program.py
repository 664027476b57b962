"""A robot of a behaviour as a program of the runtime."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, RobotProgram, Transition
from mmrs_core.behaviour.refuges import Refuges, refuges_of
from mmrs_core.behaviour.walk import in_order
from mmrs_core.contributions.targets import TargetInput, TracedStep
from mmrs_core.generation.escaping import Call
from mmrs_core.mavlink.earth import metres
from mmrs_core.mavlink.vehicles import TRAVEL_FACTORS, capability_of, manner_of
from mmrs_core.scene import Point, Policy
from mmrs_mavlink.plugin.actions import action_of
from mmrs_mavlink.plugin.context import RobotContext, context_of, neighbours_of
from mmrs_mavlink.plugin.escapes import Escape, escapes_of, straight_lines_are_clear
from mmrs_mavlink.plugin.fencing import Fence, fences_of
from mmrs_mavlink.plugin.movements import movement_of, objects_of, place_of
from mmrs_mavlink.plugin.runs import Run, runs_of
from mmrs_mavlink.plugin.safety import explicit, policies_of
from mmrs_runtime.records.steps import log_name


@dataclass(frozen=True, slots=True)
class _Protection:
    """What protects a robot beside its program."""

    fences: tuple[Fence, ...]
    refuges: Refuges
    escapes: tuple[Escape, ...]

    @property
    def vertices(self) -> list[Point]:
        """Return all points that it consists of, seen from above."""
        corners = [vertex for fence in self.fences for vertex in fence.ring]
        ways = [place[:2] for escape in self.escapes for place in escape.places]
        return [*corners, *self.refuges.points, *ways]


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


def robot_view(robot: RobotProgram, input: TargetInput, plan: str = "") -> RobotView:
    """Return a robot as the template sees it.

    Args:
        robot: of the program.
        input: what is written down.
        plan: what tells the plan apart from others, where the program was changed before; else its own.
    """
    program, kept = input.program, _protection(robot, input)
    homes = [home[:2] for _, home in neighbours_of(robot, input)]
    geographic = not program.frame.is_local
    context = context_of(robot, input, [*kept.vertices, *homes], geographic=geographic)
    traced = zip(_ordered(robot), trace_of(robot), strict=True)
    steps = tuple(_step(index, context, step) for index, step in traced)
    named = plan or input.program.fingerprint
    head = tuple(each for each in _head(context, input, kept, named) if each[1] != ())
    words = {"Robot"} | _words((head, [step.call for step in steps]))
    return RobotView(
        robot.id, program.name, tuple(sorted(words)), head, steps, conditions_of(robot), objects_in(robot)
    )


def conditions_of(robot: RobotProgram) -> tuple[str, ...]:
    """Return the identifiers of the conditions that a robot's Choices ask for, sorted."""
    return tuple(sorted({t.condition for t in robot.transitions.values() if t.condition is not None}))


def objects_in(robot: RobotProgram) -> tuple[str, ...]:
    """Return the descriptions of the objects that a robot goes to or points at, sorted."""
    return tuple(sorted({found for move in robot.moves for found in objects_of(move)}))


def deciding(program: Program) -> dict[str, tuple[TracedStep, ...]]:
    """Return, for each condition, the moves after which somebody asks for it; sorted by condition."""
    return _by_name(
        (transition.condition, TracedStep("choice", robot.id, move.id, move.task, move.rule))
        for robot in program.robots
        for index, move in enumerate(robot.moves)
        if (transition := robot.transitions.get(index)) is not None and transition.condition is not None
    )


def seeking(program: Program) -> dict[str, tuple[TracedStep, ...]]:
    """Return, for each object's description, the moves that need its place; sorted by description."""
    return _by_name(
        (found, TracedStep("object", robot.id, move.id, move.task, move.rule))
        for robot in program.robots
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
    """Return, for each slot that somebody activates, or deactivates, the robots that do."""
    found: dict[str, dict[str, None]] = {}
    for sender in program.robots:
        for (owner, slot), value in sender.settings:
            if owner == robot.id and value is active:
                found.setdefault(slot, {})[sender.id] = None
    return tuple((slot, tuple(senders)) for slot, senders in sorted(found.items()))


def _ordered(robot: RobotProgram) -> tuple[int, ...]:
    reached = in_order(robot)
    return (*reached, *(index for index in range(len(robot.moves)) if index not in set(reached)))


def _step(index: int, context: RobotContext, trace: TracedStep) -> StepView:
    robot = context.robot
    move, transition = robot.moves[index], robot.transitions.get(index)
    named: list[tuple[str, object]] = []
    for name, actions in (("before", move.before), ("after", move.after)):
        if actions:
            named.append((name, tuple(action_of(action, context) for action in actions)))
    if transition is not None:
        named.append(("then", _then(transition, robot)))
    named += [(name, value) for name, value in (("task", move.task), ("rule", move.rule)) if value]
    call = Call("Step", (move.id, movement_of(move, context)), tuple(named))
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


def _protection(robot: RobotProgram, input: TargetInput) -> _Protection:
    if input.program.frame.is_local:
        return _Protection((), Refuges(), ())
    refuges = refuges_of(robot, input.program, input.types, input.areas)
    escapes = escapes_of(robot, input, refuges.points)
    return _Protection(fences_of(robot, input, escapes), refuges, escapes)


def _head(
    context: RobotContext, input: TargetInput, kept: _Protection, plan: str
) -> Iterator[tuple[str, object]]:
    robot, program = context.robot, input.program
    home = robot.home or (0.0, 0.0, 0.0)
    yield "id", robot.id
    yield "mission", program.name
    yield "plan", plan
    yield "fleet", tuple(each.id for each in program.robots)
    yield "log", log_name(robot.id)
    yield "vehicle", context.vehicle.name
    yield "home", place_of(home, context)
    yield "neighbours", tuple((name, place_of(its, context)) for name, its in neighbours_of(robot, input))
    yield "start", robot.moves[robot.start].id
    yield "slots", robot.slots
    yield "senders", senders_of(robot, program, active=True)
    yield "resets", senders_of(robot, program, active=False)
    yield "volatile", tuple(sorted(program.volatile & {slot for slot, _ in robot.settings}))
    yield "policies", tuple(_policy(policy) for policy in policies_of(robot, input))
    yield "reserve", program.reserve
    yield from _endurance(context)
    manner = manner_of(robot, program.position_error)
    names = ("acceptance", "radius", "margin")
    how = tuple((name, getattr(manner, name)) for name in names)
    yield "travel", Call("Travel", (robot.travel_mode,), how)
    yield "runs", tuple(_run(run, robot) for run in runs_of(context))
    yield "fence", tuple(tuple(_ground(vertex, context) for vertex in fence.ring) for fence in kept.fences)
    shared = (kept.refuges.shared,) if kept.refuges.shared else ()
    yield "tight", (*(str(fence) for fence in kept.fences if fence.is_tight), *shared)
    points = kept.refuges.points
    yield "rally", tuple(place_of((*point, _highest(context)), context) for point in points)
    yield "escapes", tuple(_escape(each, context) for each in kept.escapes)
    if _escapes_alone(robot, input) and not straight_lines_are_clear(context, input, points):
        yield "straight", False


def _escape(escape: Escape, context: RobotContext) -> tuple[str, tuple[Call, ...]]:
    return escape.move, tuple(place_of(place, context) for place in escape.places)


def _escapes_alone(robot: RobotProgram, input: TargetInput) -> bool:
    """Return whether the vehicle is to reach an emergency area by itself, anywhere."""
    everywhere = policies_of(robot, input)
    somewhere = (policy for each in robot.transitions.values() for policy in each.policies)
    return ("LINK_LOST", "EMERGENCY_AREA") in ((p.event, p.response) for p in (*everywhere, *somewhere))


def _endurance(context: RobotContext) -> Iterator[tuple[str, object]]:
    """Yield what the robot's type says of how long it lasts, and how fast it goes back and comes down."""
    if context.type is None or (capability := capability_of(context.robot, context.type)) is None:
        return
    slowest, fastest = capability.speed
    cruise = max(slowest, TRAVEL_FACTORS.get(context.robot.travel_mode, 0.75) * fastest)
    for name, value in (
        ("endurance", capability.lifetime),
        ("cruise", metres(cruise)),
        ("fastest", metres(fastest)),
        ("descent", capability.descent_rate if context.vehicle.flies else None),
    ):
        if value is not None:
            yield name, value


def _run(run: Run, robot: RobotProgram) -> Call:
    return Call("Run", (tuple(robot.moves[move].id for move in run.moves), run.holds))


def _policy(policy: Policy) -> Call:
    after = () if policy.after is None else (policy.after,)
    return Call("Policy", (policy.event, policy.response, *after))


def _ground(vertex: Point, context: RobotContext) -> Call:
    return place_of((*vertex, context.zero), context)


def _highest(context: RobotContext) -> float:
    ups = [move.target.position[2] for move in context.robot.moves if move.target and move.target.position]
    return max(ups, default=context.zero)


def _words(value: object) -> set[str]:
    if isinstance(value, Call):
        inner = _words((value.positional, [each for _, each in value.named]))
        return {value.function} | inner
    if isinstance(value, tuple | list):
        return set().union(*(_words(each) for each in value))
    return set()
