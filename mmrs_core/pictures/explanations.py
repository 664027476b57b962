"""The explanation of a plan in words and tables, for a terminal and for a page alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_core.pictures.figures import clock, within

if TYPE_CHECKING:
    from mmrs_core.planning.explaining import Alternative, PlanExplanation, TaskExplanation

_MOST_ALTERNATIVES = 3
"""Alternatives of one task that are shown: the best ones."""

_MOST_LINKS = 40


@dataclass(frozen=True, slots=True)
class ExplanationPart:
    """One part of an explanation: sentences, then a table, whose head is empty where there is none."""

    title: str
    sentences: tuple[str, ...]
    head: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()


def sections_of(explanation: PlanExplanation) -> tuple[ExplanationPart, ...]:
    """Return an explanation in parts, each to be understood alone."""
    if not explanation.tasks:
        return ()
    every = (
        _time(explanation),
        _limits(explanation),
        _robots(explanation),
        _unable(explanation),
        _idle(explanation),
    )
    return tuple(each for each in every if each.sentences or each.rows)


def _time(explanation: PlanExplanation) -> ExplanationPart:
    chain = explanation.chain[:_MOST_LINKS]
    rows = [
        (
            clock(link.begin),
            clock(link.end),
            link.robot,
            link.task or "return",
            ", ".join(f"{what} {clock(seconds)}" for what, seconds in link.spent),
        )
        for link in chain
    ]
    more = len(explanation.chain) - len(chain)
    sentences = [_last(explanation), _compared(explanation)]
    sentences += [f"{more} more rows are left out"] if more else []
    head = ("from", "to", "robot", "task", "time spent")
    return ExplanationPart("What determines the mission time", tuple(sentences), head, tuple(rows))


def _compared(explanation: PlanExplanation) -> str:
    bound, planned = explanation.lower_bound, explanation.planned
    if not bound:
        return "how much sooner another plan could end is not known"
    this = f"by the planner's times this one ends at {clock(planned)}: " if planned else ""
    if round((planned or explanation.makespan) - bound) == 0:
        return f"{this}no plan ends sooner"
    near = within(planned or explanation.makespan, bound)
    return f"{this}no plan ends before {clock(bound)}, so this one is {near}"


def _last(explanation: PlanExplanation) -> str:
    end = explanation.makespan
    last = [f"'{name}'" for name, back in explanation.backs if round(end - back) == 0]
    before = [(name, back) for name, back in explanation.backs if round(end - back) > 0][:3]
    words = ", ".join(f"{clock(end - back)} after '{name}'" for name, back in before)
    if len(explanation.backs) == 1:
        return f"{last[0]} finishes at {clock(end)}"
    verb = "finishes" if len(last) == 1 else "finish"
    return f"{' and '.join(last)} {verb} last, at {clock(end)}" + (f": {words}" if words else "")


def _limits(explanation: PlanExplanation) -> ExplanationPart:
    rows = [
        (each.name, f"{clock(each.cost)} sooner" if round(each.cost) > 0 else "no sooner", each.margin)
        for each in explanation.limits
    ]
    binding = [each.name for each in explanation.limits if round(each.cost) > 0]
    words = (
        f"binding: {', '.join(binding)}"
        if binding
        else "no limit makes the mission longer: work and distances do"
    )
    sentences = [words]
    if explanation.lifted_near and len(rows) > 1:
        sentences.append("but for separation, times are those before robots wait to keep their distance")
    head = ("limit", "mission would end without it", "margin")
    return ExplanationPart("Limits", tuple(sentences), head, tuple(rows))


def _robots(explanation: PlanExplanation) -> ExplanationPart:
    alternatives = [each for task in explanation.tasks for each in task.alternatives]
    team = len(explanation.backs) + len(explanation.idle)
    rows = [row for task in explanation.tasks for row in _rows(task, team)] if alternatives else []
    sentences = ["each alternative was planned, with all other tasks as they are"]
    if explanation.apart:
        sentences[0] += "; times are those before robots wait to keep their distance"
    if not alternatives:
        sentences = ["there is only one robot" if team == 1 else "no task could be done by another robot"]
    if untried := sum(not task.tried for task in explanation.tasks):
        sentences.append(f"{untried} tasks were left out, since there are too many alternatives")
    if any(not each.fault and round(each.later) < 0 for each in alternatives):
        sentences.append(
            "an alternative would end sooner without these waits, and may end later with them"
            if explanation.apart
            else "an alternative would end sooner: a longer search (--time-limit) may find it"
        )
    head = ("task", "robots", "alternative", "mission ends", "task ends", "robots busy")
    return ExplanationPart("Why these robots", tuple(sentences), head if rows else (), tuple(rows))


def _rows(task: TaskExplanation, team: int) -> Iterator[tuple[str, ...]]:
    if not task.tried:
        return
    names, first = (task.task, ", ".join(task.robots)), True
    for each in task.alternatives[:_MOST_ALTERNATIVES]:
        yield (*(names if first else ("", "")), *_row(task, each))
        first = False
    if first:
        others = team - len(task.robots) - len(task.unable)
        yield (*names, "another robot would get no share" if others else "no other robot can", "", "", "")


def _row(task: TaskExplanation, each: Alternative) -> tuple[str, ...]:
    who = _change(task.robots, each.robots)
    if each.fault:
        return who, f"no plan: {each.fault}", "", ""
    changes = (each.later, each.task_later)
    busy = "the same" if round(each.longer) == 0 else _signed(each.longer, "longer", "shorter")
    return who, *(_signed(change, "later", "sooner") for change in changes), busy


def _signed(seconds: float, more: str, less: str) -> str:
    if round(seconds) == 0:
        return "as planned"
    return f"{clock(abs(seconds))} {more if seconds > 0.0 else less}"


def _change(before: tuple[str, ...], after: tuple[str, ...]) -> str:
    """Return in words how one set of robots becomes another.

    >>> _change(("a",), ("b",)), _change(("a",), ("a", "b")), _change(("a", "b"), ("a",))
    ('b instead', 'b too', 'without b')
    >>> _change(("a", "b"), ("a", "c"))
    'c instead of b'
    """
    gone, come = ([n for n in one if n not in other] for one, other in ((before, after), (after, before)))
    if not come:
        return f"without {', '.join(gone)}"
    if not gone:
        return f"{', '.join(come)} too"
    return f"{', '.join(come)} instead" + (f" of {', '.join(gone)}" if len(before) > 1 else "")


def _unable(explanation: PlanExplanation) -> ExplanationPart:
    return ExplanationPart("What robots cannot do", tuple(_unable_words(explanation)))


def _unable_words(explanation: PlanExplanation) -> Iterator[str]:
    """Yield which robots cannot do which tasks, and why; what has one reason is said once."""
    tasks = dict[tuple[str, str], list[str]]()
    for task in explanation.tasks:
        for robot, reason in task.unable.items():
            tasks.setdefault((robot, reason), []).append(f"'{task.task}'")
    robots = dict[tuple[str, str], list[str]]()
    for (robot, reason), names in tasks.items():
        robots.setdefault((", ".join(names), reason), []).append(f"'{robot}'")
    for (doing, reason), unable in robots.items():
        yield f"{', '.join(unable)} cannot do {doing}: {reason}"


def _idle(explanation: PlanExplanation) -> ExplanationPart:
    return ExplanationPart("Robots without a task", tuple(_idle_words(explanation)))


def _idle_words(explanation: PlanExplanation) -> Iterator[str]:
    robots = {task.task: task.robots for task in explanation.tasks}
    for name, best in explanation.idle.items():
        if best is None:
            yield (
                f"'{name}' can do none of the tasks"
                if _can_nothing(explanation, name)
                else f"'{name}': no task was tried with it"
            )
            continue
        task, each = best
        how = _change(robots[task], each.robots)
        if each.fault:
            yield f"'{name}' can take no task: best of all '{task}' ({how}), but {each.fault}"
        elif round(each.later) == 0:
            yield f"'{name}' would not make the mission end sooner: at best it would take '{task}' ({how})"
        else:
            late = _signed(each.later, "later", "sooner")
            waits = (
                ", before robots wait to keep their distance" if explanation.apart and each.later < 0 else ""
            )
            yield f"'{name}' would make the mission end {late}, at best with '{task}' ({how}){waits}"


def _can_nothing(explanation: PlanExplanation, robot: str) -> bool:
    return all(robot in task.unable for task in explanation.tasks)
