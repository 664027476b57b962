"""The mission's tasks as jobs with an order: control tasks dissolved, choices gathered.

A job is one task that robots may share, or a whole choice: everything between a Fork with conditions
and the task where its arms meet again, which is one robot's work.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from heapq import heapify, heappop, heappush

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Dependency, Scene, Task

_MISSION = "urn:mmrs:mission:1.0"
_CONTROL = ((_MISSION, "ControlTask"), (_MISSION, "Fork"), (_MISSION, "Join"))


@dataclass(frozen=True, slots=True)
class Choice:
    """A Fork whose outgoing dependencies carry conditions.

    Attributes:
        name: of the Fork.
        arms: (condition, what is done in order: names of tasks and inner choices); the else arm, whose
            condition is None, comes last.
    """

    name: str
    arms: tuple[tuple[str | None, tuple[str | Choice, ...]], ...]

    def tasks(self) -> Iterator[str]:
        """Yield the names of the tasks in all arms."""
        for _, items in self.arms:
            for item in items:
                yield from item.tasks() if isinstance(item, Choice) else (item,)


@dataclass(frozen=True, slots=True)
class Job:
    """Something to be done before or after other things.

    Attributes:
        name: of its task or Fork.
        choice: None for a single task.
        after: names of the jobs that must have ended before.
    """

    name: str
    choice: Choice | None
    after: tuple[str, ...]

    def tasks(self) -> tuple[str, ...]:
        """Return the names of its tasks."""
        return (self.name,) if self.choice is None else tuple(self.choice.tasks())


def is_control(task: Task) -> bool:
    """Return whether a task is a Fork or Join, which takes no time and no robot."""
    return any(task.part.is_a(name) for name in _CONTROL)


def jobs_of(scene: Scene) -> tuple[Job, ...]:
    """Return the jobs in an order in which none comes before one that it waits for.

    Among the possible orders the mission's own is kept as far as can be.

    Raises:
        InfeasibleError: dependencies go in a circle, or conditions do not make a choice.
    """
    graph = _Graph(scene)
    owner = graph.owners()
    members: dict[str, list[str]] = {}
    for name, job in owner.items():
        members.setdefault(job, []).append(name)
    jobs = [
        Job(name, graph.choices.get(name), tuple(sorted(graph.before(name, mine, owner))))
        for name, mine in members.items()
    ]
    return _sorted(jobs)


def _sorted(jobs: list[Job]) -> tuple[Job, ...]:
    by_name = {job.name: job for job in jobs}
    place = {job.name: i for i, job in enumerate(jobs)}
    sorter = TopologicalSorter({job.name: job.after for job in jobs})
    try:
        sorter.prepare()
    except CycleError as error:
        raise _in_a_circle(error) from error
    order: list[Job] = []
    ready = [(place[name], name) for name in sorter.get_ready()]
    heapify(ready)
    while ready:
        _, first = heappop(ready)
        order.append(by_name[first])
        sorter.done(first)
        for name in sorter.get_ready():
            heappush(ready, (place[name], name))
    return tuple(order)


def _in_a_circle(error: CycleError) -> InfeasibleError:
    """Return which tasks wait for each other, each before the one that waits for it."""
    return InfeasibleError(f"tasks wait for each other in a circle: {' → '.join(error.args[1])}")


class _Graph:
    """The mission's tasks and dependencies, with the choices found in them."""

    def __init__(self, scene: Scene) -> None:
        self.control = {task.name for task in scene.tasks if is_control(task)}
        self.names = [task.name for task in scene.tasks]
        self.out: dict[str, list[Dependency]] = {name: [] for name in self.names}
        self.into: dict[str, list[Dependency]] = {name: [] for name in self.names}
        for dependency in scene.dependencies:
            self.out[dependency.before].append(dependency)
            self.into[dependency.after].append(dependency)
        self._reach: dict[str, frozenset[str]] = {}
        self._check_circles()
        self._check_conditions()
        forks = [name for name in self.names if any(edge.condition for edge in self.out[name])]
        self._members = {fork: self._arm_members(fork) for fork in forks}
        inner = {name for arms in self._members.values() for arm in arms for name in arm}
        self.choices = {fork: self._choice(fork) for fork in forks if fork not in inner}

    def _check_circles(self) -> None:
        before = {name: [edge.before for edge in self.into[name]] for name in self.names}
        try:
            TopologicalSorter(before).prepare()
        except CycleError as error:
            raise _in_a_circle(error) from error

    def _check_conditions(self) -> None:
        reasons = []
        for name in self.names:
            conditions = [edge.condition for edge in self.out[name]]
            plain = sum(1 for condition in conditions if condition is None)
            if len(conditions) == plain:
                continue
            if name not in self.control:
                reasons.append(
                    f"task '{name}' has a condition on an outgoing dependency: only a Fork may have one"
                )
            elif plain != 1:
                reasons.append(
                    f"fork '{name}' has {plain} outgoing dependencies without a condition, expected one"
                )
        if reasons:
            raise InfeasibleError(reasons[0], reasons)

    def _reachable(self, name: str) -> frozenset[str]:
        if name not in self._reach:
            after = (self._reachable(edge.after) for edge in self.out[name])
            self._reach[name] = frozenset({name}).union(*after)
        return self._reach[name]

    def _arm_members(self, fork: str) -> list[frozenset[str]]:
        """Return, by outgoing dependency, the tasks that can be reached by that one only."""
        reached = [self._reachable(edge.after) for edge in self.out[fork]]
        return [
            frozenset(name for name in mine if sum(name in other for other in reached) == 1)
            for mine in reached
        ]

    def _choice(self, fork: str) -> Choice:
        arms = [
            (edge.condition, self._items(members))
            for edge, members in zip(self.out[fork], self._members[fork], strict=True)
        ]
        return Choice(fork, tuple(sorted(arms, key=lambda arm: arm[0] is None)))

    def _items(self, members: frozenset[str]) -> tuple[str | Choice, ...]:
        """Return an arm's tasks and inner choices, in an order that keeps the dependencies."""
        inner = [name for name in self.names if name in members and name in self._members]
        inside = {task: fork for fork in reversed(inner) for arm in self._members[fork] for task in arm}
        outermost = {fork: fork for fork in inner if fork not in inside}
        owner = {name: self._outermost(name, inside) for name in self.names if name in members}
        wanted = {
            name: {
                owner[edge.before]
                for task in owner
                if owner[task] == name
                for edge in self.into[task]
                if edge.before in members and owner[edge.before] != name
            }
            for name in dict.fromkeys(owner.values())
        }
        order = TopologicalSorter({name: sorted(before) for name, before in wanted.items()}).static_order()
        return tuple(
            self._choice(name) if name in outermost else name
            for name in order
            if name in outermost or name not in self.control
        )

    @staticmethod
    def _outermost(name: str, inside: dict[str, str]) -> str:
        while name in inside:
            name = inside[name]
        return name

    def owners(self) -> dict[str, str]:
        """Return by task (and Fork of a choice) the name of its job."""
        member_of = {task: fork for fork in self.choices for arm in self._members[fork] for task in arm}
        return {
            name: member_of.get(name, name)
            for name in self.names
            if name in member_of or name in self.choices or name not in self.control
        }

    def before(self, job: str, mine: Sequence[str], owner: Mapping[str, str]) -> set[str]:
        """Return the jobs that must have ended before a job, of which some tasks are members, begins."""
        found: set[str] = set()
        pending = [edge.before for name in mine for edge in self.into[name]]
        seen: set[str] = set()
        while pending:
            name = pending.pop()
            if name in seen or owner.get(name) == job:
                continue
            seen.add(name)
            if name in owner:
                found.add(owner[name])
            else:
                pending += [edge.before for edge in self.into[name]]
        return found
