"""The names of the metaclasses that this plug-in brings."""

from __future__ import annotations

AUV = "urn:mmrs:auv:1.0"
IN_WATER_SIZE = (AUV, "InWaterSize")
AUV_MOVEMENT = (AUV, "AUVMovement")
THRUSTER = (AUV, "Thruster")
