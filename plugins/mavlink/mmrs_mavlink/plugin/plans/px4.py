"""What missions of a PX4 may hold."""

from __future__ import annotations

from mmrs_mavlink.wiring import Wired

KNOWN = frozenset(
    {
        *(16, 17, 19, 20, 21, 22, 31, 84, 85, 93),
        *(112, 114, 177, 178, 179, 187, 189, 195, 196, 197),
        *(200, 201, 203, 204, 205, 206, 211, 214, 260),
        *(530, 532, 1000, 1001, 2000, 2001, 2003, 2500, 2501, 3000, 42600),
    }
)
"""Numbers of commands that a PX4 takes as items of missions, by its source
(``mavlink_mission.cpp``, ``parse_mavlink_mission_item``); it refuses a mission with any other."""


def unknown_in(wiring: Wired) -> tuple[int, ...]:
    """Return the commands of a device action that no mission of a PX4 may hold."""
    commands = (wiring.command, *(command for command, _ in wiring.more))
    return tuple(command for command in commands if command not in KNOWN)
