"""What is heard of another process at all: words of this run and plan, by robots of it, at times that can be.

Every word passes here before anything of it is obeyed, kept or answered. A refusal tells the sender nothing
of the run that it is not part of; people here are told.
"""

from __future__ import annotations

from collections.abc import Callable, Collection

from .words import REACH, Answer, Begin, Commit, Ended, Leave, Prepare, Request

AHEAD = REACH << 12
"""How far the logical time of a word may be ahead of all that this process knows.

A robot counts its steps, fewer than `REACH` between two words of it, and leaps by `REACH` for each sender
that it loses. It loses one in a lease of 1.5 s at most, so 4096 leaps are an hour and a half of being out of
reach of this process while others come and go. The largest number that can be written is a million times as
far: one forged word cannot use up all times.
"""

STRANGE = "not a word of this run and plan"
LATE = "its logical time is further ahead than that of any robot can be"


class Admission:
    """Judges words by run, sender and logical times; changes nothing."""

    def __init__(
        self, run: str, team: Collection[str], lamport: Callable[[], int], tell: Callable[[str], None]
    ) -> None:
        """Admit words of a run.

        Args:
            run: identifier of the run and the plan.
            team: all robots of the mission; none: the carrier alone says who they are.
            lamport: returns the latest logical time that this process knows of.
            tell: tells people of what is refused.
        """
        self._run, self._team, self._lamport, self._tell = run, frozenset(team), lamport, tell

    def refusal(self, word: Request) -> Answer | None:
        """Return what a word is refused with; None: it is to be answered."""
        sender = word.id.sender
        if word.id.run != self._run:
            self._tell(f"a word of {sender!r} is refused: it is of run {word.id.run!r}, not {self._run!r}")
            return Answer("refused", why=STRANGE)
        if strangers := [each for each in (sender, *_robots_in(word)) if not self._knows(each)]:
            self._tell(f"a word of {sender!r} is refused: no robot of the mission: {strangers[0]!r}")
            return Answer("refused", why=STRANGE)
        return self._late(sender, max(_times_in(word), default=0))

    def believes(self, owner: str, answer: Answer) -> bool:
        """Return whether an answer can be one to a word of this process."""
        return self._late(owner, answer.lamport) is None

    def _knows(self, robot: str) -> bool:
        return not self._team or robot in self._team

    def _late(self, robot: str, lamport: int) -> Answer | None:
        if lamport <= self._lamport() + AHEAD:
            return None
        self._tell(f"a word of {robot!r} is refused: {LATE}")
        return Answer("refused", why=LATE)


def _robots_in(word: Request) -> tuple[str, ...]:
    return tuple(robot for robot, _ in word.robots) if isinstance(word, Ended) else ()


def _times_in(word: Request) -> tuple[int, ...]:
    match word:
        case Prepare() | Commit() | Leave():
            return (word.lamport,)
        case Begin():
            return tuple(lamport for _, _, lamport in word.recorded)
        case Ended():
            return tuple(lamport for _, lamport in word.robots)
        case _:
            return ()
