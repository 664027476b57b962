"""What a robot does about faults, and for how long it bears them."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from mmrs_core.contributions.abilities import Bearing
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Policy
from mmrs_runtime.faults import TAKEN_OVER
from mmrs_runtime.policies import LAST_RESORT, NOTHING, UNDECLARED, patience, policy_for, response_to


@dataclass(frozen=True, slots=True)
class Answers:
    """Policies in the order in which they count.

    Attributes:
        live: whether the robot is a real one, which does not hold for want of a better idea when it
            cannot be reached, or when its battery gets low.
    """

    policies: tuple[Policy, ...]
    live: bool = False

    def response(self, found: Fault) -> str:
        """Return what the robot does, a literal of PolicyResponse or NOTHING."""
        if found.which == TAKEN_OVER:
            return NOTHING
        if found.instead:
            return found.instead
        if self.live and policy_for(found.which, self.policies) is None:
            return UNDECLARED.get(found.which, LAST_RESORT)
        return response_to(found.which, self.policies)

    def bears(self, found: Fault) -> bool:
        """Return whether the robot goes on as if nothing were."""
        return not found.instead and response_to(found.which, self.policies) == "CONTINUE"

    def patience(self, found: Fault) -> float:
        """Return for how many seconds the robot bears it; inf: for ever."""
        if self.bears(found):
            return inf
        seconds = patience(found.which, self.policies)
        return inf if seconds is None else seconds

    def unborne(self, backend: Backend, now: float) -> Fault | None:
        """Return what a backend says went wrong, unless the robot goes on as if nothing were.

        Raises:
            LinkLostError: the robot cannot be reached.
        """
        found = backend.fault(now)
        if found is None or not self.bears(found):
            return found
        goes_on = not isinstance(backend, Bearing) or backend.bear(now)
        return None if goes_on else found
