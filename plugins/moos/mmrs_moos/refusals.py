"""What behaviour files of the helm cannot express."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_core.behaviour.program import Move, RobotProgram, Transition
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.context import RobotContext, homeless
from mmrs_core.generation.escaping import file_stems
from mmrs_core.generation.plan_moves import context_of, vehicleless
from mmrs_core.generation.plan_refusals import Wording, of_movement, of_policies, of_policy
from mmrs_moos.steps import Variables, course_of, posts_of, variables_for

VEHICLES = ("ground", "rover", "sub")
"""Classes of vehicles that these plans are for."""

WORDING = Wording(
    turn="which no behaviour of a helm does",
    heading="where a helm looks ahead",
    object="which a helm cannot have looked for",
    policy="behaviours of yours",
)


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
    if unknown := vehicleless(robot, input, VEHICLES):
        yield unknown
        return
    context = context_of(robot, input, VEHICLES)
    if context.flies:
        yield f"robot '{robot.id}': flies, and depths of a helm count down from the water surface"
        return
    variables = variables_for(context, input, nodes)
    yield from of_policies(robot, context, WORDING)
    for index, move in enumerate(robot.moves):
        for why in _of_move(move, context, variables):
            yield f"{context.label(move)}: {why}"
        transition = robot.transitions.get(index)
        for policy in transition.policies if transition is not None else ():
            yield f"{context.label(move)}: {of_policy(policy, WORDING)}"
    yield from _rings(robot, context)
    for move, why in course_of(context, variables).faults:
        yield f"{context.label(move)}: {why}"


def _of_move(move: Move, context: RobotContext, variables: Variables) -> Iterator[str]:
    yield from of_movement(move, context, WORDING)
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
    return transition.next_moves if transition is not None else ()
