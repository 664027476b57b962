"""Tasks and what they wait for, as a graph."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from mmrs_core.languages.element import Element
from mmrs_core.languages.grounding_values import child, children


class Order:
    """The graph of a mission's tasks; dependencies on tasks of nobody are left out.

    Attributes:
        after: by task, those that wait for it, in the order of the model.
        before: by task, those that it waits for.
        ways: by task, the dependencies that lead out of it.
    """

    def __init__(self, mission: Element) -> None:
        tasks = children(mission, "tasks")
        self.after: dict[Element, dict[Element, None]] = {task: {} for task in tasks}
        self.before: dict[Element, dict[Element, None]] = {task: {} for task in tasks}
        self.ways: dict[Element, list[Element]] = {task: [] for task in tasks}
        for dependency in children(mission, "taskDependencies"):
            before, after = child(dependency, "from"), child(dependency, "to")
            if before in self.after and after in self.after and before is not None and after is not None:
                self.after[before][after] = None
                self.before[after][before] = None
                self.ways[before].append(dependency)

    def sorted(self) -> Iterator[Element]:
        """Yield tasks after all that they wait for; those on or behind a circle are left out."""
        waiting = {task: len(before) for task, before in self.before.items()}
        ready = [task for task, count in waiting.items() if count == 0]
        while ready:
            task = ready.pop(0)
            yield task
            for each in self.after[task]:
                waiting[each] -= 1
                if waiting[each] == 0:
                    ready.append(each)

    def is_circular(self) -> bool:
        """Return whether tasks wait for each other in a circle."""
        return sum(1 for _ in self.sorted()) < len(self.after)

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
