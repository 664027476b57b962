"""What is certainly over when a move begins, because robots wait for each other.

However uncertain times are: when a robot continues after waiting for a slot, the move that activated the
slot has got so far, and what that robot did before is over. A set of what is over is one whole number
for each robot: bit 2i stands for the movement of its move i, bit 2i + 1 for the wait after it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TypeAlias

from mmrs_core.analysis.dependencies import Activation, At, Dependencies, Node
from mmrs_core.behaviour.program import Program, SlotId
from mmrs_core.behaviour.walk import Graph, reachable, reachable_moves, successors

Over: TypeAlias = dict[str, int]


class HappensBefore:
    """Which moves, and waits after them, are over before which others begin. Built in one pass."""

    def __init__(self, program: Program, dependencies: Dependencies) -> None:
        self._dependencies = dependencies
        self._graphs = {robot.id: successors(robot) for robot in program.robots}
        self._moves = {robot.id: reachable_moves(robot) for robot in program.robots}
        self._past = cache(self._behind)
        self._over: dict[Node, Over] = {}
        for node in dependencies.in_order():
            if dependencies.is_slot(node):
                self._over[node] = self._at_activation(node)
            else:
                self._over[node] = self._at_begin(node)

    def is_over(self, earlier: At, waiting: bool, later: At) -> bool:
        """Return whether a movement, or the wait after it, is over before a later move begins."""
        robot, move = earlier
        mask = self._over.get(later, {}).get(robot, 0)
        if robot == later[0]:
            mask |= self._past(robot, later[1])
        return bool(mask >> (2 * move + int(waiting)) & 1)

    def _at_begin(self, node: Node) -> Over:
        paths = []
        for source, waits in self._dependencies.arrivals_at(node):
            known = dict(self._over.get(source, {}))
            for slot in waits:
                _unite(known, self._over.get(slot, {}))
            paths.append(known)
        return _common(paths)

    def _at_activation(self, node: Node) -> Over:
        causes = []
        for activation in self._dependencies.activations_of(node):
            known = dict(self._over.get(activation.at, {}))
            robot, move = activation.at[0], int(activation.at[1])
            _unite(known, {robot: self._past(robot, move) | (int(activation.moved) << 2 * move)})
            causes.append(known)
        return _common(causes)

    def _behind(self, robot: str, move: int) -> int:
        """Return all that a robot cannot do any more once it has begun a move."""
        graph: Graph = self._graphs[robot]
        ahead = reachable(graph, graph[move])
        mask = 0
        for other in self._moves[robot] - ahead:
            mask |= (0 if other == move else 3) << 2 * other
        return mask


def _unite(known: Over, more: Mapping[str, int]) -> None:
    for robot, mask in more.items():
        known[robot] = known.get(robot, 0) | mask


def _common(paths: list[Over]) -> Over:
    if not paths:
        return {}
    first, *others = paths
    return {
        robot: mask
        for robot in first
        if (mask := _all(first[robot], [other.get(robot, 0) for other in others]))
    }


def _all(mask: int, others: list[int]) -> int:
    for other in others:
        mask &= other
    return mask


def passing_slots(dependencies: Dependencies, order: HappensBefore) -> frozenset[SlotId]:
    """Return the awaited slots that may become inactive between an activation and a wait.

    A reset does no harm if it comes before every activation, or after every wait.
    """
    return frozenset(
        slot
        for slot, resets in dependencies.resets.items()
        if slot in dependencies.waits
        and not all(
            _before_all(reset, dependencies.activations_of(slot), order)
            or all(order.is_over(wait, True, reset.at) for wait in dependencies.waits[slot])
            for reset in resets
        )
    )


def _before_all(reset: Activation, activations: list[Activation], order: HappensBefore) -> bool:
    return all(order.is_over(reset.at, reset.moved, activation.at) for activation in activations)
