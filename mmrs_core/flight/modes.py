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

ON_LOST_LINK = "FS_GCS_ENABLE"
ON_ANY_LOSS = "FS_ACTION"

LINK_LOST: Mapping[str, Mapping[str, Mapping[str, int]]] = {
    "copter": {
        "CONTINUE": {ON_LOST_LINK: 0},
        "RETURN": {ON_LOST_LINK: 3},
        "EMERGENCY_AREA": {ON_LOST_LINK: 3},
        "LAND": {ON_LOST_LINK: 5},
        "HOLD": {ON_LOST_LINK: 7},
    },
    "sub": {
        "CONTINUE": {ON_LOST_LINK: 1},
        "STOP_THRUST": {ON_LOST_LINK: 2},
        "HOLD": {ON_LOST_LINK: 3},
        "SURFACE": {ON_LOST_LINK: 4},
        "LAND": {ON_LOST_LINK: 4},
        "RETURN": {ON_LOST_LINK: 4},
    },
    "rover": {
        "CONTINUE": {ON_LOST_LINK: 0},
        "RETURN": {ON_ANY_LOSS: 3, ON_LOST_LINK: 1},
        "EMERGENCY_AREA": {ON_ANY_LOSS: 3, ON_LOST_LINK: 1},
        "HOLD": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
        "LAND": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
        "STOP_THRUST": {ON_ANY_LOSS: 5, ON_LOST_LINK: 1},
    },
}
"""Parameters with which a vehicle responds by itself when it no longer hears the ground.

By kind and by the policy's response, or by what comes nearest to it: a copter returns by the way it
came, and lands where it may not hold for ever; a sub comes up. A rover heeds its action only where
the failsafe of the ground station is switched on, too, which it is not at first.
"""
