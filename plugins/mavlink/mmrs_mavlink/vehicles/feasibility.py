"""Whether a vehicle that has accepted a mission would fly it, too.

A PX4 accepts what it can store, and looks at it afterwards: at its fence, at the distance to the first
place (MIS_DIST_1WP), at what it wants missions to begin and end with (MIS_TKO_LAND_REQ). What is
not feasible counts as no mission at all (``mavlink_mission.cpp``, ``update_mission_state``; since 1.15),
and it never goes into AUTO with it, which would otherwise be noticed in the air.
"""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from .telemetry import Telemetry

LOOK_SECONDS = 1.0
"""After which it has looked at what came last."""

FEASIBLE_SECONDS = 5.0


def check_feasible(link: Link, telemetry: Telemetry, begun: float) -> None:
    """Make sure that a PX4 would fly the mission that it has; one that does not say is believed.

    Args:
        link: to the vehicle.
        telemetry: of the vehicle.
        begun: second of the run at which the upload was begun.

    Raises:
        RefusedError: it would not.
    """
    looked = link.clock.now() + LOOK_SECONDS
    link.wait(lambda: link.clock.now() >= looked, LOOK_SECONDS)

    def has_one() -> bool:
        current = link.latest("MISSION_CURRENT")
        return current is None or current.mission_state != mavlink.MISSION_STATE_NO_MISSION

    if not link.wait(has_one, link.clock.patience(FEASIBLE_SECONDS), while_received=True):
        warnings = (
            text.text
            for text in telemetry.texts.since(begun)
            if text.severity <= mavlink.MAV_SEVERITY_WARNING
        )
        said = "".join(f"; it says '{text}'" for text in dict.fromkeys(warnings))
        raise RefusedError(f"mission: the vehicle has accepted it, and would not fly it{said}")
