"""The order of tasks."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from typing import TypeVar

from mmrs_core.analysis.constraints.findings import MISSION, called, finding
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.behaviour.walk import components
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.diagnostics import Severity
from mmrs_core.grounding.features import child, children, number
from mmrs_core.languages.element import Element, label_of, path_of
from mmrs_core.languages.modelset import ModelSet

Node = TypeVar("Node", bound=Hashable)


def cycles_in(after: Mapping[Node, Collection[Node]]) -> Iterator[tuple[Node, ...]]:
    """Yield cycles of at least two nodes, so many that none is left without a node of theirs.

    Each is a shortest one through the first of the nodes that lead to each other. Cycles that have
    nothing to do with each other take linear time, however many they are.

    >>> list(cycles_in({1: [2], 2: [1, 3], 3: [3, 4], 4: []}))
    [(1, 2)]
    """
    place = {node: index for index, node in enumerate(after)}
    pending: list[Sequence[Node]] = [tuple(after)]
    while pending:
        for knot in _knots(pending.pop(), after):
            first = min(knot, key=place.__getitem__)
            cycle = _shortest_cycle(first, knot, after)
            yield cycle
            pending.append(tuple(node for node in knot if node not in cycle))


def _knots(nodes: Sequence[Node], after: Mapping[Node, Collection[Node]]) -> Iterator[frozenset[Node]]:
    """Yield the sets of nodes that lead to each other, those of one node left out."""
    place = {node: index for index, node in enumerate(nodes)}
    graph = [[place[each] for each in after[node] if each in place] for node in nodes]
    for part in reversed(components(graph)):
        if len(part) > 1:
            yield frozenset(nodes[index] for index in part)


def _shortest_cycle(
    start: Node, knot: frozenset[Node], after: Mapping[Node, Collection[Node]]
) -> tuple[Node, ...]:
    came_from: dict[Node, Node] = {}
    pending = deque([start])
    while start not in came_from:
        node = pending.popleft()
        for each in after[node]:
            if each in knot and each not in came_from and each != node:
                came_from[each] = node
                pending.append(each)
    path = [start]
    while (node := came_from[path[-1]]) != start:
        path.append(node)
    return (start, *reversed(path[1:]))


def _cycles(mission: Element, models: ModelSet) -> Iterator[Finding]:
    for cycle in cycles_in(sketch_of(models).order.after):
        path = " → ".join(label_of(task) or path_of(task) for task in (*cycle, cycle[0]))
        yield finding(cycle[0], f"waits for itself: {path}")


def _itself(dependency: Element, models: ModelSet) -> Iterator[Finding]:
    before, after = child(dependency, "from"), child(dependency, "to")
    if before is not None and before is after:
        yield finding(dependency, f"{called(before)} waits for itself")


def _twice(mission: Element, models: ModelSet) -> Iterator[Finding]:
    seen: dict[tuple[Element | None, Element | None], Element] = {}
    for dependency in children(mission, "taskDependencies"):
        ends = (child(dependency, "from"), child(dependency, "to"))
        if None not in ends and ends in seen:
            yield finding(dependency, f"leads between the same tasks as {path_of(seen[ends])}")
        seen.setdefault(ends, dependency)


def _elsewhere(mission: Element, models: ModelSet) -> Iterator[Finding]:
    tasks = set(children(mission, "tasks"))
    for dependency in children(mission, "taskDependencies"):
        for end in ("from", "to"):
            task = child(dependency, end)
            if task is not None and task not in tasks:
                yield finding(
                    dependency, f"{end} leads to {called(task)}, which is not a task of this mission"
                )


def _few_outgoing(fork: Element, models: ModelSet) -> Iterator[Finding]:
    count = len(sketch_of(models).order.after.get(fork, ()))
    if count < 2:
        yield finding(fork, f"has {count or 'no'} outgoing dependency, at least 2 are needed")


def _few_incoming(join: Element, models: ModelSet) -> Iterator[Finding]:
    count = len(sketch_of(models).order.before.get(join, ()))
    if count < 2:
        yield finding(join, f"has {count or 'no'} incoming dependency, at least 2 are needed")


def _window(task: Element, models: ModelSet) -> Iterator[Finding]:
    earliest, deadline = number(task, "earliestStart"), number(task, "deadline")
    if earliest is not None and deadline is not None and deadline <= earliest:
        yield finding(task, f"ends by {deadline:g} s, but begins no sooner than at {earliest:g} s")


def _late(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield tasks whose deadline passes before what they wait for may even begin."""
    order = sketch_of(models).order
    earliest: dict[Element, tuple[float, Element]] = {}
    for task in order.ranks:
        behind = [earliest[each] for each in order.before[task] if each in earliest]
        start, cause = max(behind, key=lambda each: each[0], default=(0.0, task))
        deadline, own = number(task, "deadline"), number(task, "earliestStart") or 0.0
        if deadline is not None and own < deadline <= start:
            yield finding(
                task, f"ends by {deadline:g} s, but waits for {called(cause)}, which begins at {start:g} s"
            )
        earliest[task] = (own, task) if own >= start else (start, cause)


CONSTRAINTS = (
    Constraint(
        "MML040",
        "Task dependencies are acyclic.",
        (MISSION, "Mission"),
        _cycles,
        "remove one of the dependencies of the cycle",
    ),
    Constraint(
        "MML041",
        "A dependency leads from one task to another.",
        (MISSION, "TaskDependency"),
        _itself,
        "remove the dependency",
    ),
    Constraint(
        "MML042",
        "There is one dependency between two tasks.",
        (MISSION, "Mission"),
        _twice,
        "keep one of them",
        Severity.WARNING,
    ),
    Constraint(
        "MML043",
        "A Fork has at least two outgoing dependencies.",
        (MISSION, "Fork"),
        _few_outgoing,
        "let at least two tasks depend on the fork, or remove the fork",
    ),
    Constraint(
        "MML044",
        "A Join has at least two incoming dependencies.",
        (MISSION, "Join"),
        _few_incoming,
        "let the join depend on at least two tasks, or remove the join",
    ),
    Constraint(
        "MML053",
        "A dependency leads between tasks of the mission.",
        (MISSION, "Mission"),
        _elsewhere,
        "refer to tasks that stand in this mission",
    ),
    Constraint(
        "MML055",
        "A task's deadline lies after the earliest start of what it waits for.",
        (MISSION, "Mission"),
        _late,
        "move the deadline, or let what it waits for begin sooner",
    ),
    Constraint(
        "MML063",
        "A task's deadline lies after its earliest start.",
        (MISSION, "Task"),
        _window,
        "both count seconds from the mission's start",
    ),
)
