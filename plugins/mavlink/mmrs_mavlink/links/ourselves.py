"""Who our programs are to vehicles and ground stations."""

from __future__ import annotations

GROUND_SYSTEM = 255
GROUND_COMPONENT = 191
"""An onboard computer's, not a ground station's: autopilots could not tell the two, nor hand theirs on."""
