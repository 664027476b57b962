"""The moves of a robot as a graph: what follows what, what can be reached, what goes round."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import RobotProgram

Graph: TypeAlias = Sequence[Sequence[int]]


def successors(robot: RobotProgram) -> tuple[tuple[int, ...], ...]:
    """Return for each move the moves that may follow it, each once."""
    ways: list[tuple[int, ...]] = [()] * len(robot.moves)
    for source, transition in robot.transitions.items():
        ways[source] = tuple(dict.fromkeys(transition.next_moves))
    return tuple(ways)


def reversed_graph(graph: Graph) -> tuple[tuple[int, ...], ...]:
    """Return the graph with every edge turned round."""
    turned: list[list[int]] = [[] for _ in graph]
    for source, ways in enumerate(graph):
        for way in ways:
            turned[way].append(source)
    return tuple(map(tuple, turned))


def reachable(graph: Graph, sources: Iterable[int]) -> frozenset[int]:
    """Return the nodes that paths from the sources lead to, the sources included."""
    found = set(sources)
    pending = list(found)
    while pending:
        for way in graph[pending.pop()]:
            if way not in found:
                found.add(way)
                pending.append(way)
    return frozenset(found)


def reachable_moves(robot: RobotProgram) -> frozenset[int]:
    """Return the moves that some path from Start leads to."""
    return reachable(successors(robot), (robot.start,))


def moves_reaching_stop(robot: RobotProgram) -> frozenset[int]:
    """Return the moves from which some path leads to Stop."""
    return reachable(reversed_graph(successors(robot)), (robot.stop,))


def components(graph: Graph) -> tuple[tuple[int, ...], ...]:
    """Return the strongly connected components, each after all that it leads to.

    Tarjan's algorithm without recursion; linear in nodes and edges.
    """
    number: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    on_stack: set[int] = set()
    found: list[tuple[int, ...]] = []
    for root in range(len(graph)):
        if root in number:
            continue
        path = [(root, iter(graph[root]))]
        number[root] = low[root] = len(number)
        stack.append(root)
        on_stack.add(root)
        while path:
            node, ways = path[-1]
            for way in ways:
                if way not in number:
                    number[way] = low[way] = len(number)
                    stack.append(way)
                    on_stack.add(way)
                    path.append((way, iter(graph[way])))
                    break
                if way in on_stack:
                    low[node] = min(low[node], number[way])
            else:
                path.pop()
                if path:
                    low[path[-1][0]] = min(low[path[-1][0]], low[node])
                if low[node] == number[node]:
                    found.append(_popped(stack, on_stack, node))
    return tuple(found)


def _popped(stack: list[int], on_stack: set[int], root: int) -> tuple[int, ...]:
    part: list[int] = []
    while not part or part[-1] != root:
        part.append(stack.pop())
    on_stack.difference_update(part)
    return tuple(sorted(part))


def in_order(robot: RobotProgram) -> tuple[int, ...]:
    """Return the moves reachable from Start, each before what follows it as far as cycles allow."""
    graph = successors(robot)
    found = reachable(graph, (robot.start,))
    parts = components(graph)
    return tuple(move for part in reversed(parts) for move in part if move in found)
