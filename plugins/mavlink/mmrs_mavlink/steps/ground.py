"""Whether ground stations still look on: when they count as lost, and what is said about them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.faults import GROUND_LOST
from mmrs_runtime.policies import CONTINUE, seconds_of

from ..links.ourselves import GROUND_SYSTEM
from ..program import Policy, Robot
from .responses import policy_for

if TYPE_CHECKING:
    from ..links.link import Link

LEAST_GROUND_SECONDS = 3.0
"""Real seconds that they have at least, however fast the vehicle's time goes: they beat once a second."""

WATCHED = "watched from now on"
SAME_SYSTEM = (
    f"as long as its vehicle receives ground station {GROUND_SYSTEM}, it does not notice when this program"
    " falls silent, which has the same system id: give the station another one"
)
ANY_STATION = (
    "as long as its vehicle, a {}, receives any ground station, it does not notice when this program falls"
    " silent"
)


class Ground:
    """Detects over a robot's link when the first ground station is received, and when none is any more."""

    def __init__(self, link: Link) -> None:
        """Listen to the stations of a link."""
        self._link = link
        self._met: tuple[int, ...] = ()

    def news(self) -> list[str]:
        """Return the message about the stations, whenever a new one is received; otherwise nothing."""
        stations = self._link.stations
        before, self._met = self._met, stations.systems
        if before == self._met:
            return []
        added = set(self._met) - set(before)
        masked = [SAME_SYSTEM] if GROUND_SYSTEM in added else []
        autopilot = self._link.profile.autopilot
        if autopilot.counts_any_station and not before:
            masked = [ANY_STATION.format(autopilot.title)]
        return [f"hears {stations}", *masked]

    def silence(self, policy: Policy) -> str:
        """Return why all stations count as lost, by the seconds of the policy; empty if they do not."""
        clock = self._link.clock
        limit = clock.patience(seconds_of(policy), LEAST_GROUND_SECONDS)
        silent = self._link.stations.silent_for(clock.now() - self._link.silent_for())
        if silent is None or silent <= limit:
            return ""
        return f"no messages from {self._link.stations} for {silent:.0f} s"

    def missing(self, robot: Robot) -> str:
        """Return what people should know before the robot moves; empty if they need not."""
        policy = policy_for(GROUND_LOST, robot)
        if policy.response == CONTINUE or self._link.stations.systems:
            return ""
        return f"no ground station received yet: policy {GROUND_LOST} ({policy.response}) waits for the first"
