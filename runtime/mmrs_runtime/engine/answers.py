"""A robot's responses to faults, and how long it tolerates them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

from ..faults import TAKEN_OVER
from ..policies import (
    LAST_RESORT,
    NOTHING,
    UNDECLARED,
    UNDECLARED_AFTER,
    Policy,
    patience,
    policy_for,
    response_to,
)
from ..vehicle import Fault

LEAST_PEER_SECONDS = 2.0
"""Real seconds that other processes have at least to answer: networks are no faster when vehicles are."""


@dataclass(frozen=True, slots=True)
class Answers:
    """Policies in the order in which they count.

    Attributes:
        live: whether the robot is a real one, which does not hold by default when it
            cannot be reached or its battery gets low, and waits for lost peers for a limited time.
        least: seconds for which it waits at least for messages of other processes.
    """

    policies: Sequence[Policy]
    live: bool = False
    least: float = 0.0

    def response(self, found: Fault) -> str:
        """Return what the robot does, a response of policies or NOTHING."""
        if found.which == TAKEN_OVER:
            return NOTHING
        if found.instead:
            return found.instead
        if self.live and policy_for(found.which, self.policies) is None:
            return UNDECLARED.get(found.which, LAST_RESORT)
        return response_to(found.which, self.policies)

    def bears(self, found: Fault) -> bool:
        """Return whether the robot tolerates a fault and continues."""
        return not found.instead and response_to(found.which, self.policies) == "CONTINUE"

    def patience(self, found: Fault, *, away: bool = False) -> float:
        """Return for how many seconds the robot tolerates a fault; inf: without limit.

        Args:
            found: the fault.
            away: whether another process is silent.
        """
        if self.bears(found):
            return inf
        seconds = patience(found.which, self.policies)
        if seconds is None:
            seconds = UNDECLARED_AFTER.get(found.which, inf) if self.live else inf
        return max(seconds, self.least) if away else seconds
