"""Whose autopilot a vehicle has, as its heartbeats say."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .link import Link


def is_px4(link: Link) -> bool:
    """Return whether the autopilot is a PX4."""
    beat = link.latest("HEARTBEAT")
    return beat is not None and beat.autopilot == mavlink.MAV_AUTOPILOT_PX4
