"""How long a planner searches for better plans: a number of steps, a time, or until it is stopped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mmrs_core.scene import Plan

SLICE = 16
"""Steps between two looks at the clock."""


class Effort:
    """What a search may spend, and how far it has come.

    Without a time it is a number of steps for each search, so that the same seed gives the same plan.

    Attributes:
        timed: whether a time ends the search.
        least: seconds that no plan's makespan falls below.
        best: makespan of the best plan or tours so far, seconds; inf: none yet.
        stopped: whether it was ended before.
    """

    def __init__(
        self,
        seconds: float | None = None,
        clock: Callable[[], float] = lambda: 0.0,
        show: Callable[[float, float], None] = lambda best, least: None,
    ) -> None:
        """Begin now.

        Args:
            seconds: after which the search ends; None: after its steps.
            clock: returns seconds.
            show: is given the best makespan so far and the least possible one, whenever one of them changes.
        """
        self.timed, self.least, self.best = seconds is not None, 0.0, inf
        self._clock, self._show = clock, show
        self._end = inf if seconds is None else clock() + seconds
        self.stopped = False
        self._trial: Effort | None = None

    def stop(self) -> bool:
        """End the search; return whether it has something that can be kept."""
        self.stopped = self.best < inf
        keeps = self._trial is not None and self._trial.stop()
        return self.stopped or keeps

    def trial(self) -> Effort:
        """Return the effort of a search before this one, whose result may be rejected.

        It has three quarters of the time left. While nothing else has been found, stopping this one stops it.
        """
        seconds = 0.75 * (self._end - self._clock()) if self.timed else None
        self._trial = Effort(seconds, self._clock, self._show)
        return self._trial

    def again(self, share: float = 1.0) -> Effort:
        """Return the effort of a search after another one, which shows nothing.

        Args:
            share: of the time left that it may take.
        """
        seconds = share * (self._end - self._clock()) if self.timed else None
        self._trial = Effort(seconds, self._clock)
        self._trial.best, self._trial.stopped = self.best, self.stopped
        return self._trial

    @property
    def over(self) -> bool:
        """Whether the search is to end with what it has."""
        return self.stopped or (self.timed and self._clock() >= self._end)

    def found(self, makespan: float) -> None:
        """Take note of a makespan that was found."""
        if makespan < self.best - 0.05:
            self.best = makespan
            self._show(self.best, self.least)

    def shares(self, steps: int, *, of_the_rest: float = 0.0) -> Iterator[float]:
        """Yield, before each slice of steps, which share of a search is done.

        Args:
            steps: of the search.
            of_the_rest: share of the time left that it may take instead; 0: it ends with its steps.
        """
        if of_the_rest and self.timed:
            begin = self._clock()
            whole = of_the_rest * (self._end - begin)
            while (
                not self.stopped and (share := (self._clock() - begin) / whole if whole > 0.0 else 1.0) < 1.0
            ):
                yield share
            return
        for step in range(0, steps, SLICE):
            if self.over:
                return
            yield step / steps


@dataclass(frozen=True, slots=True)
class SearchLimit:
    """What other plans must beat, and how long they are sought: always until one is known.

    Attributes:
        best: plan so far; None: none is known.
        effort: of the search; None: it comes to its end.
    """

    best: Plan | None = None
    effort: Effort | None = None

    @property
    def most(self) -> float:
        """Seconds that a plan must take less than."""
        return inf if self.best is None else self.best.makespan

    @property
    def late(self) -> bool:
        """Whether the search is to end as soon as a plan is known."""
        return self.effort is not None and self.effort.over

    @property
    def over(self) -> bool:
        """Whether nothing is to be tried any more."""
        return self.best is not None and self.late


UNLIMITED = SearchLimit()
