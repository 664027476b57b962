"""Forks whose ways out are taken by conditions."""

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
    """One way out of a Fork: the dependency, and the tasks between the Fork and the closing Join."""

    way: Element
    tasks: frozenset[Element]


def _is_choice(fork: Element, order: TaskOrder) -> bool:
    return any(text(way, "condition") for way in order.ways.get(fork, ()))


def _arms(fork: Element, join: Element, order: TaskOrder) -> tuple[_Arm, ...]:
    heads = ((way, child(way, "to")) for way in order.ways[fork])
    return tuple(_Arm(way, frozenset(order.beyond([head], join))) for way, head in heads if head is not None)


def _only_forks(dependency: Element, models: ModelSet) -> Iterator[Finding]:
    before = child(dependency, "from")
    if text(dependency, "condition") and before is not None and not is_kind(before, MISSION, "Fork"):
        yield finding(dependency, f"has a condition, but leads out of {called(before)}, which is no fork")


def _no_else(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    if _is_choice(fork, order) and all(text(way, "condition") for way in order.ways[fork]):
        yield finding(fork, "every way out has a condition: none is left when no condition holds")


def _two_elses(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    free = [way for way in order.ways.get(fork, ()) if not text(way, "condition")]
    if _is_choice(fork, order) and len(free) > 1:
        yield finding(fork, f"{len(free)} of its ways out have no condition: which is taken is open")


def _same_condition(fork: Element, models: ModelSet) -> Iterator[Finding]:
    seen: set[str] = set()
    for way in sketch_of(models).order.ways.get(fork, ()):
        condition = text(way, "condition")
        if condition and condition in seen:
            yield finding(way, f"the condition {condition!r} already opens another way out of {called(fork)}")
        seen.add(condition)


def _never_closed(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    if order.is_circular:
        return  # the way on is open until the circle is gone, which is a breach of its own
    if _is_choice(fork, order) and order.meeting(fork) is None:
        ends = sorted(
            label_of(task) or path_of(task)
            for task in order.beyond(order.after[fork], fork)
            if task is not fork and not order.after[task]
        )
        yield finding(
            fork, f"its ways out have conditions, but no join closes them; they end at {listed(ends)}"
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
                    task, f"waits for {called(outside[0])}, which is not on its way out of {called(fork)}"
                )
            elif others or inside[task] is not arm:
                yield finding(task, f"is on more than one way out of {called(fork)}")


def _several(fork: Element, models: ModelSet) -> Iterator[Finding]:
    order = sketch_of(models).order
    join = order.meeting(fork) if _is_choice(fork, order) else None
    for arm in _arms(fork, join, order) if join is not None else ():
        for task in sorted(arm.tasks, key=path_of):
            wanted = number(task, "robotsWanted")
            if wanted is not None and wanted > 1:
                yield finding(
                    task, f"wants {wanted:g} robots, but one robot goes the ways out of {called(fork)}"
                )


CONSTRAINTS = (
    Constraint(
        "MML045",
        "Only ways out of a Fork have conditions.",
        (MISSION, "TaskDependency"),
        _only_forks,
        "put a fork between them, with a second way out for when the condition does not hold",
    ),
    Constraint(
        "MML046",
        "A Fork with conditions has a way out for when none holds.",
        (MISSION, "Fork"),
        _no_else,
        "take the condition from one way out; it may lead straight to the join",
    ),
    Constraint(
        "MML047",
        "A Fork with conditions has only one way out without.",
        (MISSION, "Fork"),
        _two_elses,
        "give all ways out but one a condition",
    ),
    Constraint(
        "MML048",
        "The ways out of a Fork with conditions meet in one Join.",
        (MISSION, "Fork"),
        _never_closed,
        "let the last task of every way out lead to one join",
    ),
    Constraint(
        "MML049",
        "Different ways out of a Fork have different conditions.",
        (MISSION, "Fork"),
        _same_condition,
        "a condition opens one way; put a second fork behind it to do several tasks",
    ),
    Constraint(
        "MML050",
        "The ways between a Fork with conditions and its Join are apart from each other and all other tasks.",
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
