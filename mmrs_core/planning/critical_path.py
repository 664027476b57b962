"""What the mission time is spent on: the chain of steps, from robot to robot, that ends last.

It is the critical path of scheduling (Kelley and Walker, "Critical-path planning and scheduling", Proc. EJCC
1959): back from the last step, and at each wait for other robots on to the one that they waited for longest.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from mmrs_core.scene import Await, Branch, Launch, Plan, Recharge, Recover, Serve, Signal, Step, Transit

_SHORTEST = 0.5
"""Seconds of a wait below which nothing is waited for."""

_WORK = "work"
_SPENT: dict[type[Step], str] = {
    Launch: "launch",
    Recover: "landing",
    Transit: "transit",
    Serve: _WORK,
    Branch: _WORK,
    Recharge: "charging",
    Await: "waiting",
}


@dataclass(frozen=True, slots=True)
class Link:
    """A stretch of the chain that one robot spends on one task.

    Attributes:
        task: empty: the return in the end.
        spent: (launch, transit, work, charging, waiting or landing; seconds), longest first.
    """

    robot: str
    task: str
    begin: float
    end: float
    spent: tuple[tuple[str, float], ...]


def critical_path(plan: Plan) -> tuple[Link, ...]:
    """Return the chain that ends last, in order, from the mission's start on."""
    links = list[Link]()
    for robot, step in _backwards(plan):
        spent = ((_SPENT[type(step)], step.end - step.begin),)
        if links and (links[-1].robot, links[-1].task) == (robot, step.task):
            links[-1] = replace(links[-1], begin=step.begin, spent=(*links[-1].spent, *spent))
        else:
            links.append(Link(robot, step.task, step.begin, step.end, spent))
    return tuple(replace(each, spent=_summed(each.spent)) for each in reversed(links))


def _summed(spent: Sequence[tuple[str, float]]) -> tuple[tuple[str, float], ...]:
    sums = Counter[str]()
    for what, seconds in spent:
        sums[what] += seconds  # type: ignore[assignment]
    return tuple((what, seconds) for what, seconds in sums.most_common() if seconds > 0.0)


def _backwards(plan: Plan) -> Iterator[tuple[str, Step]]:
    """Yield (robot, step) of the chain, last one first."""
    steps = {each.robot: each.steps for each in plan.robots if each.steps}
    senders = {
        step.signal: (name, index)
        for name, mine in steps.items()
        for index, step in enumerate(mine)
        if isinstance(step, Signal)
    }
    if not steps:
        return
    name = max(steps, key=lambda each: steps[each][-1].end)
    index = len(steps[name]) - 1
    while index >= 0:
        step = steps[name][index]
        index -= 1
        if isinstance(step, Await) and step.end - step.begin > _SHORTEST:
            last = max(
                (senders[each] for each in step.signals),
                key=lambda each: steps[each[0]][each[1]].end,
                default=None,
            )
            clock = step.until is not None and step.until >= step.end - _SHORTEST
            if last is not None and not clock:
                name, index = last
                continue
        if not isinstance(step, Signal):
            yield name, step
