"""What simulated vehicles imitate, and which real flight has confirmed it, for the documentation."""

from __future__ import annotations

COPTER, ROVER, SUB, PX4 = "ArduCopter", "ArduRover", "ArduSub", "PX4"
UNCONFIRMED = "no"

IMITATED: tuple[tuple[str, str, str], ...] = (
    ("single legs (GUIDED)", "half of the acceleration to brake, overshoot by speed", COPTER),
    ("legs of missions (AUTO)", "S-curves by the profile's jerk, corners within the waypoint radius", COPTER),
    (
        "legs of rovers and submarines",
        "S-curves in all modes; a submarine begins its leg again at each target",
        f"{ROVER}, {SUB}",
    ),
    ("legs of PX4", "figures of the profile, set-points at 2 Hz at least", PX4),
    ("take-off and landing", "spin-up, slow descent below 10 m, disarming after touchdown", COPTER),
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
    ("link or set-points lost by PX4", "the profile's failsafe, without the hold before it", UNCONFIRMED),
    ("position lost", "LAND after 3.3 s, or as FS_EKF_ACTION says", COPTER),
    ("low battery", "BATT_FS_LOW_ACT and BATT_FS_CRT_ACT, by voltage or charge", COPTER),
    ("fence broken", "polygons, circles, radius and height, once a second; FENCE_ACTION", UNCONFIRMED),
    ("return", "to the nearest of home and rally points, or back along its path", COPTER),
    ("manual control of a submarine", "sticks as speeds; disarms without them", UNCONFIRMED),
    ("wind", "reported; moves and costs nothing", UNCONFIRMED),
    (
        "battery",
        "lasts as long as the robot type says, whatever it does; recharges while disarmed",
        UNCONFIRMED,
    ),
    ("signed links, MAVLink 1 ports", "all that is sent", UNCONFIRMED),
)
"""(what, how, on which firmware a real flight has confirmed it)."""


def page_table() -> str:
    """Return the table for the documentation."""
    rows = (f"| {what} | {how} | {flown} |" for what, how, flown in IMITATED)
    return "\n".join(("| what | how | confirmed by a flight |", "|---|---|---|", *rows))
