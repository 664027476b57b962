"""What the begin of a move and the activation of a slot depend on.

A node is a move, as (robot, index), or a slot, as (robot, name). A move depends on those that lead to
it and on the slots awaited on the way; a slot depends on the moves that activate it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import TypeAlias

from mmrs_core.analysis.durations import Durations
from mmrs_core.behaviour.program import Program, RobotProgram, SlotId
from mmrs_core.behaviour.walk import components, reachable_moves, successors

At: TypeAlias = tuple[str, int]
Node: TypeAlias = "At | SlotId"


@dataclass(frozen=True, slots=True)
class Activation:
    """A move that activates a slot, or makes it inactive.

    Attributes:
        at: the move that does it.
        after: seconds from that move's begin, at most.
        certain: whether the move is made in every run that ends.
        moved: whether it is done after the movement.
    """

    at: At
    after: float
    certain: bool
    moved: bool


class Dependencies:
    """The graph of a whole behaviour. Building it is linear in moves, actions and transitions.

    Attributes:
        resets: where slots are made inactive, by slot. waits: after which moves slots are awaited.
    """

    def __init__(self, program: Program, durations: Mapping[str, Durations]) -> None:
        self.resets: dict[SlotId, list[Activation]] = defaultdict(list)
        self.waits: dict[SlotId, list[At]] = defaultdict(list)
        self._activations: dict[SlotId, list[Activation]] = defaultdict(list)
        self._arrivals: dict[At, list[tuple[At, tuple[SlotId, ...]]]] = {}
        for robot in program.robots:
            self._add_settings(robot, durations[robot.id])
            self._add_arrivals(robot, durations[robot.id])

    def _add_settings(self, robot: RobotProgram, durations: Durations) -> None:
        certain = certain_moves(robot)
        for index, duration in durations.of.items():
            early = sum(bool(action.sets) for action in robot.moves[index].before)
            for number, setting in enumerate(duration.settings):
                made = Activation((robot.id, index), setting.after.high, index in certain, number >= early)
                for slot in setting.slots:
                    (self._activations if setting.active else self.resets)[slot].append(made)

    def _add_arrivals(self, robot: RobotProgram, durations: Durations) -> None:
        for index in durations.of:
            self._arrivals.setdefault((robot.id, index), [])
            transition = robot.transitions.get(index)
            if transition is not None:
                waits = tuple((robot.id, name) for name in transition.waits)
                for slot in waits:
                    self.waits[slot].append((robot.id, index))
                for after in transition.next_moves:
                    self._arrivals.setdefault((robot.id, after), []).append(((robot.id, index), waits))

    def is_slot(self, node: Node) -> bool:
        """Return whether a node is a slot, not a move."""
        return isinstance(node[1], str)

    def arrivals_at(self, move: Node) -> list[tuple[At, tuple[SlotId, ...]]]:
        """Return the moves that lead to a move, each with the slots awaited on the way."""
        return self._arrivals.get((move[0], int(move[1])), [])

    def activations_of(self, slot: Node) -> list[Activation]:
        """Return the moves that activate a slot; empty if none does."""
        return self._activations.get((slot[0], str(slot[1])), [])

    def in_order(self) -> Iterator[Node]:
        """Yield every node after all that it depends on; nodes in or behind a loop never come.

        Where slots and moves depend on each other in a circle, a slot that some move certainly
        activates comes after that move alone: its other activations come later, or never.
        """
        needs: dict[Node, int] = defaultdict(int)
        feeds: dict[Node, list[Node]] = defaultdict(list)
        for source, target in self._edges():
            needs[target] += 1
            feeds[source].append(target)
        nodes: list[Node] = [*self._arrivals, *self._activations]
        done: set[Node] = set()
        ready = [node for node in nodes if not needs[node]]
        while ready:
            node = ready.pop()
            done.add(node)
            yield node
            for target in feeds[node]:
                needs[target] -= 1
                if not needs[target] and target not in done:
                    ready.append(target)
            if not ready:
                ready.extend(islice((slot for slot in self._activations if self._may_come(slot, done)), 1))

    def _may_come(self, slot: SlotId, done: set[Node]) -> bool:
        activations = self._activations[slot]
        return slot not in done and any(each.certain and each.at in done for each in activations)

    def _edges(self) -> Iterator[tuple[Node, Node]]:
        for target, arrivals in self._arrivals.items():
            for source, waits in arrivals:
                yield source, target
                yield from ((slot, target) for slot in waits if slot in self._activations)
        for slot, activations in self._activations.items():
            yield from ((activation.at, slot) for activation in activations)


def certain_moves(robot: RobotProgram) -> frozenset[int]:
    """Return the moves that the robot makes in every run that ends, whatever its Choices decide.

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
        for after in graph[move]:
            if group_of[after] != group_of[move]:
                arriving[group_of[after]] += 1
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
