"""The steps of `ruin`: functions of numbers in a row, which run alike on lists and, compiled, on arrays.

A stop is 0 to n - 1, the home of robot r is n + r; a tour is a ring from home through its stops. Matrices
are laid out row after row.
"""

from __future__ import annotations

from collections.abc import MutableSequence
from math import inf, log
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    Wholes: TypeAlias = MutableSequence[int] | NDArray[numpy.int64]
    Reals: TypeAlias = MutableSequence[float] | NDArray[numpy.float64] | NDArray[numpy.float32]

_STRING = 10
"""Stops at most that are removed from one tour in a row."""

_REMOVED = 10
"""Stops that are removed at once on average."""

_BLINK = 0.01
"""Share of positions that an insertion overlooks, lest it always does the same."""

_TOO_LONG = 10.0
"""Factor on the seconds by which a tour is beyond its limit."""

_LATE = 1000.0
"""Factor on the seconds by which a deadline is missed."""


class Field(NamedTuple):
    """What is to be done and by whom: n stops, m robots, k sorts of robots.

    Attributes:
        sizes: n, m, the columns of `near`, `near_robots` and `apart`, and k, if what follows from `out` to
            `work` comes twice: as expected and, behind that, at most, as charges count it; 0: only once.
        kinds: (m), of each robot.
        out: (m, n), seconds from a robot's home to a stop; inf: it cannot do that one.
        go: (k, n, n), seconds from one stop to another.
        back: (m, n), seconds from a stop until the robot is back.
        work: (k, n), seconds at a stop.
        near: (n, -), other stops, nearest first. near_robots: (n, -), robots that may begin with a stop.
        apart: (n, -), other stops that another robot must do; -1: none.
        limits: (m), seconds that a charge allows. recharges: (m), seconds that the next one takes.
        earliest: (n), seconds before which a stop may not begin. deadlines: (n), by when it is to end.
        ranks: (n), of priority: they do not rise along a tour.
    """

    sizes: Wholes
    kinds: Wholes
    out: Reals
    go: Reals
    back: Reals
    work: Reals
    near: Wholes
    near_robots: Wholes
    apart: Wholes
    limits: Reals
    recharges: Reals
    earliest: Reals
    deadlines: Reals
    ranks: Wholes


class Tours(NamedTuple):
    """Who does what in which order.

    Attributes:
        after, before: (n + m), the neighbours in its ring of a stop or home.
        robot: (n), whose tour a stop is in; -1: in none.
        begins, ends: (n + m), seconds at which a stop begins and ends.
        seconds: (m), of each tour. late: (m), by which its deadlines are missed. stops: (m), how many.
    """

    after: Wholes
    before: Wholes
    robot: Wholes
    begins: Reals
    ends: Reals
    seconds: Reals
    late: Reals
    stops: Wholes


class Room(NamedTuple):
    """What a search keeps beside tours.

    Attributes:
        random: (1), state of the random numbers.
        gone, keys: (n), stops that are removed, and by what they are sorted.
        changed: (m + 1), robots whose tours differ from those before the step, and at the end their number.
        differs: (m), whether a robot is one of those.
        stale, older: likewise, between the tours where the search is and the best.
    """

    random: Wholes
    gone: Wholes
    keys: Reals
    changed: Wholes
    differs: Wholes
    stale: Wholes
    older: Wholes


def draw(room: Room) -> float:
    """Return a random number between 0 and 1, neither included.

    Park and Miller, "Random number generators: good ones are hard to find", Commun. ACM 31 (1988), with the
    multiplier of their reply of 1993.
    """
    room.random[0] = room.random[0] * 48271 % 2147483647
    return room.random[0] / 2147483647.0


def travel(field: Field, robot: int, one: int, two: int) -> float:
    """Return the seconds that a robot takes from one stop, or its home, to another."""
    n = field.sizes[0]
    if one >= n:
        return 0.0 if two >= n else field.out[robot * n + two]
    if two >= n:
        return field.back[robot * n + one]
    return field.go[(field.kinds[robot] * n + one) * n + two]


def used_on(field: Field, robot: int, one: int, two: int) -> float:
    """Return the seconds that `travel` takes of a charge at most."""
    n, m, k = field.sizes[0], field.sizes[1], field.sizes[5]
    more = m * n if k else 0
    if one >= n:
        return 0.0 if two >= n else field.out[more + robot * n + two]
    if two >= n:
        return field.back[more + robot * n + one]
    return field.go[((k + field.kinds[robot]) * n + one) * n + two]


def used_at(field: Field, robot: int, stop: int) -> float:
    """Return the seconds that the work at a stop takes of a charge at most."""
    return field.work[(field.sizes[5] + field.kinds[robot]) * field.sizes[0] + stop]


def retime(field: Field, tours: Tours, robot: int) -> None:
    """Bring the times of a tour up to date, recharges at home included."""
    n = field.sizes[0]
    home, row, work = n + robot, robot * n, field.kinds[robot] * n
    time, used, late = 0.0, 0.0, 0.0
    here, stop = home, tours.after[home]
    while stop != home:
        away, spent = travel(field, robot, here, stop), field.work[work + stop]
        most = used + used_on(field, robot, here, stop) + used_at(field, robot, stop)
        if here != home and most + used_on(field, robot, stop, home) > field.limits[robot]:
            time += field.back[row + here] + field.recharges[robot]
            away, here = field.out[row + stop], home
            most = used_on(field, robot, home, stop) + used_at(field, robot, stop)
        begin = max(time + away, field.earliest[stop])
        used = most + (0.0 if here == home else begin - time - away)
        time = begin + spent
        late += max(0.0, time - field.deadlines[stop])
        tours.begins[stop], tours.ends[stop] = begin, time
        here, stop = stop, tours.after[stop]
    tours.seconds[robot] = time + travel(field, robot, here, home)
    tours.late[robot] = late


def note(robots: Wholes, known: Wholes, robot: int) -> None:
    """Add a robot to those that differ, if it is none of them."""
    if not known[robot]:
        known[robot] = 1
        last = len(known)
        robots[robots[last]] = robot
        robots[last] += 1


def insert(field: Field, tours: Tours, stop: int, robot: int, before: int) -> None:
    """Put a stop into a tour behind another one, or home."""
    after = tours.after[before]
    tours.after[before], tours.before[stop] = stop, before
    tours.after[stop], tours.before[after] = after, stop
    tours.robot[stop] = robot
    tours.stops[robot] += 1
    retime(field, tours, robot)


def remove(tours: Tours, stop: int) -> None:
    """Take a stop out of its tour, whose times are brought up to date by `retime`."""
    before, after = tours.before[stop], tours.after[stop]
    tours.after[before], tours.before[after] = after, before
    tours.stops[tours.robot[stop]] -= 1
    tours.robot[stop] = -1


def price(field: Field, tours: Tours, stop: int, robot: int, before: int, limit: float) -> float:
    """Return how bad it is to insert a stop there: seconds more, and more so beyond a limit."""
    n, after = field.sizes[0], tours.after[before]
    if before < n and field.ranks[before] < field.ranks[stop]:
        return inf
    if after < n and field.ranks[after] > field.ranks[stop]:
        return inf
    begin = max(tours.ends[before] + travel(field, robot, before, stop), field.earliest[stop])
    end = begin + field.work[field.kinds[robot] * n + stop]
    whole = end + travel(field, robot, stop, after)
    if after < n:
        whole = max(whole, field.earliest[after]) + tours.seconds[robot] - tours.begins[after]
    late = max(0.0, end - field.deadlines[stop])
    return whole - tours.seconds[robot] + _TOO_LONG * max(0.0, whole - limit) + _LATE * late


def may_do(field: Field, tours: Tours, stop: int, robot: int) -> bool:
    """Return whether a robot can do a stop, and does none that another one must do."""
    if field.out[robot * field.sizes[0] + stop] == inf:
        return False
    columns = field.sizes[4]
    for i in range(stop * columns, (stop + 1) * columns):
        if field.apart[i] >= 0 and tours.robot[field.apart[i]] == robot:
            return False
    return True


def place(field: Field, tours: Tours, room: Room, stop: int, limit: float, blink: float) -> None:
    """Insert a stop where that is best among the positions next to its nearest stops and robots."""
    n, m, near, robots = field.sizes[0], field.sizes[1], field.sizes[2], field.sizes[3]
    best, best_robot = inf, field.near_robots[stop * robots]
    best_before = n + best_robot
    for i in range(stop * near, (stop + 1) * near):
        other = field.near[i]
        robot = tours.robot[other]
        if robot < 0 or draw(room) < blink or not may_do(field, tours, stop, robot):
            continue
        for before in (other, tours.before[other]):
            cost = price(field, tours, stop, robot, before, limit)
            if cost < best:
                best, best_robot, best_before = cost, robot, before
    for i in range(stop * robots, (stop + 1) * robots):
        robot = field.near_robots[i]
        if draw(room) >= blink and may_do(field, tours, stop, robot):
            cost = price(field, tours, stop, robot, n + robot, limit)
            if cost < best:
                best, best_robot, best_before = cost, robot, n + robot
    if best == inf:
        for robot in range(m):
            before, left = n + robot, tours.stops[robot] + 1
            while left > 0 and may_do(field, tours, stop, robot):
                cost = price(field, tours, stop, robot, before, limit)
                if cost < best:
                    best, best_robot, best_before = cost, robot, before
                before, left = tours.after[before], left - 1
    note(room.changed, room.differs, best_robot)
    insert(field, tours, stop, best_robot, best_before)


def take_apart(field: Field, tours: Tours, room: Room, first: int) -> int:
    """Remove strings of stops from the tours around one; return how many `gone` then begins with."""
    n, m, near = field.sizes[0], field.sizes[1], field.sizes[2]
    longest = min(float(_STRING), max(1.0, n / m))
    strings = int(1.0 + draw(room) * (4.0 * _REMOVED / (1.0 + longest) - 1.0))
    count = 0
    for i in range(-1, near):
        centre = first if i < 0 else field.near[first * near + i]
        robot = tours.robot[centre]
        if robot < 0 or room.differs[robot]:
            continue
        if room.changed[m] == strings:
            break
        note(room.changed, room.differs, robot)
        length = 1 + int(draw(room) * min(longest, float(tours.stops[robot])))
        stop = centre
        for _ in range(int(draw(room) * length)):
            stop = tours.before[stop] if tours.before[stop] < n else stop
        while length > 0 and stop < n:
            following = tours.after[stop]
            remove(tours, stop)
            room.gone[count] = stop
            count += 1
            stop, length = following, length - 1
        retime(field, tours, robot)
    return count


def put_in_order(field: Field, room: Room, count: int) -> None:
    """Sort removed stops for insertion: at random, long work first, or by how far from home."""
    n, robots, sort = field.sizes[0], field.sizes[3], draw(room) * 11.0
    gone, keys = room.gone, room.keys
    for i in range(count):
        stop = gone[i]
        if sort < 4.0:
            keys[i] = draw(room)
        elif sort < 8.0:
            keys[i] = -field.work[stop] + 1e-9 * draw(room)
        else:
            away = field.out[field.near_robots[stop * robots] * n + stop]
            keys[i] = -away if sort < 10.0 else away
    for i in range(1, count):
        j = i
        while j > 0 and keys[j - 1] > keys[j]:
            keys[j - 1], keys[j] = keys[j], keys[j - 1]
            gone[j - 1], gone[j] = gone[j], gone[j - 1]
            j -= 1


def longest_of(tours: Tours) -> int:
    """Return the robot of the longest tour."""
    found = 0
    for robot in range(len(tours.seconds)):
        if tours.seconds[robot] > tours.seconds[found]:
            found = robot
    return found


def mean_of(tours: Tours) -> float:
    """Return the mean seconds of the tours."""
    total = 0.0
    for robot in range(len(tours.seconds)):
        total += tours.seconds[robot]
    return total / len(tours.seconds)


def cost_of(tours: Tours, longest: float, mean: float) -> float:
    """Return what is to be small: the weighted longest tour and mean, and above all what is late."""
    late = 0.0
    for robot in range(len(tours.late)):
        late += tours.late[robot]
    return longest * tours.seconds[longest_of(tours)] + mean * mean_of(tours) + _LATE * late


def follow(source: Tours, target: Tours, robots: Wholes, known: Wholes) -> None:
    """Make the tours of robots that differ the same again; they have the same stops together."""
    last = len(known)
    for i in range(robots[last]):
        robot = robots[i]
        known[robot] = 0
        home = len(source.robot) + robot
        stop = home
        for _ in range(source.stops[robot] + 1):
            after = source.after[stop]
            target.after[stop], target.before[after] = after, stop
            if after != home:
                target.robot[after] = robot
                target.begins[after], target.ends[after] = source.begins[after], source.ends[after]
            stop = after
        target.seconds[robot], target.late[robot] = source.seconds[robot], source.late[robot]
        target.stops[robot] = source.stops[robot]
    robots[last] = 0


def construct(field: Field, tours: Tours, room: Room, stops: Wholes) -> None:
    """Insert all stops, in that order."""
    for i in range(len(stops)):
        place(field, tours, room, stops[i], tours.seconds[longest_of(tours)], 0.0)


def anneal(
    field: Field,
    now: Tours,
    other: Tours,
    best: Tours,
    room: Room,
    longest: float,
    mean: float,
    heat: float,
    steps: int,
) -> None:
    """Do so many steps of ruin and recreate.

    Args:
        field: of the tours.
        now: where the search is, and will be. other: the same. best: the best so far.
        room: of the search.
        longest: weight of the longest tour. mean: weight of the mean.
        heat: by how much a step may be worse, on average of those that are taken.
        steps: how many.
    """
    n, m = field.sizes[0], field.sizes[1]
    cost, least = cost_of(now, longest, mean), cost_of(best, longest, mean)
    for _ in range(steps):
        robot = longest_of(other)
        first = int(draw(room) * n)
        if draw(room) < 0.5 and other.stops[robot] > 0:
            first = n + robot
            for _ in range(1 + int(draw(room) * other.stops[robot])):
                first = other.after[first]
        limit = mean_of(other)
        limit += draw(room) * (other.seconds[robot] - limit)
        count = take_apart(field, other, room, first)
        put_in_order(field, room, count)
        for i in range(count):
            place(field, other, room, room.gone[i], limit, _BLINK)
        changed = cost_of(other, longest, mean)
        if changed >= cost - heat * log(draw(room)):
            follow(now, other, room.changed, room.differs)
            continue
        cost = changed
        for i in range(room.changed[m]):
            note(room.stale, room.older, room.changed[i])
        follow(other, now, room.changed, room.differs)
        if changed < least:
            least = changed
            follow(now, best, room.stale, room.older)
