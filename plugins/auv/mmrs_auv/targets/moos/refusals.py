"""What behaviour files of the helm cannot express."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_auv.targets.moos.steps import Variables, course_of, posts_of, variables_for
from mmrs_auv.targets.moves import MOVES, above_surface
from mmrs_core.behaviour.program import Move, RobotProgram, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.escaping import file_stems
from mmrs_core.mavlink.context import RobotContext, context_of, homeless
from mmrs_core.scene import Policy


def nodes_of(input: TargetInput) -> dict[str, str]:
    """Return the name of each robot's community, which names its file, too."""
    return file_stems([robot.id for robot in input.program.robots])


def refusals(input: TargetInput) -> Iterator[str]:
    """Yield each thing that behaviour files cannot express, with robot and move."""
    nodes = nodes_of(input)
    for robot in input.program.robots:
        yield from _of_robot(robot, input, nodes)


def _of_robot(robot: RobotProgram, input: TargetInput, nodes: Mapping[str, str]) -> Iterator[str]:
    if robot.home is None:
        yield homeless(robot)
    context = context_of(robot, input, geographic=False)
    if context.vehicle.flies:
        yield f"robot '{robot.id}': flies, and depths of a helm count down from the water surface"
        return
    variables = variables_for(context, input, nodes)
    of_type = context.type.policies if context.type is not None else ()
    for policy in dict.fromkeys((*robot.policies, *of_type)):
        yield f"robot '{robot.id}': {_described(policy)}"
    for index, move in enumerate(robot.moves):
        for why in _of_move(move, context, variables):
            yield f"{context.label(move)}: {why}"
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield f"{context.label(move)}: {_described(policy)}"
    yield from _rings(robot, context)
    for move, why in course_of(context, variables).faults:
        yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: RobotContext, variables: Variables) -> Iterator[str]:
    known = MOVES.get(move.metaclasses[0])
    if known is None:
        yield f"{move.kind} is not known to this target"
    if known == "go" and context.speed(move) is None:
        yield "its speed is not known, because its robot type is not given"
    if known == "turn":
        yield "turns on the spot, which no behaviour of a helm does"
    elif move.heading is not None:
        yield "heading on the way, where a helm looks ahead"
    if move.target is not None:
        if move.target.description is not None:
            yield f"object '{move.target.description}', which a helm cannot have looked for"
        if move.target.position is not None and above_surface(move.target.position, context) > 1e-6:
            yield f"leads {above_surface(move.target.position, context):g} m above the surface"
    for action in (*move.before, *move.after):
        posts = posts_of(action, context.type, variables)
        if isinstance(posts, str):
            yield posts


def _rings(robot: RobotProgram, context: RobotContext) -> Iterator[str]:
    """Yield which moves lead back to one from which they come."""
    state: dict[int, str] = {}
    path: list[tuple[int, Iterator[int]]] = [(robot.start, iter(_ways(robot.transitions.get(robot.start))))]
    state[robot.start] = "open"
    while path:
        index, ways = path[-1]
        way = next(ways, None)
        if way is None:
            state[index] = "closed"
            path.pop()
        elif state.get(way) == "open":
            again = robot.moves[way].id
            yield f"{context.label(robot.moves[index])}: '{again}' comes round again, which no helm does"
        elif way not in state:
            state[way] = "open"
            path.append((way, iter(_ways(robot.transitions.get(way)))))


def _ways(transition: Transition | None) -> tuple[int, ...]:
    return transition.ways if transition is not None else ()


def _described(policy: Policy) -> str:
    after = "" if policy.after is None else f" after {policy.after:g} s"
    return f"policy {policy.event}{after}: {policy.response}, which only behaviours of yours can do"
