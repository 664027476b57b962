"""What the vehicle tells about itself, as messages."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from math import atan2, degrees, hypot, radians
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.camera import Photo
from mmrs_mavlink.sitl.commands import complaint
from mmrs_mavlink.sitl.items import MISSION
from mmrs_mavlink.sitl.px4_missions import is_feasible
from mmrs_mavlink.sitl.settings import PX4, Settings

Message = Any
Teller = Callable[[Autopilot], Message]

TYPES = {
    "copter": int(mavlink.MAV_TYPE_QUADROTOR),
    "sub": int(mavlink.MAV_TYPE_SUBMARINE),
    "rover": int(mavlink.MAV_TYPE_GROUND_ROVER),
}
EKF_LOCATED, EKF_LOST = 0x33F, 0xA7
ESTIMATOR_LOCATED = 0x33F
STEERED = frozenset({"guided", "auto", "return", "smart_return"})
"""Modes in which it tells the place that it steers to."""

TARGET_MASK = 0xDF8
"""Only the position counts."""

SECTOR_FREE = 6_001
UNKNOWN = 65_535

GYRO, ACCELEROMETER, COMPASS, PRESSURE, GPS = 0x01, 0x02, 0x04, 0x08, 0x20
FENCE_BIT, BATTERY, PREARM = 0x0010_0000, 0x0200_0000, 0x1000_0000
SENSORS = GYRO | ACCELEROMETER | COMPASS | PRESSURE | GPS
CAPABILITIES = (
    mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
    | mavlink.MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
)


def heartbeat(pilot: Autopilot) -> Message:
    """Return kind, mode, and whether it is armed."""
    px4 = pilot.settings.firmware == PX4
    armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED if pilot.armed else 0
    active = mavlink.MAV_STATE_ACTIVE if pilot.failsafe is None else mavlink.MAV_STATE_CRITICAL
    return mavlink.MAVLink_heartbeat_message(
        TYPES[pilot.settings.kind],
        mavlink.MAV_AUTOPILOT_PX4 if px4 else mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
        mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | armed,
        pilot.mode,
        active if pilot.armed else mavlink.MAV_STATE_STANDBY,
        3,
    )


def milliseconds(pilot: Autopilot) -> int:
    """Return the milliseconds since it booted."""
    return int(round(pilot.uptime * 1000) % 2**32)


def global_position(pilot: Autopilot) -> Message | None:
    """Return where it is on Earth; until it knows, ArduPilot tells 0 degrees of both, and PX4 nothing."""
    latitude, longitude = pilot.degrees()
    if pilot.uptime < pilot.settings.ready:
        if pilot.settings.firmware == PX4:
            return None
        latitude = longitude = 0.0
    up = pilot.settings.altitude + pilot.body.position[2]
    north, east, climb = pilot.body.motion
    return mavlink.MAVLink_global_position_int_message(
        milliseconds(pilot),
        round(latitude * 1e7),
        round(longitude * 1e7),
        round(up * 1000),
        round((up - pilot.home[2]) * 1000),
        round(north * 100),
        round(east * 100),
        round(-climb * 100),
        round(pilot.body.heading * 100) % 36_000,
    )


def local_position(pilot: Autopilot) -> Message | None:
    """Return where it is from where it was switched on; None until it knows."""
    if pilot.uptime < pilot.settings.ready:
        return None
    north, east, up = pilot.body.position
    v_north, v_east, v_up = pilot.body.motion
    now = milliseconds(pilot)
    return mavlink.MAVLink_local_position_ned_message(now, north, east, -up, v_north, v_east, -v_up)


def global_target(pilot: Autopilot) -> Message | None:
    """Return the place on Earth that it steers to; None where it steers to none.

    A PX4 tells that of its own modes only, and nothing in OFFBOARD (``POSITION_TARGET_GLOBAL_INT.hpp``).
    """
    target = pilot.body.target
    offboard = pilot.settings.firmware == PX4 and pilot.mode_name == "guided"
    if target is None or offboard or pilot.mode_name not in STEERED:
        return None
    latitude, longitude = pilot.degrees_at(target)
    return mavlink.MAVLink_position_target_global_int_message(
        milliseconds(pilot),
        mavlink.MAV_FRAME_GLOBAL,
        TARGET_MASK,
        round(latitude * 1e7),
        round(longitude * 1e7),
        pilot.settings.altitude + target[2],
        *[0.0] * 8,
    )


def local_target(pilot: Autopilot) -> Message | None:
    """Return the place that it steers to, from where it was switched on; None where it steers to none."""
    target = pilot.body.target
    if target is None or pilot.mode_name not in STEERED:
        return None
    north, east, up = target
    return mavlink.MAVLink_position_target_local_ned_message(
        milliseconds(pilot), mavlink.MAV_FRAME_LOCAL_NED, TARGET_MASK, north, east, -up, *[0.0] * 8
    )


def attitude(pilot: Autopilot) -> Message:
    """Return its heading; it never leans."""
    yaw = radians((pilot.body.heading + 180.0) % 360.0 - 180.0)
    return mavlink.MAVLink_attitude_message(milliseconds(pilot), 0.0, 0.0, yaw, 0.0, 0.0, 0.0)


def hud(pilot: Autopilot) -> Message:
    """Return speeds in the air and over ground."""
    body = pilot.body
    return mavlink.MAVLink_vfr_hud_message(
        body.air_pace,
        hypot(*body.motion[:2]),
        round(body.heading) % 360,
        50 if pilot.armed else 0,
        pilot.settings.altitude + body.position[2],
        body.velocity[2],
    )


def mission_current(pilot: Autopilot) -> Message:
    """Return the item that it is at, or flies to."""
    total = max(0, len(pilot.stores[MISSION]) - pilot.first_item)
    has_one = is_feasible(pilot) if pilot.settings.firmware == PX4 else bool(total)
    state = 4 if pilot.finished else 3 if pilot.mode_name == "auto" else 2
    return mavlink.MAVLink_mission_current_message(pilot.told_item, total, state if has_one else 1)


def status(pilot: Autopilot) -> Message:
    """Return the health of what it is made of, and its battery."""
    health = SENSORS if pilot.located else SENSORS & ~GPS
    health |= BATTERY | (0 if pilot.breached else FENCE_BIT)
    health |= 0 if complaint(pilot) else PREARM
    present = SENSORS | BATTERY | FENCE_BIT | (0 if pilot.settings.firmware == PX4 else PREARM)
    tells = pilot.settings.tells_battery
    return mavlink.MAVLink_sys_status_message(
        present,
        present,
        health,
        0,
        round(pilot.battery.voltage * 1000) if tells else UNKNOWN,
        round(pilot.battery.current * 100) if tells else -1,
        round(pilot.energy * 100) if tells and pilot.energy >= 0.0 else -1,
        0,
        0,
        0,
        0,
        0,
        0,
    )


def battery_status(pilot: Autopilot) -> Message | None:
    """Return what the battery has given; None where nobody measures it."""
    if not pilot.settings.tells_battery:
        return None
    volts = [round(pilot.battery.voltage * 1000), *[UNKNOWN] * 9]
    return mavlink.MAVLink_battery_status_message(
        0,
        0,
        mavlink.MAV_BATTERY_TYPE_LIPO,
        32_767,
        volts,
        round(pilot.battery.current * 100),
        round(pilot.battery.used),
        -1,
        round(pilot.energy * 100),
    )


def landed(pilot: Autopilot) -> Message:
    """Return whether it stands on the ground, of which ArduSub and Rover say nothing."""
    state = mavlink.MAV_LANDED_STATE_IN_AIR if pilot.airborne else mavlink.MAV_LANDED_STATE_ON_GROUND
    if not pilot.flies:
        state = mavlink.MAV_LANDED_STATE_UNDEFINED
    return mavlink.MAVLink_extended_sys_state_message(0, state)


def estimate(pilot: Autopilot) -> Message:
    """Return what its estimate of itself is good for."""
    located = pilot.located and pilot.uptime >= pilot.settings.ready
    if pilot.settings.firmware == PX4:
        flags = ESTIMATOR_LOCATED if located else EKF_LOST
        return mavlink.MAVLink_estimator_status_message(
            milliseconds(pilot) * 1000, flags, 0, 0, 0, 0, 0, 0, 0, 0
        )
    return mavlink.MAVLink_ekf_status_report_message(EKF_LOCATED if located else EKF_LOST, 0, 0, 0, 0, 0)


def satellites(pilot: Autopilot) -> Message:
    """Return what the GPS receiver says."""
    located = pilot.located and pilot.uptime >= pilot.settings.ready
    latitude, longitude = pilot.degrees()
    return mavlink.MAVLink_gps_raw_int_message(
        milliseconds(pilot) * 1000,
        mavlink.GPS_FIX_TYPE_3D_FIX if located else mavlink.GPS_FIX_TYPE_NO_FIX,
        round(latitude * 1e7),
        round(longitude * 1e7),
        round((pilot.settings.altitude + pilot.body.position[2]) * 1000),
        80 if located else 9_999,
        UNKNOWN,
        round(hypot(*pilot.body.motion[:2]) * 100),
        UNKNOWN,
        14 if located else 0,
    )


def clocks(pilot: Autopilot) -> Message:
    """Return the time of day and the time since it booted."""
    return mavlink.MAVLink_system_time_message(
        round((time.time() + pilot.clock_error) * 1e6), milliseconds(pilot)
    )


def fence_status(pilot: Autopilot) -> Message | None:
    """Return whether it is out of its fence; None where it heeds none."""
    if not pilot.breached and not pilot.parameters.get("FENCE_ENABLE"):
        return None
    kind = mavlink.FENCE_BREACH_BOUNDARY if pilot.breached else mavlink.FENCE_BREACH_NONE
    return mavlink.MAVLink_fence_status_message(pilot.breached, pilot.breaches, kind, 0)


def wind(pilot: Autopilot) -> Message:
    """Return where the wind comes from, and how fast."""
    north, east, _ = pilot.body.air
    if pilot.settings.firmware == PX4:
        return mavlink.MAVLink_wind_cov_message(
            milliseconds(pilot) * 1000, north, east, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        )
    comes_from = degrees(atan2(-east, -north)) % 360.0
    return mavlink.MAVLink_wind_message(comes_from, hypot(north, east), 0.0)


def obstacle(pilot: Autopilot) -> Message | None:
    """Return how far away what stands around it is; None if there is nothing."""
    if pilot.obstacle is None:
        return None
    distance, towards = pilot.obstacle
    sectors = [SECTOR_FREE] * 72
    sectors[round(towards / 5.0) % 72] = round(distance * 100)
    return mavlink.MAVLink_obstacle_distance_message(
        milliseconds(pilot) * 1000,
        mavlink.MAV_DISTANCE_SENSOR_LASER,
        sectors,
        5,
        20,
        SECTOR_FREE - 1,
        5.0,
        0.0,
        mavlink.MAV_FRAME_BODY_FRD,
    )


def photo(pilot: Autopilot, taken: Photo) -> Message:
    """Return that a photo was taken: by ArduPilot's message, or by that of a camera."""
    latitude, longitude = (round(value * 1e7) for value in pilot.degrees_at(taken.place))
    above = pilot.settings.altitude + taken.place[2]
    now = milliseconds(pilot)
    if pilot.settings.firmware == PX4:
        heights = (round(above * 1000), round(taken.place[2] * 1000))
        return mavlink.MAVLink_camera_image_captured_message(
            now, 0, 0, latitude, longitude, *heights, (1.0, 0.0, 0.0, 0.0), taken.number, 1, b""
        )
    return mavlink.MAVLink_camera_feedback_message(
        now * 1000,
        pilot.settings.system,
        0,
        taken.number,
        latitude,
        longitude,
        above,
        taken.place[2],
        0.0,
        0.0,
        taken.heading,
        0.0,
        mavlink.CAMERA_FEEDBACK_PHOTO,
    )


def version(pilot: Autopilot) -> Message:
    """Return what it can do; as version it says 0, which no real one has."""
    zeros = bytes(8)
    return mavlink.MAVLink_autopilot_version_message(
        CAPABILITIES, 0, 0, 0, 0, zeros, zeros, zeros, 0, 0, pilot.settings.system
    )


def home_position(pilot: Autopilot) -> Message:
    """Return its home."""
    latitude, longitude, above = pilot.home
    return mavlink.MAVLink_home_position_message(
        round(latitude * 1e7),
        round(longitude * 1e7),
        round(above * 1000),
        0.0,
        0.0,
        0.0,
        (1.0, 0.0, 0.0, 0.0),
        0.0,
        0.0,
        0.0,
    )


TELLERS: Mapping[str, Teller] = {
    "HEARTBEAT": heartbeat,
    "GLOBAL_POSITION_INT": global_position,
    "LOCAL_POSITION_NED": local_position,
    "ATTITUDE": attitude,
    "VFR_HUD": hud,
    "MISSION_CURRENT": mission_current,
    "SYS_STATUS": status,
    "BATTERY_STATUS": battery_status,
    "EXTENDED_SYS_STATE": landed,
    "EKF_STATUS_REPORT": estimate,
    "ESTIMATOR_STATUS": estimate,
    "GPS_RAW_INT": satellites,
    "SYSTEM_TIME": clocks,
    "FENCE_STATUS": fence_status,
    "WIND": wind,
    "WIND_COV": wind,
    "OBSTACLE_DISTANCE": obstacle,
    "AUTOPILOT_VERSION": version,
    "HOME_POSITION": home_position,
    "POSITION_TARGET_GLOBAL_INT": global_target,
    "POSITION_TARGET_LOCAL_NED": local_target,
}
NUMBERS: Mapping[int, str] = {getattr(mavlink, f"MAVLINK_MSG_ID_{name}"): name for name in TELLERS}
ON_REQUEST = frozenset({"AUTOPILOT_VERSION", "POSITION_TARGET_GLOBAL_INT", "POSITION_TARGET_LOCAL_NED"})
SLOW = {"HEARTBEAT": 1.0, "SYSTEM_TIME": 1.0, "BATTERY_STATUS": 1.0, "HOME_POSITION": 0.5}
FIRMWARE = {
    PX4: frozenset({"EKF_STATUS_REPORT", "WIND", "FENCE_STATUS"}),
    "ardupilot": frozenset({"ESTIMATOR_STATUS", "WIND_COV"}),
}
"""Messages that a firmware does not have."""


def usual_rates(settings: Settings) -> dict[str, float]:
    """Return how often each message comes before anybody asks, hertz."""
    names = [name for name in TELLERS if name not in ON_REQUEST | FIRMWARE[settings.firmware]]
    fast = {"GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "ATTITUDE", "VFR_HUD", "MISSION_CURRENT"}
    usual = {name: settings.rate if name in fast else min(2.0, settings.rate) for name in names}
    return usual | {name: min(rate, settings.rate) for name, rate in SLOW.items()} | {"HEARTBEAT": 1.0}
