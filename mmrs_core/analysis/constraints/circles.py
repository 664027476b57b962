"""Circles in a graph: what waits for itself."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)


def circles_in(after: Mapping[Node, Collection[Node]]) -> Iterator[tuple[Node, ...]]:
    """Yield circles of at least two nodes, so many that none is left without a node of theirs.

    Each is a shortest one through the first of the nodes that lead to each other. Circles that have
    nothing to do with each other take linear time, however many they are.

    >>> list(circles_in({1: [2], 2: [1, 3], 3: [3, 4], 4: []}))
    [(1, 2)]
    """
    place = {node: index for index, node in enumerate(after)}
    pending: list[Sequence[Node]] = [tuple(after)]
    while pending:
        for knot in _knots(pending.pop(), after):
            first = min(knot, key=place.__getitem__)
            circle = _circle(first, knot, after)
            yield circle
            pending.append(tuple(node for node in knot if node not in circle))


def _knots(nodes: Sequence[Node], after: Mapping[Node, Collection[Node]]) -> Iterator[frozenset[Node]]:
    """Yield the sets of nodes that lead to each other, those of one node left out (Kosaraju, 1978)."""
    inside = frozenset(nodes)
    following = {node: [each for each in after[node] if each in inside] for node in nodes}
    before: dict[Node, list[Node]] = {node: [] for node in nodes}
    for node, ways in following.items():
        for each in ways:
            before[each].append(node)
    left: set[Node] = set()
    for node in reversed(_left(nodes, following, set())):
        knot = frozenset(_left((node,), before, left))
        if len(knot) > 1:
            yield knot


def _left(
    starts: Sequence[Node], ways: Mapping[Node, Sequence[Node]], entered: set[Node]
) -> tuple[Node, ...]:
    """Return the nodes that a depth first search newly enters, in the order in which it leaves them."""
    order: list[Node] = []
    for start in starts:
        open_nodes = [] if start in entered else [(start, iter(ways[start]))]
        entered.add(start)
        while open_nodes:
            node, rest = open_nodes[-1]
            each = next((each for each in rest if each not in entered), None)
            if each is None:
                order.append(node)
                open_nodes.pop()
            else:
                entered.add(each)
                open_nodes.append((each, iter(ways[each])))
    return tuple(order)


def _circle(start: Node, knot: frozenset[Node], after: Mapping[Node, Collection[Node]]) -> tuple[Node, ...]:
    """Return a shortest circle through a node of a knot."""
    came_from: dict[Node, Node] = {}
    pending = deque([start])
    while start not in came_from:
        node = pending.popleft()
        for each in after[node]:
            if each in knot and each not in came_from and each != node:
                came_from[each] = node
                pending.append(each)
    way = [start]
    while (node := came_from[way[-1]]) != start:
        way.append(node)
    return (start, *reversed(way[1:]))
