"""Forks whose outgoing dependencies have conditions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mmrs_core.analysis.constraints.findings import MISSION, called, finding, listed
from mmrs_core.analysis.constraints.order import TaskOrder
from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.grounding.features import child, number, text
from mmrs_core.languages.element import Element, is_kind, label_of, path_of
from mmrs_core.languages.modelset import ModelSet


@dataclass(frozen=True, slots=True)
class _Arm:
    """One outgoing branch of a Fork: the dependency, and the tasks between the Fork and the closing Join."""

    edge: Element
    tasks: frozenset[Element]


def _is_choice(fork: Element, order: TaskOrder) -> bool:
    return any(text(edge, "condition") for edge in order.outgoing.get(fork, ()))


def _arms(fork: Element, join: Element, order: TaskOrder) -> tuple[_Arm, ...]:
    heads = ((edge, child(edge, "to")) for edge in order.outgoing[fork])
    return tuple(
        _Arm(edge, frozenset(order.beyond([head], join))) for edge, head in heads if head is not None
    )


def _only_forks(dependency: Element, models: ModelSet) -> Iterator[Finding]:
    before = child(dependency, "from")
    if text(dependency, "condition") and before is not None and not is_kind(before, MISSION, "Fork"):
        yield finding(dependency, f"has a condition, but starts at {called(before)}, which is not a fork")


def _no_else(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    if _is_choice(fork, order) and all(text(edge, "condition") for edge in order.outgoing[fork]):
        yield finding(fork, "every outgoing dependency has a condition: none is left when no condition holds")


def _two_elses(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    free = [edge for edge in order.outgoing.get(fork, ()) if not text(edge, "condition")]
    if _is_choice(fork, order) and len(free) > 1:
        yield finding(
            fork, f"{len(free)} of its outgoing dependencies have no condition: which is taken is open"
        )


def _same_condition(fork: Element, models: ModelSet) -> Iterator[Finding]:
    seen: set[str] = set()
    for edge in sketch_of(models).order.outgoing.get(fork, ()):
        condition = text(edge, "condition")
        if condition and condition in seen:
            yield finding(
                edge, f"the condition {condition!r} already selects another branch of {called(fork)}"
            )
        seen.add(condition)


def _never_closed(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    if order.is_circular:
        return  # undefined until the cycle is gone, which is a breach of its own
    if _is_choice(fork, order) and order.meeting(fork) is None:
        ends = sorted(
            label_of(task) or path_of(task)
            for task in order.beyond(order.after[fork], fork)
            if task is not fork and not order.after[task]
        )
        yield finding(
            fork, f"its branches have conditions, but no join closes them; they end at {listed(ends)}"
        )


def _entered(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    join = order.meeting(fork) if _is_choice(fork, order) else None
    if join is None:
        return
    arms = _arms(fork, join, order)
    inside = {task: arm for arm in arms for task in arm.tasks}
    for arm in arms:
        for task in sorted(arm.tasks, key=path_of):
            others = [each for each in order.before[task] if each is not fork and each not in arm.tasks]
            outside = [each for each in others if each not in inside]
            if outside:
                yield finding(
                    task, f"waits for {called(outside[0])}, which is not on its branch of {called(fork)}"
                )
            elif others or inside[task] is not arm:
                yield finding(task, f"is on more than one branch of {called(fork)}")


def _several(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    join = order.meeting(fork) if _is_choice(fork, order) else None
    for arm in _arms(fork, join, order) if join is not None else ():
        for task in sorted(arm.tasks, key=path_of):
            wanted = number(task, "robotsWanted")
            if wanted is not None and wanted > 1:
                yield finding(
                    task, f"wants {wanted:g} robots, but one robot does all branches of {called(fork)}"
                )


CONSTRAINTS = (
    Constraint(
        "MML045",
        "Only outgoing dependencies of a Fork have conditions.",
        (MISSION, "TaskDependency"),
        _only_forks,
        "put a fork between them, with a second dependency for when the condition does not hold",
    ),
    Constraint(
        "MML046",
        "A Fork with conditions has an outgoing dependency for when none holds.",
        (MISSION, "Fork"),
        _no_else,
        "remove the condition from one outgoing dependency; it may lead straight to the join",
    ),
    Constraint(
        "MML047",
        "A Fork with conditions has only one outgoing dependency without.",
        (MISSION, "Fork"),
        _two_elses,
        "give all outgoing dependencies but one a condition",
    ),
    Constraint(
        "MML048",
        "The branches of a Fork with conditions meet in one Join.",
        (MISSION, "Fork"),
        _never_closed,
        "let the last task of every branch lead to one join",
    ),
    Constraint(
        "MML049",
        "Different branches of a Fork have different conditions.",
        (MISSION, "Fork"),
        _same_condition,
        "a condition selects one branch; put a second fork behind it to do several tasks",
    ),
    Constraint(
        "MML050",
        "The branches of a Fork with conditions are apart from each other and from all other tasks.",
        (MISSION, "Fork"),
        _entered,
        "let the fork wait for the other task instead, or put the task behind the join",
    ),
    Constraint(
        "MML051",
        "A task that is done on a condition is done by one robot.",
        (MISSION, "Fork"),
        _several,
        "leave robotsWanted out, or do the task outside the fork and its join",
    ),
)
