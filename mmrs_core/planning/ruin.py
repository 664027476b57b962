"""Ruin and recreate: tours taken apart near one place and put together better, again and again.

Schrimpf, Schneider, Stamm-Wilbrandt and Dueck, "Record breaking optimization results using the ruin and
recreate principle", J. Comput. Phys. 159 (2000): remove some stops, insert them again, keep what is better or
only a little worse. What is removed and how it is inserted follow Christiaens and Vanden Berghe, "Slack
induction by string removals for vehicle routing problems", Transp. Sci. 54 (2020): strings of stops of
neighbouring tours; greedy insertion that overlooks a position now and then; simulated annealing. As the
longest tour counts here, every second step begins at one of its stops, and insertion shuns what makes a tour
longer than a limit between the mean and the longest.

A stop is 0 to n - 1, the home of robot r is n + r; a tour is a ring from home through its stops. All numbers
are in flat lists, matrices row after row: that is what plain Python is quickest with.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, log
from random import Random

_STRING = 10
"""Stops at most that are removed from one tour in a row."""

_REMOVED = 10
"""Stops that are removed at once on average."""

_BLINK = 0.01
"""Share of positions that an insertion overlooks, lest it always does the same."""

_HOT, _COLD = 0.2, 0.002
"""Temperature at the beginning and at the end, as a share of the mean tour."""

_TOO_LONG = 10.0
"""Factor on the seconds by which a tour is beyond its limit."""

_LATE = 1000.0
"""Factor on the seconds by which a deadline is missed."""


@dataclass(frozen=True, slots=True)
class Field:
    """What is to be done and by whom: n stops, m robots, k sorts of robots.

    Attributes:
        kinds: (m), of each robot.
        out: (m, n), seconds from a robot's home to a stop; inf: it cannot do that one.
        go: (k, n, n), seconds from one stop to another.
        back: (m, n), seconds from a stop until the robot is back.
        work: (k, n), seconds at a stop.
        near: by stop: other stops, nearest first. near_robots: robots that may begin with it.
        apart: by stop: others that another robot must do.
        limits: (m), seconds that a charge allows. recharges: (m), seconds that the next one takes.
        earliest: (n), seconds before which a stop may not begin. deadlines: (n), by when it is to end.
        ranks: (n), of priority: they do not rise along a tour.
    """

    kinds: list[int]
    out: list[float]
    go: list[float]
    back: list[float]
    work: list[float]
    near: list[list[int]]
    near_robots: list[list[int]]
    apart: list[list[int]]
    limits: list[float]
    recharges: list[float]
    earliest: list[float]
    deadlines: list[float]
    ranks: list[int]

    def travel(self, robot: int, one: int, two: int) -> float:
        """Return the seconds that a robot takes from one stop, or its home, to another."""
        n = len(self.near)
        if one >= n:
            return 0.0 if two >= n else self.out[robot * n + two]
        if two >= n:
            return self.back[robot * n + one]
        return self.go[(self.kinds[robot] * n + one) * n + two]


class Tours:
    """Who does what in which order.

    Attributes:
        robot: (n), whose tour a stop is in; -1: in none.
        begins: (n), seconds at which a stop begins.
        seconds: (m), of each tour. late: (m), by which its deadlines are missed. stops: (m), how many.
    """

    def __init__(self, field: Field) -> None:
        """Make empty ones."""
        n, m = len(field.near), len(field.kinds)
        self._field = field
        ring = [*([-1] * n), *range(n, n + m)]
        self.after, self.before = ring[:], ring[:]
        self.robot = [-1] * n
        self.begins, self.ends = [0.0] * (n + m), [0.0] * (n + m)
        self.seconds, self.late, self.stops = [0.0] * m, [0.0] * m, [0] * m

    def become(self, other: Tours) -> None:
        """Become the same as other tours."""
        self.after[:], self.before[:], self.robot[:] = other.after, other.before, other.robot
        self.begins[:], self.ends[:] = other.begins, other.ends
        self.seconds[:], self.late[:], self.stops[:] = other.seconds, other.late, other.stops

    def of(self, robot: int) -> Iterator[int]:
        """Yield the stops of a robot in order."""
        home = len(self.robot) + robot
        stop = self.after[home]
        while stop != home:
            yield stop
            stop = self.after[stop]

    def longest(self) -> int:
        """Return the robot of the longest tour."""
        return self.seconds.index(max(self.seconds))

    def mean(self) -> float:
        """Return the mean seconds of the tours."""
        return sum(self.seconds) / len(self.seconds)

    def insert(self, stop: int, robot: int, before: int) -> None:
        """Put a stop into a tour behind another one, or home."""
        after = self.after[before]
        self.after[before], self.before[stop] = stop, before
        self.after[stop], self.before[after] = after, stop
        self.robot[stop] = robot
        self.stops[robot] += 1
        self.retime(robot)

    def remove(self, stop: int) -> None:
        """Take a stop out of its tour, whose times are brought up to date by `retime`."""
        before, after = self.before[stop], self.after[stop]
        self.after[before], self.before[after] = after, before
        self.stops[self.robot[stop]] -= 1
        self.robot[stop] = -1

    def retime(self, robot: int) -> None:
        """Bring the times of a tour up to date, recharges at home included."""
        field, n = self._field, len(self.robot)
        home, row, work = n + robot, robot * n, field.kinds[robot] * n
        time, used, late, here = 0.0, 0.0, 0.0, home
        for stop in self.of(robot):
            away, spent = field.travel(robot, here, stop), field.work[work + stop]
            if here != home and used + away + spent + field.back[row + stop] > field.limits[robot]:
                time += field.back[row + here] + field.recharges[robot]
                used, away, here = 0.0, field.out[row + stop], home
            begin = max(time + away, field.earliest[stop])
            used += (away if here == home else begin - time) + spent
            time = begin + spent
            late += max(0.0, time - field.deadlines[stop])
            self.begins[stop], self.ends[stop] = begin, time
            here = stop
        self.seconds[robot] = time + field.travel(robot, here, home)
        self.late[robot] = late

    def price(self, stop: int, robot: int, before: int, limit: float) -> float:
        """Return how bad it is to insert a stop there: seconds more, and more so beyond a limit."""
        field, n, after = self._field, len(self.robot), self.after[before]
        if before < n and field.ranks[before] < field.ranks[stop]:
            return inf
        if after < n and field.ranks[after] > field.ranks[stop]:
            return inf
        if field.out[robot * n + stop] == inf or any(self.robot[each] == robot for each in field.apart[stop]):
            return inf
        begin = max(self.ends[before] + field.travel(robot, before, stop), field.earliest[stop])
        end = begin + field.work[field.kinds[robot] * n + stop]
        whole = end + field.travel(robot, stop, after)
        if after < n:
            whole = max(whole, field.earliest[after]) + self.seconds[robot] - self.begins[after]
        late = max(0.0, end - field.deadlines[stop])
        return whole - self.seconds[robot] + _TOO_LONG * max(0.0, whole - limit) + _LATE * late


class Search:
    """A search for tours, step by step.

    Attributes:
        best: the best tours so far.
    """

    def __init__(self, field: Field, seed: int, weights: tuple[float, float] = (1.0, 0.1)) -> None:
        """Insert all stops once.

        Args:
            field: of the stops.
            seed: of the random numbers.
            weights: of the longest tour, and of the mean of all.
        """
        self._field, self._random, self._weights = field, Random(seed), weights
        self._now, self.best = Tours(field), Tours(field)
        stops = list(range(len(field.near)))
        self._random.shuffle(stops)
        for stop in sorted(stops, key=lambda each: -field.ranks[each]):
            self._place(self._now, stop, self._now.seconds[self._now.longest()], 0.0)
        self.best.become(self._now)
        self._mean = self._now.mean()

    def cost(self, tours: Tours) -> float:
        """Return what is to be small: the weighted longest tour and mean, and above all what is late."""
        longest, mean = self._weights
        return longest * max(tours.seconds) + mean * tours.mean() + _LATE * sum(tours.late)

    def run(self, steps: int) -> Iterator[int]:
        """Do so many steps, and yield the number of each before it."""
        random, now, other = self._random, self._now, Tours(self._field)
        other.become(now)
        cost, least = self.cost(now), self.cost(self.best)
        heat, cooling = _HOT * self._mean, (_COLD / _HOT) ** (1.0 / max(1, steps))
        for step in range(steps):
            yield step
            longest, mean = other.seconds[other.longest()], other.mean()
            gone = self._in_some_order(self._ruined(other, self._first(other)))
            limit = mean + random.random() * (longest - mean)
            for stop in gone:
                self._place(other, stop, limit, _BLINK)
            changed = self.cost(other)
            if changed < cost - heat * log(1.0 - random.random()):
                cost = changed
                now.become(other)
                if changed < least:
                    least = changed
                    self.best.become(other)
            else:
                other.become(now)
            heat *= cooling

    def _first(self, tours: Tours) -> int:
        """Return a stop to begin with, of the longest tour every second time."""
        robot = tours.longest()
        if self._random.random() < 0.5 and tours.stops[robot]:
            return self._random.choice(list(tours.of(robot)))
        return int(self._random.random() * len(tours.robot))

    def _ruined(self, tours: Tours, first: int) -> list[int]:
        """Remove strings of stops from the tours around one, and return them."""
        random = self._random
        longest = min(_STRING, max(1.0, len(tours.robot) / len(tours.seconds)))
        strings = int(1.0 + random.random() * (4.0 * _REMOVED / (1.0 + longest) - 1.0))
        gone, ruined = list[int](), set[int]()
        for centre in (first, *self._field.near[first]):
            robot = tours.robot[centre]
            if robot < 0 or robot in ruined:
                continue
            if len(ruined) == strings:
                break
            ruined.add(robot)
            length = 1 + int(random.random() * min(longest, tours.stops[robot]))
            gone += self._string(tours, centre, length)
            tours.retime(robot)
        return gone

    def _string(self, tours: Tours, centre: int, length: int) -> Iterator[int]:
        n, stop = len(tours.robot), centre
        for _ in range(int(self._random.random() * length)):
            stop = tours.before[stop] if tours.before[stop] < n else stop
        while length > 0 and stop < n:
            following = tours.after[stop]
            tours.remove(stop)
            yield stop
            stop, length = following, length - 1

    def _in_some_order(self, stops: list[int]) -> list[int]:
        """Sort removed stops for insertion: at random, long work first, or by how far from home."""
        field, n, sort = self._field, len(self._field.near), self._random.random() * 11.0
        self._random.shuffle(stops)
        away = {stop: field.out[field.near_robots[stop][0] * n + stop] for stop in stops}
        if sort < 4.0:
            return stops
        if sort < 8.0:
            return sorted(stops, key=lambda stop: -field.work[stop])
        return sorted(stops, key=lambda stop: away[stop], reverse=sort < 10.0)

    def _place(self, tours: Tours, stop: int, limit: float, blink: float) -> None:
        """Insert a stop where that is best among the positions next to its nearest stops and robots."""
        field, n, chance = self._field, len(tours.robot), self._random.random
        best, found = inf, (field.near_robots[stop][0], n + field.near_robots[stop][0])
        positions = [(tours.robot[each], each) for each in field.near[stop] if tours.robot[each] >= 0]
        positions += [(robot, tours.before[each]) for robot, each in positions]
        positions += [(robot, n + robot) for robot in field.near_robots[stop]]
        for robot, before in positions:
            if chance() >= blink:
                price = tours.price(stop, robot, before, limit)
                if price < best:
                    best, found = price, (robot, before)
        if best == inf:
            for robot in range(len(tours.seconds)):
                for before in (n + robot, *tours.of(robot)):
                    price = tours.price(stop, robot, before, limit)
                    if price < best:
                        best, found = price, (robot, before)
        tours.insert(stop, *found)
