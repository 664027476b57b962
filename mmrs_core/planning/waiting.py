"""Where along its path, and for how long, a robot must wait to keep apart from others on theirs.

The path stays; what is found is how much later than planned each step begins. Safe intervals (Phillips and
Likhachev 2011), of delays rather than of times: those with which the robot can go through a step, and those
through which it can stand where the step begins. The last step begins with the least delay that waiting
can bring about, and of all that bring it about, waits as early as it can, at home before all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, inf
from typing import TypeAlias

Span: TypeAlias = tuple[float, float]

_LONGEST = 36_000.0

_TICK = 10.0
"""Waits are whole multiples of a second divided by this."""


@dataclass(frozen=True, slots=True)
class DelayedStep:
    """What limits the delay of one step.

    Attributes:
        blocked: open intervals of delays with which the robot meets another in this step; ordered, apart.
        standing: the same of where it stands when the step begins.
        may_wait: whether it can wait there.
        slack: seconds that it waits for others in this step, so that a delay is not passed on.
    """

    blocked: Sequence[Span]
    standing: Sequence[Span]
    may_wait: bool
    slack: float = 0.0


def waits_before(steps: Sequence[DelayedStep]) -> dict[int, float] | None:
    """Return the seconds to wait before steps, by index; None if no waiting helps."""
    reached: list[Span] = [(0.0, 0.0)]
    arriving, passing = [], []
    for step in steps:
        arriving.append(reached)
        held = _held(reached, step.standing) if step.may_wait else reached
        passed = _without(held, step.blocked)
        if not passed:
            return None
        passing.append(passed)
        reached = [(max(0.0, a - step.slack), max(0.0, b - step.slack)) for a, b in passed]
    waits = {}
    delay = reached[0][0]
    for index in reversed(range(len(steps))):
        step = steps[index]
        free = step.slack > 0.0 and delay == 0.0
        begins = passing[index][0][0] if free else _latest(passing[index], delay + step.slack, 0.0)
        clear = max((end for _, end in step.standing if end <= begins), default=0.0)
        delay = _latest(arriving[index], begins, clear) if step.may_wait else begins
        if begins > delay:
            waits[index] = begins - delay
    return waits


def _held(reached: Sequence[Span], standing: Sequence[Span]) -> list[Span]:
    """Return the delays that waiting leads to from some delays."""
    found: list[Span] = []
    free = 0.0
    for begin, end in (*standing, (_LONGEST, _LONGEST)):
        first = min((max(a, free) for a, b in reached if b >= free and max(a, free) <= begin), default=inf)
        if first <= begin:
            found.append((first, begin))
        free = max(free, end)
    return found


def _without(reached: Sequence[Span], blocked: Sequence[Span]) -> list[Span]:
    """Return those of some delays that are not blocked and whole ticks."""
    found: list[Span] = []
    for a, b in reached:
        begin = a
        for low, high in blocked:
            if high <= begin:
                continue
            if low >= b:
                break
            if low >= begin:
                found.append((begin, low))
            begin = high
        if begin <= b:
            found.append((begin, b))
    ticks = [(ceil(a * _TICK - 1e-6) / _TICK, b) for a, b in found]
    return [(a, b) for a, b in ticks if a <= b]


def _latest(delays: Sequence[Span], most: float, least: float) -> float:
    """Return the largest whole tick of some delays that is at most so much."""
    ticks = (max(a, floor(min(b, most) * _TICK + 1e-6) / _TICK) for a, b in delays if b >= least)
    return max((each for each in ticks if each <= most + 1e-6), default=most)
