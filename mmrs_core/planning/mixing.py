"""Sharing of a task among groups of robots, each of which has a work of its own for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from itertools import permutations
from typing import TypeAlias

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.materials import Layout, Material, lay_out
from mmrs_core.planning.omissions import amount_left_out
from mmrs_core.planning.remainders import Remainders, Turn
from mmrs_core.planning.sharing import RowFilling, Share, ShareCandidate, fillings
from mmrs_core.planning.sorties import Pilot
from mmrs_core.scene import Work

Runs: TypeAlias = tuple[tuple[int, int, int], ...]
"""(sort, first portion, last portion) of those who choose first, in their order."""

_SURELY = 0.95
"""Share of a work, as they do all of it, that robots of several sorts must be able to do by a time to be
asked to: below 1, as one sort may do just those parts that take another one longer."""

MIXES = 3
"""Mixes at most that are tried for one number of robots."""


@dataclass(frozen=True, slots=True)
class WorkGroup:
    """Robots with one work.

    Attributes:
        work: of the task.
        robots: names of the robots that can do it.
        layout: of the whole work.
    """

    work: Work
    robots: tuple[str, ...]
    layout: Layout


@dataclass(frozen=True, slots=True)
class _Rest:
    """What is left for a sort: indices of the parts, and the layout of the work that is made of them."""

    parts: tuple[int, ...]
    work: Work
    layout: Layout


class Mixture:
    """The sorts of robots that can share a task.

    Attributes:
        sorts: those whose works leave out most come first; the last does all that is left.
    """

    def __init__(
        self,
        task: str,
        sorts: Sequence[WorkGroup],
        pilots: Mapping[str, Pilot],
        kinds: Mapping[str, str],
        divide: Callable[[Work, Sequence[str]], Layout],
    ) -> None:
        """Make it.

        Args:
            task: its name.
            sorts: whose works are comparable.
            pilots: by name of robot.
            kinds: by name of robot: the first that does all as it does.
            divide: makes a layout of a part of the work of a group.
        """
        self.sorts = sorted(sorts, key=lambda each: -amount_left_out(each.work))
        self._task, self._pilots, self._kinds, self._divide = task, pilots, kinds, divide
        self._remainders: Remainders | None = None
        self._rests: dict[tuple[int, Runs], _Rest] = {}
        self._materials: dict[tuple[str, Runs, bool], Material | None] = {}

    def rest(self, sort: int, runs: Runs) -> _Rest:
        """Return what runs of others leave for a sort."""
        if (sort, runs) not in self._rests:
            self._rests[sort, runs] = self._made(sort, runs)
        return self._rests[sort, runs]

    def _made(self, sort: int, runs: Runs) -> _Rest:
        known = self._remainders = self._remainders or _remainders_of(tuple(each.work for each in self.sorts))
        mine, parts = self.sorts[sort], known.parts[sort]
        left = tuple(sorted(known.left(sort, [self._turn(runs[:i], *run) for i, run in enumerate(runs)])))
        if len(left) == len(parts):
            return _Rest(left, mine.work, mine.layout)
        entry = None if any(first == 0 for _, first, _ in runs) else mine.work.entry
        work = replace(mine.work, strokes=tuple(parts[i] for i in left), entry=entry)
        return _Rest(left, work, self._divide(work, mine.robots) if left else Layout((), can_turn=False))

    def _turn(self, before: Runs, sort: int, first: int, last: int) -> Turn:
        rest = self.rest(sort, before)
        sizes = [len(portion) for portion in rest.layout.portions]
        done = rest.parts[sum(sizes[:first]) : sum(sizes[: last + 1])]
        return Turn(sort, frozenset(rest.parts), frozenset(done))

    def material(self, robot: str, sort: int, runs: Runs, *, backwards: bool = False) -> Material | None:
        """Return the material of what runs of others leave for a robot; None if it cannot get there."""
        key = (self._kinds[robot], runs, backwards)
        if key not in self._materials:
            rest, made = self.rest(sort, runs), None
            if rest.parts and (rest.layout.can_turn or not backwards):
                try:
                    pilot = self._pilots[self._kinds[robot]]
                    made = lay_out(self._task, rest.work, rest.layout, pilot, backwards=backwards)
                except UnreachableError:
                    made = None
            self._materials[key] = made
        return self._materials[key]


@lru_cache(maxsize=4)
def _remainders_of(works: tuple[Work, ...]) -> Remainders:
    """Return the remainders of works; the same ones for teams that differ in something else."""
    return Remainders(works)


@cache
def mixes(sizes: tuple[int, ...], robots: int) -> list[tuple[int, ...]]:
    """Return how many robots of each sort may make up so many, of two sorts at least, evenest first.

    These are as many as each sort's part of all robots, and those with one robot of another sort instead.

    >>> mixes((2, 1), 2)
    [(1, 1)]
    >>> mixes((3, 2), 3)
    [(2, 1), (1, 2)]
    """
    shares = [robots * size / sum(sizes) for size in sizes]
    even = [int(share) for share in shares]
    by_rest = sorted(range(len(sizes)), key=lambda sort: even[sort] - shares[sort])
    for sort in by_rest[: robots - sum(even)]:
        even[sort] += 1
    others = [
        tuple(count + (sort == more) - (sort == less) for sort, count in enumerate(even))
        for more, less in permutations(range(len(sizes)), 2)
        if even[less] and even[more] < sizes[more]
    ]
    others.sort(key=lambda counts: sum((c - share) ** 2 for c, share in zip(counts, shares, strict=True)))
    return [counts for counts in (tuple(even), *others) if sum(map(bool, counts)) > 1][:MIXES]


_Group: TypeAlias = tuple[int, Sequence[ShareCandidate]]
"""A sort of a mixture, and those of its robots that take part, with their material of the whole task."""


class MixedFilling:
    """Fills robots sort by sort: each does what it can by a time, the last one all that the others leave."""

    alone = False

    def __init__(
        self, mixture: Mixture, groups: Sequence[_Group], *, ahead: bool, everyone: bool = False
    ) -> None:
        """Make it.

        Args:
            mixture: of the task.
            groups: of two sorts at least, in their order.
            ahead: whether each sort begins at the beginning of its work, and not at its end.
            everyone: whether each robot must have a share.
        """
        self._mixture, self._groups, self._ahead, self._everyone = mixture, groups, ahead, everyone
        self.begin = min(each.state.time for _, group in groups for each in group)
        self._fillings: dict[tuple[int, Runs], list[RowFilling]] = {}
        self._counts: dict[tuple[int, int], list[tuple[float, int]]] = {}
        robots = [each for _, group in groups for each in group]
        self._works = [(each.capacity, each.forwards.fewest_seconds(len(robots))) for each in robots]

    def shares(self, limit: float) -> list[Share]:
        """Return shares of all the work after which robots are back by a time; none if they cannot be."""
        if sum(capacity.until(limit) / work if work else 1.0 for capacity, work in self._works) < _SURELY:
            return []
        runs: Runs = ()
        found: list[Share] = []
        last = len(self._groups) - 1
        for index, (sort, _) in enumerate(self._groups):
            if not self._mixture.rest(sort, runs).parts:
                return [] if self._everyone else found
            ways = self._fillings_of(index, runs)
            if index == last:
                return next(([*found, *mine] for each in ways if (mine := each.shares(limit))), [])
            mine = self._most(index, runs, ways, limit)
            if mine:
                runs = (*runs, self._run(index, mine))
                found += mine
            elif self._everyone:
                return []
        return found

    def _most(self, index: int, runs: Runs, ways: Sequence[RowFilling], limit: float) -> list[Share]:
        """Return shares of as many portions as a group does by a time and leaves enough for the next."""
        most = max((each.portions for each in ways), default=0) - self._everyone
        while True:
            mine = max((self._taken(each, limit, most) for each in ways), key=_portions, default=[])
            if not mine or self._leaves_enough(index, (*runs, self._run(index, mine))):
                return mine
            most = _portions(mine) // 2

    def _run(self, index: int, mine: Sequence[Share]) -> tuple[int, int, int]:
        return self._groups[index][0], mine[0].run.begin, mine[-1].end

    def _leaves_enough(self, index: int, runs: Runs) -> bool:
        """Return whether runs leave the next group a portion for each robot to come that must have one."""
        later = self._groups[index + 1 :]
        robots = sum(len(group) for _, group in later)
        return not self._everyone or len(self._mixture.rest(later[0][0], runs).layout.portions) >= robots

    def _taken(self, filling: RowFilling, limit: float, most: int) -> list[Share]:
        """Return shares of as many portions, at most some, as robots can do by a time."""
        count = filling.portions
        if self._ahead:
            return filling.part(limit, 0, most)
        known = self._counts.setdefault((id(filling), most), [])
        few, found = max((done for time, done in known if time <= limit), default=0), list[Share]()
        most = min((done for time, done in known if time >= limit), default=most)
        while few < most or (few and not found):
            middle = (few + most + 1) // 2
            mine = filling.whole(limit, count - middle, count)
            if not mine:
                few, most = min(few, middle - 1), middle - 1
            else:
                few, found = middle, mine
        known.append((limit, few))
        return found

    def _fillings_of(self, index: int, runs: Runs) -> list[RowFilling]:
        """Return how a group may do what runs of others leave."""
        if (index, runs) not in self._fillings:
            sort, group = self._groups[index]
            candidates = self._of_rest(sort, group, runs) if runs else group
            ways = fillings(candidates, everyone=self._everyone) if candidates else []
            self._fillings[index, runs] = ways
        return self._fillings[index, runs]

    def _of_rest(self, sort: int, group: Sequence[ShareCandidate], runs: Runs) -> list[ShareCandidate]:
        found = []
        for each in group:
            lay_out_rest = partial(self._mixture.material, each.pilot.robot.name, sort, runs)
            if (forwards := lay_out_rest()) is not None:
                backwards = partial(lay_out_rest, backwards=True)
                found.append(
                    ShareCandidate(each.pilot, each.state, each.ready, forwards, backwards, each.record)
                )
        return found if len(found) == len(group) or not self._everyone else []


def _portions(shares: Sequence[Share]) -> int:
    return shares[-1].end - shares[0].run.begin + 1 if shares else 0
