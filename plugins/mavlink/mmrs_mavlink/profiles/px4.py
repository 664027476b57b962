"""PX4: its dialect, and its multicopter, rover and underwater vehicle.

Written from its documents and source, 1.14 and later. The multicopter has flown 1.16.0-beta1 in its own
simulation (SIH): single legs, missions, two sorties, lost thrust.
"""

from __future__ import annotations

from dataclasses import replace

from mmrs_runtime.faults import BATTERY_LOW, FENCE_BREACHED, LINK_LOST, MOTOR_FAILED, POSITION_LOST

from . import modes
from .ardupilot import ARDUCOPTER, ARDUROVER, ARDUSUB, NOTHING
from .autopilot import (
    MISSION,
    RALLY,
    RALLY_POINT,
    ROI_LOCATION,
    Autopilot,
    FenceLimit,
    Keeping,
    Missions,
    OwnFence,
)
from .modes import Mode
from .needs import ON_PX4
from .pacing import PX4_COPTER
from .profile import Answers, Delay, Exemption, LostLinkFailsafe, Safeguard, VehicleProfile


def px4_number(main: int, sub: int) -> int:
    """Return a PX4 mode as its heartbeat encodes it: the sub-mode above the main mode above 16 bits."""
    return sub << 24 | main << 16


HOLDS, RETURNS, LANDS, TAKES_OFF = px4_number(4, 3), px4_number(4, 5), px4_number(4, 6), px4_number(4, 2)
_MODES = {modes.GUIDED: (6, 0), modes.AUTO: (4, 4), modes.HOLD: (4, 3), modes.LAND: (4, 6)}
MODES = {
    name: Mode(px4_number(main, sub), (1.0, float(main), float(sub))) for name, (main, sub) in _MODES.items()
}
"""Main mode and sub-mode (``px4_custom_mode.h``): OFFBOARD, and of AUTO mission, loiter, land."""

OTHER_MODES = {
    px4_number(1, 0): "manual",
    px4_number(2, 0): "altitude",
    px4_number(3, 0): "position",
    TAKES_OFF: "take-off",
    RETURNS: "return",
    px4_number(5, 0): "acro",
    px4_number(7, 0): "stabilize",
}
OWN_MODES = frozenset(px4_number(main, sub) for main in (4, 6) for sub in range(256))
"""AUTO and OFFBOARD: those of a PX4 that flies autonomously, or under a program."""


def _is_to_be_armed_in(armed: bool, mode: int) -> bool:
    """Return whether a PX4 is in the mode that it is to be armed in, and is not yet.

    It reports whether it may be armed in its present mode (``SYS_STATUS.hpp``), since 1.14 without
    announcing that it has such a check: that counts in the mode that it is to be armed in.
    """
    return not armed and mode == HOLDS


ON_SILENCE, ON_STILLNESS = "NAV_DLL_ACT", "COM_OBL_RC_ACT"
"""Its failsafe for a lost ground station, and, in OFFBOARD, for missing set-points."""

RETURNS_TO = "RTL_TYPE"
"""Whether it returns to home or a rally point (0 at first), or to a rally point rather than home (1)."""

PX4 = Autopilot(
    "px4",
    "PX4",
    12,
    "mmrs_mavlink.vehicles.px4:Px4Guidance",
    streams=True,
    restores_mode=True,
    streamed={"ESTIMATOR_STATUS": 1.0, "WIND_COV": 1.0},
    integers=frozenset(
        {
            ON_SILENCE,
            ON_STILLNESS,
            RETURNS_TO,
            "GF_ACTION",
            "COM_DL_LOSS_T",
            "COM_TAKEOFF_ACT",
            "COM_DLL_EXCEPT",
        }
    ),
    copies_bytes=True,
    missions=Missions(
        begins_with_home=False,
        commands=frozenset(
            {
                *(16, 17, 19, 20, 21, 22, 31, 84, 85, 93),
                *(112, 114, 177, 178, 179, 187, 189, 195, 196, 197),
                *(200, 201, 203, 204, 205, 206, 211, 214, 260),
                *(530, 532, 1000, 1001, 2000, 2001, 2003, 2500, 2501, 3000, 42600),
            }
        ),
        whole_seconds=False,
        zero_counts=True,
        turns=False,
        judged=True,
        gimbal_looks="MIS_MNT_YAW_CTL",
        keeps_speed=True,
        starts_itself=(
            "COM_TAKEOFF_ACT",
            "the vehicle would begin its mission without a command after take-off",
        ),
    ),
    keeping=Keeping({RALLY_POINT: (), ROI_LOCATION: ()}, heights={MISSION: 0.01, RALLY: 0.01}, wraps=True),
    fence=OwnFence((FenceLimit("GF_MAX_HOR_DIST", "radius"), FenceLimit("GF_MAX_VER_DIST", "height"))),
    avoids="COM_OBS_AVOID",
    counts_any_station=True,
    must_report_checks=_is_to_be_armed_in,
    refusals=("preflight fail", "arming denied", "takeoff denied"),
    announcements={
        POSITION_LOST: ("position lost", "no valid position", "no position"),
        FENCE_BREACHED: ("geofence",),
        BATTERY_LOW: ("low battery", "critical battery", "battery level"),
        LINK_LOST: (
            "gcs connection lost",
            "gcs connection regained",
            "connection to ground station lost",
            "data link lost",
        ),
        MOTOR_FAILED: ("attitude failure", "motor failure"),
    },
    needs=ON_PX4,
    capacities=(("BAT1_CAPACITY", "BAT1_SOURCE", (-1,)), ("BAT2_CAPACITY", "BAT2_SOURCE", (-1,))),
)
"""It takes the commands of ``mavlink_mission.cpp`` (``parse_mavlink_mission_item``), and refuses a mission
with any other; what it keeps of them was read there too: numbers of single precision, headings between -180
and 180 degrees. It cannot be armed in the modes that land or return, so that it leaves them as it disarms
(``UserModeIntention.cpp``). It reports the commanded item (``mission.cpp``, ``set_current_mission_index``);
with COM_TAKEOFF_ACT = 1 it begins its mission as soon as it has taken off (``Commander.cpp``,
``checkForMissionUpdate``), of whichever run. A run restores the speed that was last set before its item, of
whichever run (``mission_base.cpp``, ``on_activation``). A radius of 0 is NAV_ACC_RAD, which is 10 m at
first.
"""

_ACTIONS = {0: "nothing", 1: "hold", 2: "return", 3: "land", 5: "terminate", 6: "stop the motors"}
SAFEGUARDS = (
    Safeguard("NAV_DLL_ACT", "no heartbeats from the ground", _ACTIONS, {5: "it falls", 6: "it falls"}),
    Safeguard("COM_DL_LOSS_T", "seconds until the ground counts as lost", unit=" s"),
    Safeguard(
        "NAV_RCL_ACT",
        "no signal from the pilot's remote control",
        {1: "hold", 2: "return", 3: "land", 5: "terminate", 6: "stop the motors"},
    ),
    Safeguard(
        "COM_LOW_BAT_ACT",
        "battery low",
        {0: "warn", 2: "land when critical", 3: "return when critical, land in an emergency"},
        {0: NOTHING},
    ),
    Safeguard(
        "GF_ACTION",
        "fence broken",
        {0: "nothing", 1: "warn", 2: "hold", 3: "return", 4: "terminate", 5: "land"},
        {0: "nothing stops it", 1: "nothing stops it", 4: "it falls"},
    ),
    Safeguard(
        "COM_OBL_RC_ACT",
        "set-points end",
        {0: "hold by hand", 1: "by hand", 2: "by hand", 3: "return", 4: "land", 5: "hold"}
        | {6: "terminate", 7: "stop the motors"},
        {6: "it falls", 7: "it falls"},
    ),
    Safeguard(
        "COM_DISARM_LAND",
        "seconds after landing until it disarms",
        below=(0.1, "it never does, and its landing is taken for one that does not end"),
        unit=" s",
    ),
    Safeguard(
        "MAV_FWDEXTSP",
        "set-points from outside",
        {0: "passed over", 1: "heeded"},
        {0: "it goes into no OFFBOARD, in which it is steered"},
    ),
    Safeguard("COM_OF_LOSS_T", "seconds until set-points count as ended", unit=" s"),
    Safeguard("COM_FAIL_ACT_T", "seconds that it holds before its failsafe returns or lands", unit=" s"),
    Safeguard("COM_POS_FS_DELAY", "seconds until a lost position counts", unit=" s"),
    Safeguard("RTL_RETURN_ALT", "height at which it returns", unit=" m"),
    Safeguard(
        "COM_DISARM_PRFLT",
        "seconds on the ground until it disarms",
        below=(5.0, "it may disarm before its take-off command"),
        unit=" s",
    ),
)

LOST_LINK = LostLinkFailsafe(
    {
        "CONTINUE": {ON_STILLNESS: 5, ON_SILENCE: 0},
        "HOLD": {ON_STILLNESS: 5, ON_SILENCE: 1},
        "RETURN": {ON_STILLNESS: 3, ON_SILENCE: 2},
        "EMERGENCY_AREA": {RETURNS_TO: 1, ON_STILLNESS: 3, ON_SILENCE: 2},
        "LAND": {ON_STILLNESS: 4, ON_SILENCE: 3},
        "STOP_THRUST": {ON_STILLNESS: 7, ON_SILENCE: 6},
    },
    {
        ON_SILENCE: {
            1: frozenset({HOLDS}),
            2: frozenset({HOLDS, RETURNS, LANDS}),
            3: frozenset({HOLDS, LANDS}),
        },
        ON_STILLNESS: {3: frozenset({RETURNS, LANDS}), 4: frozenset({LANDS}), 5: frozenset({HOLDS})},
    },
    delay=Delay("COM_DL_LOSS_T", 5.0, 300.0),
    set_point_delay=Delay("COM_OF_LOSS_T", 5.0, 60.0, usual=5.0),
    exemption=Exemption("COM_DLL_EXCEPT", 0b111, "the modes of its program"),
)
"""A PX4 in OFFBOARD misses set-points before it misses heartbeats, and then acts by their failsafe: by
default, it gives control to the pilot. It cannot continue without set-points: where it is to, it holds. It
misses them after one second at first, in which poor links and busy computers lose some now and then; until
then it goes to the last one, and stays there. Before it returns or lands for a lost station it holds for
COM_FAIL_ACT_T, five seconds by default (``failsafe/framework.cpp``, ``getSelectedAction``); for missing
set-points it does so at once. The bits of the exemption are missions, its other own modes, OFFBOARD.
"""

BREACH: Answers = {
    "CONTINUE": {"GF_ACTION": 1},
    "HOLD": {"GF_ACTION": 2},
    "RETURN": {"GF_ACTION": 3},
    "EMERGENCY_AREA": {RETURNS_TO: 1, "GF_ACTION": 3},
    "LAND": {"GF_ACTION": 5},
}


def _on_px4(name: str, profile: VehicleProfile) -> VehicleProfile:
    """Return the profile of the same class of vehicle with a PX4."""
    return replace(
        profile,
        name=name,
        autopilot=PX4,
        modes=MODES,
        other_modes=OTHER_MODES,
        failsafe_modes=frozenset({HOLDS, RETURNS, LANDS}),
        own_modes=OWN_MODES,
        lost_link=LOST_LINK,
        event_modes=None,
        named_modes={},
        heads_apart=False,
        breach=BREACH,
        safeguards=SAFEGUARDS,
        radii={"NAV_ACC_RAD": 1.0},
        fastest={"MPC_XY_VEL_MAX": 1.0},
        climbs={"MPC_Z_V_AUTO_UP": 1.0},
        descents={"MPC_Z_V_AUTO_DN": 1.0},
        yaw_rates={"MPC_YAWRAUTO_MAX": 1.0},
    )


PX4_MULTICOPTER = replace(_on_px4("px4-multicopter", ARDUCOPTER), rehearsed_with=PX4.name, pacing=PX4_COPTER)
PX4_ROVER = _on_px4("px4-rover", ARDUROVER)
PX4_SUB = _on_px4("px4-sub", ARDUSUB)
