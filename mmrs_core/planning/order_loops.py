"""The steps of `orders`: functions of numbers in a row, which run alike on lists and, compiled, on arrays."""

from __future__ import annotations

from math import inf, log
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from mmrs_core.planning.ruin_loops import Field, Reals, Wholes

_LATE = 1000.0
"""Factor on the seconds by which a deadline is missed."""


class Waits(NamedTuple):
    """What each stop waits for, and what waits for it: row after row, and where each row begins."""

    begins: Wholes
    before: Wholes
    follows: Wholes
    after: Wholes


class Line(NamedTuple):
    """Stops in the order in which they are given to robots, and what comes of it.

    Attributes:
        order: (n), stops. places: (n), where in the order a stop is.
        robots, starts, ends: (n), whose each stop is, and when it begins and ends.
        here, free, used: (m), a robot's last stop, when it ends, and the seconds of the charge used by then.
        random: (1), state of the random numbers.
    """

    order: Wholes
    places: Wholes
    robots: Wholes
    starts: Reals
    ends: Reals
    here: Wholes
    free: Reals
    used: Reals
    random: Wholes


def draw(line: Line) -> float:
    """Return a random number between 0 and 1 as `ruin_loops` does."""
    line.random[0] = line.random[0] * 48271 % 2147483647
    return line.random[0] / 2147483647.0


def may_do(field: Field, line: Line, stop: int, robot: int) -> bool:
    """Return whether a robot can do a stop, and does none that another one must do."""
    if field.out[robot * field.sizes[0] + stop] == inf:
        return False
    columns = field.sizes[4]
    for i in range(stop * columns, (stop + 1) * columns):
        if field.apart[i] >= 0 and line.robots[field.apart[i]] == robot:
            return False
    return True


def served(field: Field, line: Line, stop: int, robot: int, ready: float) -> tuple[float, float]:
    """Return when a robot begins with a stop, and the charge taken after it, recharged before if need be."""
    n, here, time, used = field.sizes[0], line.here[robot], line.free[robot], line.used[robot]
    row, kind, kinds = robot * n + stop, field.kinds[robot], field.sizes[5]
    away, more = field.out[row], field.sizes[1] * n if kinds else 0
    most, work = field.out[more + row], field.work[(kinds + kind) * n + stop]
    if here < n:
        gone = used + field.go[((kinds + kind) * n + here) * n + stop]
        if gone + work + field.back[more + row] <= field.limits[robot]:
            away = field.go[(kind * n + here) * n + stop]
            begin = max(time + away, ready)
            return begin, gone + work + (begin - time - away)
        time += field.back[robot * n + here] + field.recharges[robot]
    return max(time + away, ready), most + work


def carry_out(field: Field, waits: Waits, line: Line) -> float:
    """Give each stop in turn to the robot that ends it first; return the makespan, more if some are late."""
    n, m = field.sizes[0], field.sizes[1]
    for robot in range(m):
        line.here[robot], line.free[robot], line.used[robot] = n, 0.0, 0.0
    for stop in range(n):
        line.robots[stop] = -1
    late = 0.0
    for i in range(n):
        stop = line.order[i]
        ready = field.earliest[stop]
        for k in range(waits.begins[stop], waits.begins[stop + 1]):
            ready = max(ready, line.ends[waits.before[k]])
        best, soonest, latest = -1, inf, -1.0
        for robot in range(m):
            if not may_do(field, line, stop, robot):
                continue
            end = served(field, line, stop, robot, ready)[0] + field.work[field.kinds[robot] * n + stop]
            if end < soonest or (end == soonest and line.free[robot] > latest):
                best, soonest, latest = robot, end, line.free[robot]
        if best < 0:
            return inf
        line.starts[stop], line.used[best] = served(field, line, stop, best, ready)
        line.robots[stop], line.ends[stop] = best, soonest
        line.here[best], line.free[best] = stop, soonest
        late += max(0.0, soonest - field.deadlines[stop])
    longest = 0.0
    for robot in range(m):
        here = line.here[robot]
        longest = max(longest, line.free[robot] + (field.back[robot * n + here] if here < n else 0.0))
    return longest + _LATE * late


def move(line: Line, start: int, goal: int) -> None:
    """Move what is at one place of the order to another one."""
    stop, step = line.order[start], 1 if goal > start else -1
    for i in range(start, goal, step):
        line.order[i] = line.order[i + step]
        line.places[line.order[i]] = i
    line.order[goal] = stop
    line.places[stop] = goal


def anneal(
    field: Field, waits: Waits, line: Line, best: Line, now: float, least: float, heat: float, steps: int
) -> tuple[float, float]:
    """Move stops in the order, so many times; return the cost where the search is, and the least so far.

    Args:
        field: of the stops.
        waits: of the stops.
        line: where the search is, and will be. best: the best so far.
        now: cost of the line. least: of the best.
        heat: by how much a step may be worse, on average of those that are taken.
        steps: how many.
    """
    n = field.sizes[0]
    for _ in range(steps):
        start = int(draw(line) * n)
        stop, low, high = line.order[start], 0, n - 1
        for k in range(waits.begins[stop], waits.begins[stop + 1]):
            low = max(low, line.places[waits.before[k]] + 1)
        for k in range(waits.follows[stop], waits.follows[stop + 1]):
            high = min(high, line.places[waits.after[k]] - 1)
        goal = low + int(draw(line) * (high - low + 1))
        if goal == start or field.ranks[line.order[goal]] != field.ranks[stop]:
            continue
        move(line, start, goal)
        cost = carry_out(field, waits, line)
        if cost > now - heat * log(draw(line)):
            move(line, goal, start)
            continue
        now = cost
        if cost < least:
            least = cost
            for i in range(n):
                best.order[i], best.robots[i], best.starts[i] = line.order[i], line.robots[i], line.starts[i]
    return now, least
