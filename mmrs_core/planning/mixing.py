"""Sharing of a task among groups of robots, each of which has a work of its own for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import TypeAlias

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.materials import Layout, Material, lay_out
from mmrs_core.planning.omissions import amount_left_out
from mmrs_core.planning.remainders import Remainders, Turn
from mmrs_core.planning.sharing import CLOSE, ShareCandidate, Sharing, share_out
from mmrs_core.planning.sorties import Pilot
from mmrs_core.scene import Work

Runs: TypeAlias = tuple[tuple[int, int, int], ...]
"""(sort, first portion, last portion) of those who choose first, in their order."""

_MIXES = 3
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
        divide: Callable[[Work, Sequence[str]], Layout],
    ) -> None:
        """Make it.

        Args:
            task: its name.
            sorts: whose works are comparable.
            pilots: by name of robot.
            divide: makes a layout of a part of the work of a group.
        """
        self.sorts = sorted(sorts, key=lambda each: -amount_left_out(each.work))
        self._task, self._pilots, self._divide = task, pilots, divide
        self._remainders: Remainders | None = None
        self._rests: dict[tuple[int, Runs], _Rest] = {}
        self._materials: dict[tuple[str, Runs, bool], Material | None] = {}

    def rest(self, sort: int, runs: Runs) -> _Rest:
        """Return what runs of others leave for a sort."""
        if (sort, runs) not in self._rests:
            self._rests[sort, runs] = self._made(sort, runs)
        return self._rests[sort, runs]

    def _made(self, sort: int, runs: Runs) -> _Rest:
        known = self._remainders = self._remainders or Remainders([each.work for each in self.sorts])
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
        key = (robot, runs, backwards)
        if key not in self._materials:
            rest, made = self.rest(sort, runs), None
            if rest.parts and (rest.layout.can_turn or not backwards):
                try:
                    pilot = self._pilots[robot]
                    made = lay_out(self._task, rest.work, rest.layout, pilot, backwards=backwards)
                except UnreachableError:
                    made = None
            self._materials[key] = made
        return self._materials[key]


def share_mixed(
    mixture: Mixture,
    groups: Sequence[Sequence[ShareCandidate]],
    *,
    everyone: bool = False,
    record: bool = False,
) -> Sharing | None:
    """Return the best way found to share a task out among sorts of robots; None if they cannot do it.

    Robots of the first sort take so many portions from the beginning of their work, or up to its end,
    that they are back when the others are, who do what they leave; found by bisection, sort by sort.

    Args:
        mixture: of the task.
        groups: by sort of the mixture: robots that take part, with their material of the whole task.
        everyone: whether each robot must have a share.
        record: see `PortionRun`.
    """
    some = [(sort, group) for sort, group in enumerate(groups) if group]
    return _Mixing(mixture, everyone, record).best(some, ())


@cache
def mixes(sizes: tuple[int, ...], robots: int) -> list[tuple[int, ...]]:
    """Return how many robots of each sort may make up so many, of two sorts at least, evenest first.

    >>> mixes((2, 1), 2)
    [(1, 1)]
    >>> mixes((3, 2), 3)
    [(2, 1), (1, 2)]
    """
    found = [
        counts
        for counts in product(*(range(size + 1) for size in sizes))
        if sum(counts) == robots and sum(map(bool, counts)) > 1
    ]
    whole = sum(sizes)
    found.sort(
        key=lambda counts: sum((c - robots * s / whole) ** 2 for c, s in zip(counts, sizes, strict=True))
    )
    return found[:_MIXES]


_Group: TypeAlias = tuple[int, Sequence[ShareCandidate]]


class _Mixing:
    def __init__(self, mixture: Mixture, everyone: bool, record: bool) -> None:
        self._mixture, self._everyone, self._record = mixture, everyone, record

    def best(self, groups: Sequence[_Group], runs: Runs) -> Sharing | None:
        """Return how groups share what runs of others leave."""
        sort, group = groups[0]
        candidates = group if not runs else self._of_rest(sort, group, runs)
        if not candidates:
            return None
        if len(groups) == 1:
            return share_out(candidates, everyone=self._everyone, record=self._record)
        found = [self._balanced(candidates, groups, runs, ahead=ahead) for ahead in (True, False)]
        return min((each for each in found if each), key=lambda each: each.back, default=None)

    def _of_rest(self, sort: int, group: Sequence[ShareCandidate], runs: Runs) -> list[ShareCandidate]:
        found = []
        for each in group:
            name = each.pilot.robot.name
            forwards = self._mixture.material(name, sort, runs)
            if forwards is not None:
                backwards = self._mixture.material(name, sort, runs, backwards=True)
                found.append(replace(each, forwards=forwards, backwards=backwards))
        return found if len(found) == len(group) or not self._everyone else []

    def _balanced(
        self, candidates: Sequence[ShareCandidate], groups: Sequence[_Group], runs: Runs, *, ahead: bool
    ) -> Sharing | None:
        """Return the sharing in which the first group takes as many portions as all end early with."""
        (sort, _), *others = groups
        count = len(candidates[0].forwards)
        low, high = (len(candidates) if self._everyone else 1), count
        best: Sharing | None = None
        size = (low + high) // 2
        while low <= high:
            first = 0 if ahead else count - size
            taken: Runs = (*runs, (sort, first, first + size - 1))
            mine = rest = None
            if enough := self._are_enough(others, taken):
                mine = self._alone(candidates, first, size)
                rest = None if mine is None else self.best(others, taken)
            if mine is not None and rest is not None:
                back = max(mine.back, rest.back)
                if best is None or back < best.back - 1e-9:
                    best = Sharing((*mine.shares, *rest.shares), back)
                if abs(mine.back - rest.back) <= CLOSE * back:
                    break
            if not enough or mine is None or (rest is not None and mine.back > rest.back):
                high = size - 1
            else:
                low = size + 1
            size = (low + high) // 2
        return best

    def _are_enough(self, groups: Sequence[_Group], runs: Runs) -> bool:
        """Return whether runs leave portions for the next group, one for each robot that must have one."""
        sort, group = groups[0]
        return len(self._mixture.rest(sort, runs).layout.portions) >= (len(group) if self._everyone else 1)

    def _alone(self, candidates: Sequence[ShareCandidate], first: int, size: int) -> Sharing | None:
        """Return how one group shares a run of its portions."""
        count = len(candidates[0].forwards)
        last = first + size - 1
        mine = [
            replace(
                each,
                forwards=each.forwards.only(first, last),
                backwards=each.backwards and each.backwards.only(count - 1 - last, count - 1 - first),
            )
            for each in candidates
        ]
        return share_out(mine, everyone=self._everyone, record=self._record)
