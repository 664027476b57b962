"""Lays out a directed graph in columns from left to right.

The classical method in four steps (Sugiyama, Tagawa and Toda 1981): columns by longest path, corridors
for edges that pass columns, order by barycentre, heights by the neighbours' mean. The same graph
always gets the same layout.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

SWEEPS = 24
COLUMN_GAP, ROW_GAP = 70.0, 16.0
"""Pixels between columns, and between the boxes of one."""
CORRIDOR = 10.0
"""Height in pixels that an edge takes where it passes a column."""


@dataclass(frozen=True, slots=True)
class Box:
    """A node: its size in pixels."""

    name: str
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class Placed:
    """Where the layout puts things.

    Attributes:
        corners: upper left corner of each box.
        rights: by box, where its column ends on the right.
        ways: by index of the edge, the points by which it passes the columns between its ends.
        width, height: of the whole drawing.
    """

    corners: Mapping[str, tuple[float, float]]
    rights: Mapping[str, float]
    ways: Mapping[int, tuple[tuple[float, float], ...]]
    width: float
    height: float


@dataclass(slots=True)
class _Node:
    height: float
    column: int
    box: Box | None = None
    before: list[int] = field(default_factory=list)
    after: list[int] = field(default_factory=list)
    y: float = 0.0


def layout(boxes: Sequence[Box], edges: Sequence[tuple[str, str]]) -> Placed:
    """Return a layout in which edges lead to the right wherever the graph has no circle.

    Args:
        boxes: in an order that breaks ties.
        edges: (from, to) names of boxes; an edge from a box to itself is ignored.
    """
    names = {box.name: index for index, box in enumerate(boxes)}
    pairs = [(names[a], names[b]) for a, b in edges]
    forward = _without_circles(len(boxes), pairs)
    columns = _columns(len(boxes), [pair for pair, ahead in zip(pairs, forward, strict=True) if ahead])
    nodes = [_Node(box.height, columns[index], box) for index, box in enumerate(boxes)]
    passed = _corridors(nodes, pairs, forward)
    ordered = _ordered(nodes)
    _raise_and_lower(nodes, ordered)
    return _placed(nodes, ordered, passed)


def _without_circles(count: int, pairs: Sequence[tuple[int, int]]) -> list[bool]:
    """Return which edges lead forward once those that close a circle are left out."""
    outgoing: list[list[int]] = [[] for _ in range(count)]
    for index, (start, _) in enumerate(pairs):
        outgoing[start].append(index)
    state, forward = [0] * count, [True] * len(pairs)

    def visit(node: int) -> None:
        state[node] = 1
        for index in outgoing[node]:
            target = pairs[index][1]
            if state[target] == 1:
                forward[index] = False
            elif state[target] == 0:
                visit(target)
        state[node] = 2

    for node in range(count):
        if state[node] == 0:
            visit(node)
    return forward


def _columns(count: int, pairs: Iterable[tuple[int, int]]) -> list[int]:
    """Return the column of each box: the longest path to it, sources as near to their targets as can be."""
    listed = list(pairs)
    columns = [0] * count
    for _ in range(count):
        for start, end in listed:
            columns[end] = max(columns[end], columns[start] + 1)
    for node in range(count):
        if not any(end == node for _, end in listed):
            reached = [columns[end] for start, end in listed if start == node]
            columns[node] = min(reached) - 1 if reached else 0
    return columns


def _corridors(
    nodes: list[_Node], pairs: Sequence[tuple[int, int]], forward: Sequence[bool]
) -> dict[int, list[int]]:
    """Link neighbours; add a node in every column that an edge passes. Return those nodes by edge."""
    passed: dict[int, list[int]] = {}
    for index, (start, end) in enumerate(pairs):
        if not forward[index] or start == end:
            continue
        chain = [start]
        for column in range(nodes[start].column + 1, nodes[end].column):
            nodes.append(_Node(CORRIDOR, column))
            chain.append(len(nodes) - 1)
        passed[index] = chain[1:]
        for left, right in pairwise([*chain, end]):
            nodes[left].after.append(right)
            nodes[right].before.append(left)
    return passed


def _ordered(nodes: Sequence[_Node]) -> list[list[int]]:
    """Return the nodes of each column from top to bottom, neighbours near each other."""
    count = max((node.column for node in nodes), default=-1) + 1
    columns: list[list[int]] = [[] for _ in range(count)]
    for index, node in enumerate(nodes):
        columns[node.column].append(index)
    for sweep in range(SWEEPS):
        forward = sweep % 2 == 0
        rank = {index: place / len(column) for column in columns for place, index in enumerate(column)}
        for column in columns if forward else reversed(columns):
            wish = {
                index: _mean(rank, nodes[index].before if forward else nodes[index].after, rank[index])
                for index in column
            }
            column.sort(key=lambda index: (wish[index], rank[index]))
            rank.update({index: place / len(column) for place, index in enumerate(column)})
    return columns


def _mean(values: Mapping[int, float], of: Sequence[int], otherwise: float) -> float:
    return sum(values[index] for index in of) / len(of) if of else otherwise


def _raise_and_lower(nodes: Sequence[_Node], columns: Sequence[Sequence[int]]) -> None:
    """Give every node a height near its neighbours', in the order of its column, without overlap."""
    for column in columns:
        _stack(nodes, column, dict.fromkeys(column, 0.0))
    for sweep in range(SWEEPS * 2):
        forward = sweep % 2 == 0
        for column in columns if forward else reversed(columns):
            wish = {}
            for index in column:
                near = [*nodes[index].before, *nodes[index].after]
                middles = {other: nodes[other].y + nodes[other].height / 2 for other in near}
                own = nodes[index].y + nodes[index].height / 2
                wish[index] = _mean(middles, near, own) - nodes[index].height / 2
            _stack(nodes, column, wish)


def _stack(nodes: Sequence[_Node], column: Sequence[int], wish: Mapping[int, float]) -> None:
    """Place a column's nodes as near to their wishes as order and gaps allow.

    Nodes that would overlap move together, to the mean of their wishes (isotonic regression by
    pooling adjacent violators).
    """
    blocks: list[tuple[float, list[int], float]] = []
    for index in column:
        height = nodes[index].height + ROW_GAP
        blocks.append((wish[index], [index], height))
        while len(blocks) > 1 and blocks[-2][0] + blocks[-2][2] > blocks[-1][0]:
            top, upper, upper_height = blocks[-2]
            below, lower, lower_height = blocks[-1]
            share = len(lower) / (len(upper) + len(lower))
            merged = top * (1 - share) + (below - upper_height) * share
            blocks[-2:] = [(merged, [*upper, *lower], upper_height + lower_height)]
    for top, members, _ in blocks:
        y = top
        for index in members:
            nodes[index].y = y
            y += nodes[index].height + ROW_GAP


def _placed(
    nodes: Sequence[_Node], columns: Sequence[Sequence[int]], passed: Mapping[int, Sequence[int]]
) -> Placed:
    top = min((node.y for node in nodes), default=0.0)
    lefts, x = [], 0.0
    widths = [max((_width(nodes[index]) for index in column), default=0.0) for column in columns]
    for width in widths:
        lefts.append(x)
        x += width + COLUMN_GAP
    corners = {node.box.name: (lefts[node.column], node.y - top) for node in nodes if node.box is not None}
    ways = {
        edge: tuple(
            (lefts[nodes[i].column] + side * widths[nodes[i].column], nodes[i].y - top + CORRIDOR / 2)
            for i in chain
            for side in (0, 1)
        )
        for edge, chain in passed.items()
    }
    rights = {
        node.box.name: lefts[node.column] + widths[node.column] for node in nodes if node.box is not None
    }
    bottom = max((node.y + node.height for node in nodes), default=0.0)
    return Placed(corners, rights, ways, max(x - COLUMN_GAP, 0.0), bottom - top)


def _width(node: _Node) -> float:
    return node.box.width if node.box is not None else 0.0
