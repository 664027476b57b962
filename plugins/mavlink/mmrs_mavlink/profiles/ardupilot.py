"""ArduPilot: its dialect, and Copter, Sub and Rover.

Of failsafes, only the answers to a lost link and to a broken fence are set, where the robot's policies
define them. All others are the owner's business and only listed, with a warning where the vehicle has no
failsafe, or one would interfere with the program. Meanings are those of ArduCopter 4.5 and later, and of
ArduPilot's Rover and Sub, as their parameter references give them.
"""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_runtime.faults import (
    BATTERY_LOW,
    FENCE_BREACHED,
    LINK_LOST,
    MOTOR_FAILED,
    OBJECT_NOT_FOUND,
    POSITION_LOST,
)

from . import modes
from .autopilot import (
    CAMERA_TRIGGER_DISTANCE,
    LAND,
    LOITER_TIME,
    LOITER_UNLIMITED,
    MISSION,
    RALLY,
    RALLY_POINT,
    RETURN_TO_LAUNCH,
    ROI_LOCATION,
    TAKE_OFF,
    WAYPOINT,
    Autopilot,
    FenceLimit,
    Keeping,
    Missions,
    OwnFence,
    always,
)
from .modes import Mode
from .needs import ON_ARDUPILOT
from .pacing import COPTER, PIVOT_DEGREES, ROVER, SUB
from .profile import Delay, Exemption, LostLinkFailsafe, Safeguard, Timing, VehicleProfile

NO_BATTERY = (0, 10, 11, 12, 18, 24, 27)
"""Monitors of nothing, of the sum of others, and of fuel (``AP_BattMonitor_Params.cpp``)."""

ARDUPILOT = Autopilot(
    "ardupilot",
    "ArduPilot",
    3,
    "mmrs_mavlink.vehicles.guidance:ArduPilotGuidance",
    streamed={"EKF_STATUS_REPORT": 1.0, "FENCE_STATUS": 1.0, "WIND": 1.0},
    missions=Missions(
        starts_itself=("MIS_RESTART", "the vehicle would begin every run with the first item of its mission")
    ),
    keeping=Keeping(
        {
            WAYPOINT: (0,),
            LOITER_UNLIMITED: (2,),
            LOITER_TIME: (0,),
            RETURN_TO_LAUNCH: (),
            LAND: (0,),
            TAKE_OFF: (0,),
            RALLY_POINT: (),
            ROI_LOCATION: (),
            CAMERA_TRIGGER_DISTANCE: (0, 2),
        },
        heights={MISSION: 0.02, RALLY: 1.0},
    ),
    fence=OwnFence(
        (FenceLimit("FENCE_RADIUS", "radius", 2), FenceLimit("FENCE_ALT_MAX", "height", 1)),
        enabled_by="FENCE_ENABLE",
        types="FENCE_TYPE",
        polygons=4,
        rally_limit="RALLY_LIMIT_KM",
        margin="FENCE_MARGIN",
    ),
    avoids="OA_TYPE",
    margins=("AVOID_MARGIN", "OA_MARGIN_MAX"),
    stations=("SYSID_MYGCS", "MAV_GCS_SYSID", "MAV_GCS_SYSID_HI"),
    must_report_checks=always,
    refusals=("prearm:", "arm:"),
    crashed=("crash: disarming",),
    announcements={
        POSITION_LOST: ("ekf failsafe", "gps failsafe"),
        FENCE_BREACHED: ("fence breach",),
        BATTERY_LOW: ("battery failsafe", *(f"battery {number} is" for number in range(1, 10))),
        LINK_LOST: ("gcs failsafe", "heartbeat lost"),
        MOTOR_FAILED: ("potential thrust loss",),
    },
    needs=ON_ARDUPILOT,
    capacities=(
        ("BATT_CAPACITY", "BATT_MONITOR", NO_BATTERY),
        ("BATT2_CAPACITY", "BATT2_MONITOR", NO_BATTERY),
    ),
)
"""What it keeps of items was read in ``AP_Mission.cpp`` (``mavlink_int_to_mission_cmd``,
``mission_cmd_to_mavlink_int``), ``AC_PolyFence_loader.cpp`` and ``AP_Rally.h``: centimetres; of rally
points whole metres only; of waypoints the hold, in whole seconds. Its home is its own: item 0 of missions
is only home. An ArduPilot that is not in AUTO continues from the commanded item to the next one that it flies
to, and reports the number of that one; what stands before it is done when AUTO begins (``AP_Mission.cpp``,
``set_current_cmd``; ``GCS_Common.cpp``, ``MSG_CURRENT_WAYPOINT``). With MIS_RESTART = 1 it begins with the
first item whatever was commanded (``start_or_resume``). It forgets the speed of a mission when AUTO is
entered.
"""

STARTS_IN = 0
"""The mode that Copter and Rover start in by default."""

ON_LOST_LINK, ON_ANY_LOSS = "FS_GCS_ENABLE", "FS_ACTION"
NEAREST = "RALLY_INCL_HOME"
"""Whether home counts as a rally point when a vehicle returns to the nearest of them."""

FARTHEST = "RALLY_LIMIT_KM"
"""Beyond which it goes home instead, where that is nearer; 0: never."""

DELAY = Delay("FS_GCS_TIMEOUT", 2.0, 120.0)
_CENTIMETRES = 100.0
"""And hundredths of degrees."""

_RADII = {"WP_RADIUS_M": 1.0, "WPNAV_RADIUS": _CENTIMETRES}
"""Names of the radius in versions before and since 4.7, with their units in a metre."""

_CLIMBS, _DESCENTS = {"WPNAV_SPEED_UP": _CENTIMETRES}, {"WPNAV_SPEED_DN": _CENTIMETRES}
"""Obeyed at once, in GUIDED and AUTO (``AC_WPNav::update_wpnav``); an ArduSub obeys no other."""

"""Obeyed in GUIDED and AUTO (``AC_AttitudeControl::get_slew_yaw_max_degs``)."""

NOTHING = "no failsafe set"
_LANDING = {1: "return, or land", 2: "land", 3: "SmartRTL, else RTL, else land"}

COPTER_SAFEGUARDS = (
    Safeguard(
        "FS_GCS_ENABLE",
        "no heartbeats from the ground",
        {0: "nothing", 1: "return", 2: "continue a mission, else RTL", 5: "land", 7: "brake, or land"}
        | {3: "SmartRTL, else RTL", 4: "SmartRTL, else land"},
    ),
    Safeguard(
        "FS_THR_ENABLE",
        "no signal from the pilot's remote control",
        {0: "nothing", 1: "return", 2: "continue a mission, else RTL", 3: "land"}
        | {4: "SmartRTL, else RTL", 5: "SmartRTL, else land", 6: "mission's landing"},
        {0: "a pilot whose remote control fails can not take over, and nothing happens"},
    ),
    Safeguard(
        "BATT_FS_LOW_ACT",
        "battery low",
        {0: "nothing", 1: "land", 2: "return", 3: "SmartRTL, else RTL"}
        | {4: "SmartRTL, else land", 5: "stop the motors", 6: "mission's landing"},
        {0: NOTHING, 5: "it falls"},
    ),
    Safeguard(
        "BATT_FS_CRT_ACT",
        "battery critical",
        {0: "nothing", 1: "land", 2: "return", 5: "stop the motors"},
        {0: NOTHING, 5: "it falls"},
    ),
    Safeguard("FENCE_ENABLE", "the fence", {0: "off", 1: "on"}),
    Safeguard(
        "FENCE_ACTION",
        "fence broken",
        {0: "say so only", 4: "brake, or land", 5: "SmartRTL, else land"} | _LANDING,
        {0: "nothing stops it"},
    ),
    Safeguard(
        "FS_EKF_ACTION",
        "position lost",
        {0: "say so only", 1: "land, or hold its height", 2: "hold its height", 3: "land"},
        {0: "it flies on without a position", 2: "the wind carries it until its program lands it"},
    ),
    Safeguard("RTL_ALT", "height at which it returns", unit=" cm"),
    Safeguard("RTL_ALT_M", "height at which it returns", unit=" m"),
    Safeguard("AUTO_OPTIONS", "options of missions"),
    Safeguard(
        "DISARM_DELAY",
        "seconds on the ground until it disarms",
        below=(5.0, "it may disarm before its take-off command"),
        unit=" s",
    ),
    Safeguard("FLTMODE_GCSBLOCK", "modes that the ground must not choose"),
)

ROVER_SAFEGUARDS = (
    Safeguard("FS_GCS_ENABLE", "no heartbeats from the ground", {0: "nothing", 1: "as FS_ACTION says"}),
    Safeguard("FS_ACTION", "link lost", {0: "nothing", 1: "return", 2: "hold", 3: "SmartRTL", 5: "disarm"}),
    Safeguard("FS_THR_ENABLE", "no signal from the pilot's remote control", {0: "nothing"}, {0: NOTHING}),
    Safeguard("BATT_FS_LOW_ACT", "battery low", {0: "nothing", 1: "return", 2: "hold"}, {0: NOTHING}),
    Safeguard("FENCE_ENABLE", "the fence", {0: "off", 1: "on"}),
    Safeguard("FENCE_ACTION", "fence broken", {0: "say so only", 1: "return", 2: "hold"}, {0: NOTHING}),
    Safeguard("FS_EKF_ACTION", "position lost", {0: "nothing", 1: "hold", 2: "say so only"}, {0: NOTHING}),
)

SUB_SAFEGUARDS = (
    Safeguard(
        "FS_GCS_ENABLE",
        "no heartbeats from the ground",
        {0: "nothing", 1: "warn", 2: "disarm", 3: "hold its depth", 4: "surface"},
        {2: "its motors stop wherever it is"},
    ),
    Safeguard(
        "FS_PILOT_INPUT",
        "a pilot's sticks, once used, fall silent",
        {0: "nothing", 1: "warn", 2: "disarm"},
        {2: "its motors stop in every mode where a joystick that was in use since it was switched on does"},
    ),
    Safeguard("BATT_FS_LOW_ACT", "battery low", {0: "nothing", 2: "disarm", 3: "surface"}, {0: NOTHING}),
    Safeguard("FS_LEAK_ENABLE", "water inside", {0: "nothing", 1: "warn", 2: "surface"}, {0: NOTHING}),
    Safeguard("FS_EKF_ACTION", "position lost", {0: "nothing", 1: "warn", 2: "disarm"}),
)


def _modes(numbers: Mapping[str, int]) -> Mapping[str, Mode]:
    return {name: Mode(number, (1.0, float(number))) for name, number in numbers.items()}


_RETURNS = frozenset({6, 9, 17, 21})
ARDUCOPTER = VehicleProfile(
    "arducopter",
    "copter",
    ARDUPILOT,
    (2, 3, 4, 13, 14, 15, 29, 35),
    _modes({modes.GUIDED: 4, modes.AUTO: 3, modes.HOLD: 17, modes.LAND: 9}),
    {0: "stabilize", 1: "acro", 2: "altitude hold", 5: "loiter", 6: "return"}
    | {16: "position hold", 21: "smart return"},
    failsafe_modes=frozenset({2, 6, 9, 17, 21}),
    own_modes=frozenset({STARTS_IN}),
    lost_link=LostLinkFailsafe(
        {
            "CONTINUE": {ON_LOST_LINK: 0},
            "RETURN": {ON_LOST_LINK: 3},
            "EMERGENCY_AREA": {NEAREST: 0, FARTHEST: 0, ON_LOST_LINK: 1},
            "LAND": {ON_LOST_LINK: 5},
            "HOLD": {ON_LOST_LINK: 7},
        },
        {
            ON_LOST_LINK: {
                1: frozenset({6, 9}),
                2: frozenset({3, 6, 9}),
                3: frozenset({6, 9, 21}),
                4: frozenset({9, 21}),
                5: frozenset({9}),
                6: frozenset({3, 6, 9}),
                7: frozenset({9, 17}),
            }
        },
        enabled_by=ON_LOST_LINK,
        delay=DELAY,
        exemption=Exemption("FS_OPTIONS", 2, "missions"),
    ),
    responses=frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "LAND", "HOLD"}),
    event_modes={
        POSITION_LOST: frozenset({9}),
        FENCE_BREACHED: _RETURNS,
        BATTERY_LOW: _RETURNS,
        LINK_LOST: _RETURNS,
    },
    named_modes={"althold": 2, "altitudehold": 2},
    breach={
        "CONTINUE": {"FENCE_ACTION": 0},
        "RETURN": {"FENCE_ACTION": 3},
        "EMERGENCY_AREA": {"FENCE_ACTION": 3},
        "LAND": {"FENCE_ACTION": 2},
        "HOLD": {"FENCE_ACTION": 4},
    },
    safeguards=COPTER_SAFEGUARDS,
    rehearsed_as="copter",
    flies=True,
    radii=_RADII,
    climbs=_CLIMBS,
    descents=_DESCENTS,
    yaw_rates={"ATC_SLEW_YAW": _CENTIMETRES},
    corridor=8.0,
    down="LAND",
    rests={"LAND": modes.LAND, "SURFACE": modes.HOLD},
    without_position="LAND",
    starts_in=STARTS_IN,
    pacing=COPTER,
)
"""It retraces its path, or flies to the nearest rally point, and lands where it may not hold without limit;
it cannot surface. The exemption is ``GCS_CONTINUE_IF_AUTO``: missions continue, whatever FS_GCS_ENABLE is.

A pilot who takes over because of an event chooses another mode than its failsafe: the event alone is not a
reason to bring the vehicle back. Modes that a pilot may choose as well, such as to hold the height without
a position, are left out: there the vehicle must have named the mode (``EKF Failsafe: changed to ALT_HOLD
Mode``, ``ekf_check.cpp``, with FS_EKF_ACTION = 2).
"""

ARDUSUB = VehicleProfile(
    "ardusub",
    "sub",
    ARDUPILOT,
    (12,),
    _modes({modes.GUIDED: 4, modes.AUTO: 3, modes.HOLD: 16, modes.SURFACE: 9}),
    {0: "stabilize", 1: "acro", 2: "depth hold", 19: "manual"},
    failsafe_modes=frozenset({9, 16, 19}),
    lost_link=LostLinkFailsafe(
        {
            "CONTINUE": {ON_LOST_LINK: 1},
            "STOP_THRUST": {ON_LOST_LINK: 2},
            "HOLD": {ON_LOST_LINK: 3},
            "SURFACE": {ON_LOST_LINK: 4},
            "LAND": {ON_LOST_LINK: 4},
            "RETURN": {ON_LOST_LINK: 4},
        },
        {ON_LOST_LINK: {3: frozenset({2}), 4: frozenset({9})}},
        enabled_by=ON_LOST_LINK,
        delay=DELAY,
    ),
    responses=frozenset({"CONTINUE", "STOP_THRUST", "HOLD", "SURFACE", "LAND", "RETURN", "EMERGENCY_AREA"}),
    event_modes={event: frozenset({9}) for event in (POSITION_LOST, BATTERY_LOW, LINK_LOST)},
    safeguards=SUB_SAFEGUARDS,
    rehearsed_as="sub",
    dives=True,
    heads_apart=True,
    turns_as_places=True,
    timing=Timing(resend=2.0),
    radii=_RADII,
    climbs=_CLIMBS,
    descents=_DESCENTS,
    highest_item=-0.01,
    watches_jumps=False,
    down="SURFACE",
    rests={"LAND": modes.SURFACE, "SURFACE": modes.SURFACE},
    usual_responses={OBJECT_NOT_FOUND: "SURFACE"},
    starts_in=19,
    pacing=SUB,
)
"""It starts in MANUAL, and surfaces instead of returning. In a mission it checks the height of whatever
item it begins (``Sub::start_command``), be it a place or not: a CONDITION_YAW is skipped with "Bad alt
frame", or ends its own simulation, unless the flags of a place that its first byte then holds say "above
home". It ignores the heading of a SET_POSITION_TARGET_GLOBAL_INT, and turns by CONDITION_YAW
(``GCS_MAVLink_Sub.cpp``). With each target that it receives it plans its path from rest: it is judged less
often than others whether it has received one. It takes its home to be at the surface, wherever it is
armed, and skips what is above that. A height of exactly 0 is to it the one that it is at: so an item at
the surface is a bit below it, by the least that ArduSub distinguishes, as it counts in centimetres.
"""

_STOPS = frozenset({4, 11, 12})
ARDUROVER = VehicleProfile(
    "ardurover",
    "rover",
    ARDUPILOT,
    (10, 11),
    _modes({modes.GUIDED: 15, modes.AUTO: 10, modes.HOLD: 4}),
    {
        0: "manual",
        1: "acro",
        3: "steering",
        5: "loiter",
        11: "return",
        12: "smart return",
        16: "initialising",
    },
    failsafe_modes=_STOPS,
    own_modes=frozenset({STARTS_IN, 16}),
    lost_link=LostLinkFailsafe(
        {
            "CONTINUE": {ON_LOST_LINK: 0},
            "RETURN": {ON_ANY_LOSS: 3, ON_LOST_LINK: 1},
            "EMERGENCY_AREA": {NEAREST: 0, FARTHEST: 0, ON_ANY_LOSS: 1, ON_LOST_LINK: 1},
            "HOLD": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
            "LAND": {ON_ANY_LOSS: 2, ON_LOST_LINK: 1},
            "STOP_THRUST": {ON_ANY_LOSS: 5, ON_LOST_LINK: 1},
        },
        {
            ON_ANY_LOSS: {
                1: frozenset({4, 11}),
                2: frozenset({4}),
                3: frozenset({4, 11, 12}),
                4: frozenset({4, 12}),
                6: frozenset({4, 5}),
            }
        },
        enabled_by=ON_LOST_LINK,
        delay=DELAY,
    ),
    responses=frozenset({"CONTINUE", "RETURN", "EMERGENCY_AREA", "HOLD", "LAND", "STOP_THRUST"}),
    event_modes={event: _STOPS for event in (FENCE_BREACHED, BATTERY_LOW, LINK_LOST)}
    | {POSITION_LOST: frozenset({4})},
    breach={
        "CONTINUE": {"FENCE_ACTION": 0},
        "RETURN": {"FENCE_ACTION": 3},
        "EMERGENCY_AREA": {"FENCE_ACTION": 3},
        "HOLD": {"FENCE_ACTION": 2},
        "LAND": {"FENCE_ACTION": 2},
    },
    safeguards=ROVER_SAFEGUARDS,
    carries=("ground",),
    rehearsed_as="rover",
    turns=False,
    pacing=ROVER,
    in_plane=True,
    stops_early=True,
    radii={"WP_RADIUS": 1.0},
    pivots={"WP_PIVOT_ANGLE": PIVOT_DEGREES},
    starts_in=STARTS_IN,
)
"""It obeys its action only where the failsafe of the ground station is enabled, too, which it is not by
default. It halts where nothing else can be carried out.
"""
