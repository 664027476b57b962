"""Tasks and what they wait for, as a graph."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping
from functools import cached_property
from heapq import heappop, heappush

from mmrs_core.analysis.constraints.findings import MISSION
from mmrs_core.grounding.features import child, children
from mmrs_core.languages.element import Element, is_kind


class TaskOrder:
    """The graph of a mission's tasks; dependencies on tasks outside the mission are left out.

    Attributes:
        after: by task, those that wait for it, in the order of the model.
        before: by task, those that it waits for.
        outgoing: by task, the dependencies that lead out of it.
    """

    def __init__(self, mission: Element) -> None:
        tasks = children(mission, "tasks")
        self.after: dict[Element, dict[Element, None]] = {task: {} for task in tasks}
        self.before: dict[Element, dict[Element, None]] = {task: {} for task in tasks}
        self.outgoing: dict[Element, list[Element]] = {task: [] for task in tasks}
        for dependency in children(mission, "taskDependencies"):
            before, after = child(dependency, "from"), child(dependency, "to")
            if before in self.after and after in self.after and before is not None and after is not None:
                self.after[before][after] = None
                self.before[after][before] = None
                self.outgoing[before].append(dependency)

    @cached_property
    def ranks(self) -> Mapping[Element, int]:
        """Tasks with numbers that grow along dependencies; those in or behind a cycle are left out."""
        waiting = {task: len(before) for task, before in self.before.items()}
        ready = deque(task for task, count in waiting.items() if count == 0)
        ranks: dict[Element, int] = {}
        while ready:
            task = ready.popleft()
            ranks[task] = len(ranks)
            for each in self.after[task]:
                waiting[each] -= 1
                if waiting[each] == 0:
                    ready.append(each)
        return ranks

    @property
    def is_circular(self) -> bool:
        """Whether tasks wait for each other in a cycle."""
        return len(self.ranks) < len(self.after)

    def meeting(self, fork: Element) -> Element | None:
        """Return the nearest Join that every branch of a Fork leads to; None where one ends elsewhere.

        Goes over the tasks between the two only.
        """
        ahead: list[tuple[int, Element]] = []
        seen: set[Element] = set()
        following = self.after[fork]
        while True:
            for each in following:
                if each not in self.ranks:
                    return None
                if each not in seen:
                    seen.add(each)
                    heappush(ahead, (self.ranks[each], each))
            if not ahead:
                return None
            _, task = heappop(ahead)
            if not ahead and is_kind(task, MISSION, "Join"):
                return task
            following = self.after[task]
            if not following:
                return None

    def beyond(self, starts: Collection[Element], stop: Element) -> set[Element]:
        """Return the starts and all tasks that wait for them, without going through `stop`."""
        found: set[Element] = set()
        pending = [task for task in starts if task is not stop]
        while pending:
            task = pending.pop()
            if task not in found:
                found.add(task)
                pending.extend(each for each in self.after[task] if each is not stop)
        return found
