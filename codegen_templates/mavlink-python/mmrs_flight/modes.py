"""Flight modes by kind of vehicle, as ArduPilot numbers them, and its answers to a lost link."""

from __future__ import annotations

from collections.abc import Mapping

GUIDED = "guided"
AUTO = "auto"
HOLD = "hold"
LAND = "land"
SURFACE = "surface"

MODES: Mapping[str, Mapping[str, int]] = {
    "copter": {GUIDED: 4, AUTO: 3, HOLD: 17, LAND: 9},
    "sub": {GUIDED: 4, AUTO: 3, HOLD: 16, SURFACE: 9},
    "rover": {GUIDED: 15, AUTO: 10, HOLD: 4},
}

LINK_LOST_PARAMETER: Mapping[str, str] = {
    "copter": "FS_GCS_ENABLE",
    "sub": "FS_GCS_ENABLE",
    "rover": "FS_ACTION",
}

LINK_LOST_VALUE: Mapping[str, Mapping[str, int]] = {
    "copter": {"CONTINUE": 0, "RETURN": 3, "EMERGENCY_AREA": 3, "LAND": 5, "HOLD": 7},
    "sub": {"CONTINUE": 1, "STOP_THRUST": 2, "HOLD": 3, "SURFACE": 4, "LAND": 4, "RETURN": 4},
    "rover": {"CONTINUE": 0, "RETURN": 3, "EMERGENCY_AREA": 3, "HOLD": 2, "LAND": 2, "STOP_THRUST": 5},
}
"""What the vehicle does by itself when it no longer hears the ground, by the policy's response.

A copter returns by the way it came, or lands where it may not hold for ever.
"""
