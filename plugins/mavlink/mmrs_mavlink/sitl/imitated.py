"""What simulated vehicles imitate, and which real flight has confirmed it, for the documentation."""

from __future__ import annotations

COPTER, PX4 = "ArduCopter", "PX4"
UNCONFIRMED = "no"

IMITATED: tuple[tuple[str, str, str], ...] = (
    ("legs", "straight, limited acceleration, no jerk: shorter than real ones, no overshoot", UNCONFIRMED),
    ("corners of missions", "passed at 1.67 m where the waypoint radius is 2 m", COPTER),
    ("set-points of PX4", "at 2 Hz at least", PX4),
    ("take-off and landing", "at once, and down at 1 m/s at least", UNCONFIRMED),
    (
        "uploads",
        "no space just after boot; what the profile keeps of items; fences replaced as a whole",
        COPTER,
    ),
    ("uploads to PX4", "one at a time, lists replaced as a whole", UNCONFIRMED),
    ("missions", "home as item 0; without a take-off never off the ground; photos not reported", COPTER),
    ("arming", "not before a position; refused in AUTO; disarms when idle", COPTER),
    ("reboot in flight", "first heartbeat STABILIZE and disarmed, message rates forgotten", COPTER),
    ("reset of a watchdog in flight", "stays armed, and in the air", UNCONFIRMED),
    ("link lost", "the profile's failsafe after FS_GCS_TIMEOUT; SmartRTL, RTL, LAND, BRAKE", COPTER),
    ("link lost by a rover or a submarine", "the profile's failsafe", UNCONFIRMED),
    (
        "failsafes of PX4",
        "for a lost link by its profile; battery, fence, position; a hold before",
        UNCONFIRMED,
    ),
    ("position lost", "LAND after 1 s (ArduCopter: 3.3 s), or as FS_EKF_ACTION says", UNCONFIRMED),
    ("low battery", "BATT_FS_LOW_ACT and BATT_FS_CRT_ACT, by voltage or charge", COPTER),
    ("fence broken", "polygons, circles, radius and height, once a second; FENCE_ACTION", UNCONFIRMED),
    ("return", "to the nearest of home and rally points, or back along its path", COPTER),
    ("manual control of a submarine", "sticks as speeds; disarms without them", UNCONFIRMED),
    ("wind", "reported, costs energy, carries off a copter without a position", UNCONFIRMED),
    ("battery", "endurance of the robot type; more power at speed; recharges while disarmed", UNCONFIRMED),
    ("signed links, MAVLink 1 ports", "all that is sent", UNCONFIRMED),
)
"""(what, how, on which firmware a real flight has confirmed it)."""


def page_table() -> str:
    """Return the table for the documentation."""
    rows = (f"| {what} | {how} | {flown} |" for what, how, flown in IMITATED)
    return "\n".join(("| what | how | confirmed by a flight |", "|---|---|---|", *rows))
