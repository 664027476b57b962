"""The names of the metaclasses that this plug-in brings."""

from __future__ import annotations

ROVER_LANGUAGE = "urn:mmrs:rover:1.0"
ROVER = (ROVER_LANGUAGE, "Rover")
TERRAIN = (ROVER_LANGUAGE, "Terrain")
