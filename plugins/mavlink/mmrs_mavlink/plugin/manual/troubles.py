"""Faults of a vehicle that is driven manually, and how long policies tolerate them."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Policy
from mmrs_mavlink.plugin.manual.autopilot import STALL, StickAutopilot
from mmrs_runtime import faults
from mmrs_runtime.policies import UNDECLARED_AFTER, patience

LINK_PATIENCE = UNDECLARED_AFTER[faults.LINK_LOST]
"""Seconds of silence after which the link counts as lost, where no policy says."""


class Troubles:
    """Looks after a vehicle.

    Attributes:
        event: what is wrong, in the word of policies; empty: nothing.
    """

    def __init__(self, autopilot: StickAutopilot, policies: Sequence[Policy]) -> None:
        """Create without faults; of two policies for an event the first counts."""
        self.event = ""
        self._autopilot, self._policies = autopilot, policies
        seconds = patience(faults.LINK_LOST, policies)
        self._silence = LINK_PATIENCE if seconds is None else seconds
        self._fault: Fault | None = None
        self._looked, self._lasted = -inf, 0.0
        self._borne: set[str] = set()

    def look(self, now: float) -> None:
        """Update the present faults; one that lasts is reported in the words of its beginning."""
        found = self._autopilot.trouble(self._silence)
        gone, self._looked = now - self._looked, now
        if found is None:
            self.end()
        elif found.event != self.event:
            self.begin(Fault(found.event, str(found), found.instead), 0.0)
        else:
            self._lasted += min(gone, STALL)

    def begin(self, found: Fault, lasted: float = inf) -> None:
        """Set a fault that has lasted for that many seconds."""
        self._fault, self.event, self._lasted = found, found.which, lasted

    def end(self) -> None:
        """Clear all faults."""
        self._fault, self.event = None, ""

    def lasting(self) -> Fault | None:
        """Return a fault that has lasted for as long as its policy defines, unless it is tolerated."""
        found = self._fault
        if found is None or found.which in self._borne or self._lasted < self._after(found):
            return None
        return found

    def bear(self) -> None:
        """Report the present faults, and those of their kind, no more."""
        self._borne.add(self.event)

    def _after(self, found: Fault) -> float:
        """Return for how many seconds a fault is tolerated; a lost link has been already."""
        at_once = found.which == faults.LINK_LOST or found.instead
        return 0.0 if at_once else patience(found.which, self._policies) or 0.0
