"""Telemetry of a simulated vehicle, as messages."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import cache
from inspect import signature
from math import cos, hypot, radians, sin
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import ARDUPILOT, PX4
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.camera import Photo
from mmrs_mavlink.sitl.commands import arming_refusal
from mmrs_mavlink.sitl.items import MISSION
from mmrs_mavlink.sitl.settings import Settings

Message = Any
Maker = Callable[[SimulatedAutopilot], Message | None]
"""Makes a message; None if a vehicle has nothing to report."""

LOCATED, LOST = 0x33F, 0xA7
"""Flags of the position estimate."""

STEERED = frozenset({"guided", "auto", "return", "smart_return"})
"""Modes in which an ArduPilot reports its target."""

TUMBLING = radians(60.0)
"""Lean of an ArduCopter 4.7-dev in simulation that falls with one of its four motors off."""

SECTOR_FREE = 6_001
UNKNOWN = 65_535
GPS, FENCE_BIT, PREARM = 0x20, 0x0010_0000, 0x1000_0000
SENSORS = 0x0200_002F
"""Gyroscope, accelerometer, compass, pressure, satellites and battery."""

NO_ROTATION = (1.0, 0.0, 0.0, 0.0)
CAPABILITIES = 0xE18C
"""Missions, fences and rally points of integers, commands and targets of integers, MAVLink 2."""


def message(name: str, **fields: object) -> Message:
    """Return a message by the name of its type in lower case; fields that are not given are zero."""
    kind = getattr(mavlink, f"MAVLink_{name}_message")
    return kind(**{**_zeros(kind), **fields})


@cache
def _zeros(kind: Callable[..., Message]) -> Mapping[str, int]:
    return {each.name: 0 for each in signature(kind).parameters.values() if each.default is each.empty}


def milliseconds(pilot: SimulatedAutopilot) -> int:
    """Return the milliseconds since boot."""
    return int(round(pilot.uptime * 1000) % 2**32)


def _scaled(latitude: float, longitude: float, north: str = "lat", east: str = "lon") -> dict[str, int]:
    return {north: round(latitude * 1e7), east: round(longitude * 1e7)}


def _heartbeat(pilot: SimulatedAutopilot) -> Message:
    armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED if pilot.armed else 0
    return message(
        "heartbeat",
        type=pilot.settings.profile.mav_types[0],
        autopilot=pilot.settings.profile.autopilot.number,
        base_mode=mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | armed,
        custom_mode=pilot.mode,
        system_status=mavlink.MAV_STATE_ACTIVE if pilot.armed else mavlink.MAV_STATE_STANDBY,
        mavlink_version=3,
    )


def _global_position(pilot: SimulatedAutopilot) -> Message | None:
    """Return its position; without one, ArduPilot reports 0 degrees of both, and PX4 nothing."""
    if not pilot.ready and pilot.px4:
        return None
    up = pilot.settings.altitude + pilot.body.position[2]
    north, east, climb = pilot.body.velocity
    return message(
        "global_position_int",
        time_boot_ms=milliseconds(pilot),
        **_scaled(*(pilot.degrees() if pilot.ready else (0.0, 0.0))),
        alt=round(up * 1000),
        relative_alt=round((up - pilot.home[2]) * 1000),
        vx=round(north * 100),
        vy=round(east * 100),
        vz=round(-climb * 100),
        hdg=round(pilot.body.heading * 100) % 36_000,
    )


def _local_position(pilot: SimulatedAutopilot) -> Message | None:
    if not pilot.ready:
        return None
    (north, east, up), (v_north, v_east, v_up) = pilot.body.position, pilot.body.velocity
    now = milliseconds(pilot)
    return mavlink.MAVLink_local_position_ned_message(now, north, east, -up, v_north, v_east, -v_up)


def _target(pilot: SimulatedAutopilot) -> Message | None:
    target = pilot.body.target
    if target is None or pilot.px4 or pilot.mode_name not in STEERED:
        return None
    return message(
        "position_target_global_int",
        time_boot_ms=milliseconds(pilot),
        type_mask=0xDF8,
        **_scaled(*pilot.degrees_at(target), "lat_int", "lon_int"),
        alt=pilot.settings.altitude + target[2],
    )


def _attitude(pilot: SimulatedAutopilot) -> Message:
    yaw = radians((pilot.body.heading + 180.0) % 360.0 - 180.0)
    roll = TUMBLING if pilot.motor_failed and pilot.airborne else 0.0
    return message("attitude", time_boot_ms=milliseconds(pilot), roll=roll, yaw=yaw)


def mission_current(pilot: SimulatedAutopilot) -> Message:
    """Return the current mission item, and the state of the mission."""
    total = max(0, len(pilot.stores[MISSION]) - pilot.first_item)
    state = 4 if pilot.finished else 3 if pilot.mode_name == "auto" else 2
    return mavlink.MAVLink_mission_current_message(
        pilot.current_item, total, state if pilot.has_mission else 1
    )


def _status(pilot: SimulatedAutopilot) -> Message:
    """Return the health of its sensors, its pre-arm check and its battery."""
    health = SENSORS if pilot.located else SENSORS & ~GPS
    health |= (0 if pilot.breached else FENCE_BIT) | (0 if arming_refusal(pilot) else PREARM)
    present = SENSORS | FENCE_BIT | (0 if pilot.px4 else PREARM)
    measures = pilot.settings.tells_battery
    return message(
        "sys_status",
        onboard_control_sensors_present=present,
        onboard_control_sensors_enabled=present,
        onboard_control_sensors_health=health,
        voltage_battery=round(pilot.battery.voltage * 1000) if measures else UNKNOWN,
        current_battery=round(pilot.battery.current * 100) if measures else -1,
        battery_remaining=round(pilot.battery.level * 100) if measures else -1,
    )


def _battery_status(pilot: SimulatedAutopilot) -> Message | None:
    if not pilot.settings.tells_battery:
        return None
    return message(
        "battery_status",
        temperature=32_767,
        voltages=[round(pilot.battery.voltage * 1000), *[UNKNOWN] * 9],
        current_battery=round(pilot.battery.current * 100),
        current_consumed=round(pilot.battery.used),
        energy_consumed=-1,
        battery_remaining=round(pilot.battery.level * 100),
    )


def _landed(pilot: SimulatedAutopilot) -> Message:
    """Return whether it stands on the ground, which ArduSub and Rover do not report."""
    state = mavlink.MAV_LANDED_STATE_IN_AIR if pilot.airborne else mavlink.MAV_LANDED_STATE_ON_GROUND
    return message("extended_sys_state", landed_state=state if pilot.flies else 0)


def _ekf(pilot: SimulatedAutopilot) -> Message:
    return message("ekf_status_report", flags=LOCATED if _has_position(pilot) else LOST)


def _estimator(pilot: SimulatedAutopilot) -> Message:
    flags = LOCATED if _has_position(pilot) else LOST
    return message("estimator_status", time_usec=milliseconds(pilot) * 1000, flags=flags)


def _has_position(pilot: SimulatedAutopilot) -> bool:
    return pilot.located and pilot.ready


def _satellites(pilot: SimulatedAutopilot) -> Message:
    located = _has_position(pilot)
    return message(
        "gps_raw_int",
        time_usec=milliseconds(pilot) * 1000,
        fix_type=mavlink.GPS_FIX_TYPE_3D_FIX if located else mavlink.GPS_FIX_TYPE_NO_FIX,
        **_scaled(*pilot.degrees()),
        alt=round((pilot.settings.altitude + pilot.body.position[2]) * 1000),
        eph=80 if located else 9_999,
        epv=UNKNOWN,
        vel=round(hypot(*pilot.body.velocity[:2]) * 100),
        cog=UNKNOWN,
        satellites_visible=14 if located else 0,
    )


def _clocks(pilot: SimulatedAutopilot) -> Message:
    now = round((time.time() + pilot.clock_error) * 1e6)
    return mavlink.MAVLink_system_time_message(now, milliseconds(pilot))


def _fence(pilot: SimulatedAutopilot) -> Message | None:
    """Return whether it is outside its fence; None without a fence."""
    if not pilot.breached and not pilot.parameters.get("FENCE_ENABLE"):
        return None
    kind = mavlink.FENCE_BREACH_BOUNDARY if pilot.breached else mavlink.FENCE_BREACH_NONE
    broken = max(0, round(1000.0 * (pilot.failing.get("fence", pilot.time) - pilot.booted)))
    return mavlink.MAVLink_fence_status_message(pilot.breached, pilot.breached, kind, broken)


def _wind(pilot: SimulatedAutopilot) -> Message:
    speed, comes_from = pilot.wind
    return mavlink.MAVLink_wind_message(comes_from, speed, 0.0)


def _wind_estimate(pilot: SimulatedAutopilot) -> Message:
    speed, towards = pilot.wind[0], radians(pilot.wind[1] + 180.0)
    return message("wind_cov", wind_x=speed * cos(towards), wind_y=speed * sin(towards))


def _obstacle(pilot: SimulatedAutopilot) -> Message | None:
    if pilot.obstacle is None:
        return None
    distance, towards = pilot.obstacle
    sectors = [SECTOR_FREE] * 72
    sectors[round(towards / 5.0) % 72] = round(distance * 100)
    return message(
        "obstacle_distance",
        time_usec=milliseconds(pilot) * 1000,
        distances=sectors,
        min_distance=20,
        max_distance=SECTOR_FREE - 1,
        increment_f=5.0,
        frame=mavlink.MAV_FRAME_BODY_FRD,
    )


def photo(pilot: SimulatedAutopilot, taken: Photo) -> Message:
    """Return the report of a photo: ArduPilot's message, or that of a camera for PX4."""
    place, up, now = pilot.degrees_at(taken.place), taken.place[2], milliseconds(pilot)
    above = pilot.settings.altitude + up
    if pilot.px4:
        return message(
            "camera_image_captured",
            time_boot_ms=now,
            **_scaled(*place),
            alt=round(above * 1000),
            relative_alt=round(up * 1000),
            q=NO_ROTATION,
            image_index=taken.number,
            capture_result=1,
            file_url=b"",
        )
    return message(
        "camera_feedback",
        time_usec=now * 1000,
        target_system=pilot.settings.system,
        img_idx=taken.number,
        **_scaled(*place, "lat", "lng"),
        alt_msl=above,
        alt_rel=up,
        yaw=taken.heading,
    )


def _version(pilot: SimulatedAutopilot) -> Message:
    """Return its capabilities; its version is 0, which no real autopilot has."""
    none = dict.fromkeys(
        ("flight_custom_version", "middleware_custom_version", "os_custom_version"), bytes(8)
    )
    return message("autopilot_version", capabilities=CAPABILITIES, uid=pilot.settings.system, **none)


def _home(pilot: SimulatedAutopilot) -> Message:
    place = _scaled(*pilot.home[:2], "latitude", "longitude")
    return message("home_position", **place, altitude=round(pilot.home[2] * 1000), q=NO_ROTATION)


MAKERS: Mapping[str, Maker] = {
    "HEARTBEAT": _heartbeat,
    "GLOBAL_POSITION_INT": _global_position,
    "LOCAL_POSITION_NED": _local_position,
    "ATTITUDE": _attitude,
    "MISSION_CURRENT": mission_current,
    "SYS_STATUS": _status,
    "BATTERY_STATUS": _battery_status,
    "EXTENDED_SYS_STATE": _landed,
    "EKF_STATUS_REPORT": _ekf,
    "ESTIMATOR_STATUS": _estimator,
    "GPS_RAW_INT": _satellites,
    "SYSTEM_TIME": _clocks,
    "FENCE_STATUS": _fence,
    "WIND": _wind,
    "WIND_COV": _wind_estimate,
    "OBSTACLE_DISTANCE": _obstacle,
    "AUTOPILOT_VERSION": _version,
    "HOME_POSITION": _home,
    "POSITION_TARGET_GLOBAL_INT": _target,
}
NUMBERS: Mapping[int, str] = {getattr(mavlink, f"MAVLINK_MSG_ID_{name}"): name for name in MAKERS}
ON_REQUEST = frozenset({"AUTOPILOT_VERSION", "POSITION_TARGET_GLOBAL_INT"})
USUAL_RATE, FAST_RATE = 2.0, 4.0
SLOW = {"HEARTBEAT": 1.0, "SYSTEM_TIME": 1.0, "BATTERY_STATUS": 1.0, "HOME_POSITION": 0.5}
FAST = frozenset({"GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "ATTITUDE", "MISSION_CURRENT"})


def missing(settings: Settings) -> frozenset[str]:
    """Return the messages that only another firmware has, by the profiles."""
    own = settings.profile.autopilot.streamed
    return frozenset(name for each in (ARDUPILOT, PX4) for name in each.streamed if name not in own)


def usual_rates(settings: Settings) -> dict[str, float]:
    """Return the rates of messages that no one has requested, hertz."""
    names = [name for name in MAKERS if name not in ON_REQUEST | missing(settings)]
    return {name: FAST_RATE if name in FAST else SLOW.get(name, USUAL_RATE) for name in names}
