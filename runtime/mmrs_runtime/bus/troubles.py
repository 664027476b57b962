"""What goes wrong at one end of the bus, and goes on all the same.

Whatever arrives, and whatever is wrong here, the threads of the bus go on and people are told. A robot
whose owner cannot keep what must survive answers nobody, and is out of reach until it can.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from .owners.journal import Journal

PROBE_SECONDS = 1.0
"""How often it is tried whether something can be kept again."""

SORE_SECONDS = 0.5
"""How long something that fails is left alone."""

MOST_TOLD = 100
"""What goes wrong in more different ways than that is no longer told each time."""

Tell = Callable[[str], None]


def tell_people(line: str) -> None:
    """Write a line to standard error."""
    print(f"bus: {line}\n", end="", file=sys.stderr, flush=True)


class Net:
    """Catches what nobody else does, and tells it once."""

    def __init__(self, tell: Tell = tell_people) -> None:
        """Tell people by a function, which may be called from any thread."""
        self._tell = tell
        self._told: set[str] = set()

    @contextmanager
    def under(self, what: str) -> Iterator[None]:
        """Go on behind the block whatever it raises; `what` is being done."""
        try:
            yield
        except Exception as error:
            self.tell(f"{what}: fails, and goes on: {error!r}")

    def tell(self, line: str) -> None:
        """Tell people, unless they were told the same before."""
        if line not in self._told and len(self._told) < MOST_TOLD:
            self._told.add(line)
            self._tell(line)

    def forget(self, line: str) -> None:
        """Have something told again when it happens again."""
        self._told.discard(line)


class Keeping:
    """Knows which robots' journals can be written. Not thread-safe: whoever has it guards it."""

    def __init__(self, net: Net, now: Callable[[], float]) -> None:
        """Know of no journal; `now`: seconds of a clock that never goes back."""
        self._net, self._now = net, now
        self._journals: dict[str, Journal] = {}
        self._wrong: dict[str, str] = {}
        self._shown: set[str] = set()
        self._probe = float("inf")

    def watched(self, robot: str, journal: Journal) -> Journal:
        """Return a journal that does the same, and tells whether it can."""
        self._journals[robot] = journal
        return _Watched(robot, journal, self)

    def why(self, robot: str) -> str:
        """Return why a robot's journal cannot be written; empty: it can."""
        return self._wrong.get(robot, "")

    @property
    def due(self) -> float:
        """Return when there is something to do; inf: never."""
        return float("-inf") if self._shown != set(self._wrong) else self._probe

    def look(self) -> tuple[list[str], list[str]]:
        """Try again where it is time; return the robots that go out of reach, and those that are back."""
        if self._now() >= self._probe:
            for robot in list(self._wrong):
                self._try(robot)
        wrong = set(self._wrong)
        gone, back = sorted(wrong - self._shown), sorted(self._shown - wrong)
        self._shown = wrong
        return gone, back

    def failed(self, robot: str, error: OSError) -> None:
        """Take note that a journal could not be written."""
        why = error.strerror or str(error)
        self._wrong[robot] = f"its slots cannot be kept: {why}"
        self._probe = self._now() + PROBE_SECONDS
        self._net.tell(self._words(robot, why))

    def kept(self, robot: str) -> None:
        """Take note that a journal was written."""
        if (why := self._wrong.pop(robot, None)) is None:
            return
        self._net.forget(self._words(robot, why.rpartition(": ")[2]))
        if not self._wrong:
            self._probe = float("inf")

    def _try(self, robot: str) -> None:
        try:
            self._journals[robot].keep({"again": robot})
        except OSError as error:
            self.failed(robot, error)
        else:
            self.kept(robot)

    def _words(self, robot: str, why: str) -> str:
        return f"{robot!r} answers nobody until its slots can be kept again: {why}"


class _Watched:
    """A journal of a robot, and who wants to know whether it can be written."""

    def __init__(self, robot: str, journal: Journal, keeping: Keeping) -> None:
        self._robot, self._journal, self._keeping = robot, journal, keeping

    def __str__(self) -> str:
        """Return where the journal is."""
        return str(self._journal)

    def lines(self) -> Iterator[Mapping[str, Any]]:
        """Yield what was kept before."""
        return self._journal.lines()

    def keep(self, line: Mapping[str, Any]) -> None:
        """Keep a line.

        Raises:
            OSError: it cannot be.
        """
        try:
            self._journal.keep(line)
        except OSError as error:
            self._keeping.failed(self._robot, error)
            raise
        self._keeping.kept(self._robot)
