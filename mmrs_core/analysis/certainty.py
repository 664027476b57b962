"""Which moves of a robot are on every way from Start to Stop."""

from __future__ import annotations

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.behaviour.walk import components, reachable_moves, successors


def certain_moves(robot: RobotProgram) -> frozenset[int]:
    """Return the moves that the robot makes in every run that ends, whatever way its Choices go.

    In an order in which every move comes before those it leads to, a move is certain if no edge passes
    by it, from before it to behind it. Loops stand in this order as a whole; moves in them are left
    out, though some may be certain. Linear in moves and transitions.
    """
    graph = successors(robot)
    reachable = reachable_moves(robot)
    groups = [group for group in reversed(components(graph)) if group[0] in reachable]
    group_of = {move: number for number, group in enumerate(groups) for move in group}
    arriving = [0] * len(groups)
    leaving = [0] * len(groups)
    for move in reachable:
        for way in graph[move]:
            if group_of[way] != group_of[move]:
                arriving[group_of[way]] += 1
                leaving[group_of[move]] += 1
    certain: set[int] = set()
    passing = 0
    for number, group in enumerate(groups):
        passing -= arriving[number]
        if passing == 0 and not goes_round(group, graph):
            certain.update(group)
        passing += leaving[number]
    return frozenset(certain)


def goes_round(group: tuple[int, ...], graph: tuple[tuple[int, ...], ...]) -> bool:
    """Return whether a strongly connected component has a cycle."""
    return len(group) > 1 or group[0] in graph[group[0]]
