"""A robot that cannot leave its move yet: since when, for what, and until when."""

from __future__ import annotations

from math import inf

from mmrs_core.contributions.execution import Fault
from mmrs_core.runtime.answers import Answers
from mmrs_core.runtime.peers import Peers


class Wait:
    """What keeps a robot at a move that it has done.

    Attributes:
        since: when it began to wait; None: it does not.
        lacking: names of the slots that it waited for when last looked at.
        question: identifier of the condition that it waits to be decided; empty: of none.
        deadline: when the wait ends by a fault; inf: never.
    """

    def __init__(self, robot: str) -> None:
        """Wait for nothing; `robot`: whose slots are waited for."""
        self.since: float | None = None
        self.lacking: tuple[str, ...] = ()
        self.question = ""
        self.deadline = inf
        self._robot = robot
        self._peer_lost_at: float | None = None

    def begin(self, now: float) -> bool:
        """Take note that the robot waits; return whether it did not before."""
        if self.since is not None:
            return False
        self.since = now
        return True

    def extend(self, seconds: float) -> None:
        """Count so many seconds less, in which the robot was held, and nobody could have ended the wait."""
        self.since = None if self.since is None else self.since + seconds
        self._peer_lost_at = None if self._peer_lost_at is None else self._peer_lost_at + seconds
        self.deadline += seconds

    def overdue(self, now: float, answers: Answers, peers: Peers) -> Fault | None:
        """Return the fault by which the wait ends now, if it does."""
        ends = (self._too_long(answers), self._peer_lost(now, answers, peers))
        self.deadline = min(end for end, _ in ends)
        return next((reason for end, reason in ends if end <= now), None)

    def _too_long(self, answers: Answers) -> tuple[float, Fault]:
        found = Fault("WAIT_TOO_LONG", f"waits for {', '.join(self.lacking) or self.question}")
        return (self.since or 0.0) + answers.patience(found), found

    def _peer_lost(self, now: float, answers: Answers, peers: Peers) -> tuple[float, Fault]:
        lost = sorted({robot for name in self.lacking for robot in peers.lost((self._robot, name))})
        found = Fault("PEER_LOST", f"waits for {', '.join(self.lacking)} of {', '.join(lost)}")
        if not lost:
            self._peer_lost_at = None
            return inf, found
        if self._peer_lost_at is None:
            self._peer_lost_at = now
        return self._peer_lost_at + answers.patience(found), found
