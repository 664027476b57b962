"""Whether ground stations still look on: when they count as lost, and what is said about them."""

from __future__ import annotations

from ..faults import GROUND_LOST
from ..links.link import Link
from ..links.radio import GROUND_SYSTEM
from ..program import Policy, Robot
from .responses import CONTINUE, policy_for

GROUND_SECONDS = 10.0
"""For how long all ground stations must be silent where the policy does not say."""

LEAST_GROUND_SECONDS = 3.0
"""Real seconds that they have at least, however fast the vehicle's time goes: they beat once a second."""

WATCHED = "watched from now on"
SAME_SYSTEM = (
    f"hears a ground station whose system id is {GROUND_SYSTEM}, as is that of this program: as long as its"
    " vehicle hears the one, it does not notice that the other is silent; give the station another system id"
)


class Ground:
    """Sees over a robot's link when the first ground station is heard, and when none is any more."""

    def __init__(self, link: Link) -> None:
        """Listen to the stations of a link."""
        self._link = link
        self._met = ""

    def news(self) -> str:
        """Return which stations are heard, whenever another one has come; else empty."""
        known = str(self._link.stations)
        before, self._met = self._met, known
        return f"{known} heard" if known != before else ""

    def silence(self, policy: Policy) -> str:
        """Return why all stations count as lost, by the seconds of the policy; empty if they do not."""
        clock = self._link.clock
        limit = clock.patience(GROUND_SECONDS if policy.after is None else policy.after, LEAST_GROUND_SECONDS)
        silent = self._link.stations.silent_for(clock.now() - self._link.silent_for())
        if silent is None or silent <= limit:
            return ""
        return f"nothing heard of {self._link.stations} for {silent:.0f} s"

    def words(self, robot: Robot) -> list[str]:
        """Return what people should know about their stations before the robot moves."""
        policy, stations = policy_for(GROUND_LOST, robot), self._link.stations
        if policy.response != CONTINUE and not stations.systems:
            return [
                f"hears no ground station yet: policy {GROUND_LOST} ({policy.response}) waits for the first"
            ]
        return [SAME_SYSTEM] if GROUND_SYSTEM in stations.systems else []
