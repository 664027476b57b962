"""Whose autopilot a vehicle has, as its heartbeats say."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .link import Link

PX4 = 12
"""MAV_AUTOPILOT_PX4."""


def is_px4(link: Link) -> bool:
    """Return whether the autopilot is a PX4."""
    beat = link.latest("HEARTBEAT")
    return beat is not None and beat.autopilot == PX4
