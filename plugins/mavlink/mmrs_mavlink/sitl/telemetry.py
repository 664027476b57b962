"""Telemetry of a simulated vehicle: its messages, at their rates, and events as they occur."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from math import cos, radians, sin
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import ARDUPILOT, PX4
from mmrs_mavlink.sitl.autopilot import CURVED, SimulatedAutopilot
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.commands import ACCEPTED, FAILED, arming_refusal
from mmrs_mavlink.sitl.items import MISSION
from mmrs_runtime.controllers.geodesy import turn
from mmrs_runtime.sights import seen

Message = Any
Maker = Callable[[SimulatedAutopilot], Message | None]
"""Makes a message; None if a vehicle has nothing to report."""

LOCATED, LOST = 0x33F, 0xA7
"""Flags of the position estimate."""

TUMBLING = radians(60.0)
"""Lean of an ArduCopter 4.7-dev in simulation that falls with one of its four motors off."""

UNSTEADY = 0.35
"""Metres per second that a PX4 estimates in the air in OFFBOARD at least: noise of its own simulation."""

SECTOR_FREE, UNKNOWN = 6_001, 65_535
GPS, FENCE_BIT, PREARM = 0x20, 0x0010_0000, 0x1000_0000
SENSORS = 0x0200_002F
"""Gyroscope, accelerometer, compass, pressure, satellites and battery."""

TEXT_BYTES = 50


def message(name: str, **fields: object) -> Message:
    """Return a message by the name of its type in lower case; numbers that are not given are zero."""
    kind = getattr(mavlink, f"MAVLink_{name}_message")
    lengths = zip(kind.ordered_fieldnames, kind.array_lengths, strict=True)
    return kind(**{**{name: 0 for name, length in lengths if not length}, **fields})


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
    )


def _velocity(pilot: SimulatedAutopilot) -> Vector:
    """Return the velocity that it estimates."""
    north, east, climb = pilot.body.velocity
    unsteady = pilot.px4 and pilot.airborne and pilot.mode_name == "guided"
    return (max(north, UNSTEADY) if unsteady and pilot.body.pace < UNSTEADY else north, east, climb)


def _global_position(pilot: SimulatedAutopilot) -> Message | None:
    """Return its position; without one, ArduPilot reports 0 degrees of both, and PX4 nothing."""
    if not pilot.ready and pilot.px4:
        return None
    up = pilot.settings.altitude + pilot.body.position[2]
    north, east, climb = _velocity(pilot)
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
    (north, east, up), (v_north, v_east, v_up) = pilot.body.position, _velocity(pilot)
    now = milliseconds(pilot)
    return mavlink.MAVLink_local_position_ned_message(now, north, east, -up, v_north, v_east, -v_up)


def _target(pilot: SimulatedAutopilot) -> Message | None:
    """Return its target, which ArduPilot reports in the modes in which it flies to one."""
    target = pilot.body.target
    if target is None or pilot.px4 or pilot.mode_name not in CURVED | {"guided"}:
        return None
    return message(
        "position_target_global_int",
        type_mask=0xDF8,
        **_scaled(*pilot.degrees_at(target), "lat_int", "lon_int"),
        alt=pilot.settings.altitude + target[2],
    )


def _attitude(pilot: SimulatedAutopilot) -> Message:
    yaw = radians(turn(0.0, pilot.body.heading))
    roll = TUMBLING if pilot.motor_failed and pilot.airborne else 0.0
    return message("attitude", time_boot_ms=milliseconds(pilot), roll=roll, yaw=yaw)


def mission_current(pilot: SimulatedAutopilot) -> Message:
    """Return the current mission item, and the state of the mission."""
    total = max(0, len(pilot.stores[MISSION]) - pilot.first_item)
    if not pilot.has_mission:
        state = mavlink.MISSION_STATE_NO_MISSION
    elif pilot.finished:
        state = mavlink.MISSION_STATE_COMPLETE
    else:
        active = pilot.mode_name == "auto"
        state = mavlink.MISSION_STATE_ACTIVE if active else mavlink.MISSION_STATE_NOT_STARTED
    return mavlink.MAVLink_mission_current_message(pilot.current_item, total, state)


def _status(pilot: SimulatedAutopilot) -> Message:
    """Return the health of its sensors, its pre-arm check and its battery."""
    health = SENSORS if pilot.located else SENSORS & ~GPS
    health |= (0 if pilot.breached else FENCE_BIT) | (0 if arming_refusal(pilot) else PREARM)
    present = SENSORS | FENCE_BIT | (0 if pilot.px4 else PREARM)
    measures, battery = pilot.settings.tells_battery, pilot.battery
    return message(
        "sys_status",
        onboard_control_sensors_present=present,
        onboard_control_sensors_enabled=present,
        onboard_control_sensors_health=health,
        voltage_battery=round(battery.voltage * 1000) if measures else UNKNOWN,
        current_battery=round(battery.current * 100) if measures else -1,
        battery_remaining=round(battery.level * 100) if measures else -1,
    )


def _battery_status(pilot: SimulatedAutopilot) -> Message | None:
    battery = pilot.battery
    if not pilot.settings.tells_battery:
        return None
    return message(
        "battery_status",
        temperature=32_767,
        voltages=[round(battery.voltage * 1000), *[UNKNOWN] * 9],
        current_battery=round(battery.current * 100),
        current_consumed=round(battery.used),
        energy_consumed=-1,
        battery_remaining=round(battery.level * 100),
    )


def _landed(pilot: SimulatedAutopilot) -> Message:
    """Return whether it stands on the ground, which ArduSub and Rover do not report."""
    state = mavlink.MAV_LANDED_STATE_IN_AIR if pilot.airborne else mavlink.MAV_LANDED_STATE_ON_GROUND
    return message("extended_sys_state", landed_state=state if pilot.flies else 0)


def _estimate(name: str) -> Maker:
    """Return a maker of the flags of its position estimate, as a message."""
    return lambda pilot: message(name, flags=LOCATED if pilot.located and pilot.ready else LOST)


def _satellites(pilot: SimulatedAutopilot) -> Message:
    fix, seen = (3, 14) if pilot.located and pilot.ready else (1, 0)
    return message("gps_raw_int", **_scaled(*pilot.degrees()), fix_type=fix, satellites_visible=seen)


def _clocks(pilot: SimulatedAutopilot) -> Message:
    microseconds = round((time.time() + pilot.clock_error) * 1e6)
    return mavlink.MAVLink_system_time_message(microseconds, milliseconds(pilot))


def _fence(pilot: SimulatedAutopilot) -> Message | None:
    """Return whether it is outside its fence; None without a fence."""
    if not pilot.breached and not pilot.parameters.get("FENCE_ENABLE"):
        return None
    kind = mavlink.FENCE_BREACH_BOUNDARY if pilot.breached else mavlink.FENCE_BREACH_NONE
    broken = max(0, round(1000.0 * (pilot.failing.get("fence", pilot.time) - pilot.booted)))
    return mavlink.MAVLink_fence_status_message(pilot.breached, pilot.breached, kind, broken)


def _wind(pilot: SimulatedAutopilot) -> Message:
    return mavlink.MAVLink_wind_message(*reversed(pilot.wind), 0.0)


def _wind_estimate(pilot: SimulatedAutopilot) -> Message:
    speed, towards = pilot.wind[0], radians(pilot.wind[1] + 180.0)
    return message("wind_cov", wind_x=speed * cos(towards), wind_y=speed * sin(towards))


def _obstacle(pilot: SimulatedAutopilot) -> Message | None:
    if pilot.obstacle is None:
        return None
    sectors = [round(pilot.obstacle * 100), *[SECTOR_FREE] * 71]
    return message(
        "obstacle_distance", distances=sectors, min_distance=20, max_distance=SECTOR_FREE - 1, increment_f=5.0
    )


def photo(pilot: SimulatedAutopilot, number: int) -> Message:
    """Return the report of a photo, counted from 1: ArduPilot's message, or that of a camera for PX4."""
    place, up = pilot.degrees_at(at := pilot.photos[number - 1]), pilot.settings.altitude + at[2]
    above = up - pilot.home[2]
    if pilot.px4:
        captured = {"image_index": number, "capture_result": 1, "q": (1.0, 0.0, 0.0, 0.0), "file_url": b""}
        captured |= {"alt": round(up * 1000), "relative_alt": round(above * 1000)}
        return message("camera_image_captured", **_scaled(*place), **captured)
    position = _scaled(*place, "lat", "lng")
    return message("camera_feedback", img_idx=number, **position, alt_msl=up, alt_rel=above)


def _home(pilot: SimulatedAutopilot) -> Message:
    place = _scaled(*pilot.home[:2], "latitude", "longitude")
    return message("home_position", **place, altitude=round(pilot.home[2] * 1000), q=(1.0, 0.0, 0.0, 0.0))


MAKERS: Mapping[str, Maker] = {
    "HEARTBEAT": _heartbeat,
    "GLOBAL_POSITION_INT": _global_position,
    "LOCAL_POSITION_NED": _local_position,
    "ATTITUDE": _attitude,
    "MISSION_CURRENT": mission_current,
    "SYS_STATUS": _status,
    "BATTERY_STATUS": _battery_status,
    "EXTENDED_SYS_STATE": _landed,
    "EKF_STATUS_REPORT": _estimate("ekf_status_report"),
    "ESTIMATOR_STATUS": _estimate("estimator_status"),
    "GPS_RAW_INT": _satellites,
    "SYSTEM_TIME": _clocks,
    "FENCE_STATUS": _fence,
    "WIND": _wind,
    "WIND_COV": _wind_estimate,
    "OBSTACLE_DISTANCE": _obstacle,
    "HOME_POSITION": _home,
    "POSITION_TARGET_GLOBAL_INT": _target,
}
ON_REQUEST = "POSITION_TARGET_GLOBAL_INT"
USUAL_RATE = 2.0
RATES = {
    **dict.fromkeys(("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "ATTITUDE", "MISSION_CURRENT"), 4.0),
    **dict.fromkeys(("HEARTBEAT", "SYSTEM_TIME", "BATTERY_STATUS"), 1.0),
    "HOME_POSITION": 0.5,
}
"""Rates of messages that no one has requested, hertz, where they are not usual."""


class Streams:
    """Sends the telemetry of one vehicle."""

    def __init__(self, pilot: SimulatedAutopilot, send: Callable[[Message], None]) -> None:
        self._pilot, self._send = pilot, send
        own, known = pilot.settings.profile.autopilot.streamed, {**ARDUPILOT.streamed, **PX4.streamed}
        self._names = [name for name in MAKERS if name in own or name not in known]
        self._texts = self._photos = 0
        """How many texts and photos it has sent."""
        self._begin([name for name in self._names if name != ON_REQUEST])

    def reboot(self) -> None:
        """Forget all requests: an ArduPilot then sends heartbeats only."""
        self._begin([name for name in self._names if name == "HEARTBEAT" or self._pilot.px4])

    def _begin(self, names: Sequence[str]) -> None:
        self._periods = {name: 1.0 / RATES.get(name, USUAL_RATE) for name in names}
        self._due = dict.fromkeys(names, 0.0)

    def set_interval(self, number: float, microseconds: float) -> int:
        """Send a message at an interval: -1 never, 0 the default; return a MAV_RESULT."""
        name = self._name(number)
        if not name:
            return FAILED
        self._periods.pop(name, None)
        if microseconds >= 0.0:
            self._periods[name] = microseconds * 1e-6 or 1.0 / RATES.get(name, USUAL_RATE)
            self._due[name] = 0.0
        return ACCEPTED

    def send_once(self, number: float) -> int:
        """Send a requested message; return a MAV_RESULT."""
        name = self._name(number)
        message = MAKERS[name](self._pilot) if name else None
        if message is None:
            return FAILED
        self._send(message)
        return ACCEPTED

    def advance(self) -> None:
        """Send what is due."""
        pilot = self._pilot
        if pilot.heartbeat_due and not pilot.px4:
            self._due["HEARTBEAT"] = 0.0
        pilot.heartbeat_due = False
        for name, period in self._periods.items():
            if pilot.time >= self._due[name]:
                self._due[name] = max(self._due[name] + period, pilot.time - period)
                self.send(name)
        self._send_events()

    def send(self, name: str) -> None:
        """Send a message, and those that accompany it."""
        pilot = self._pilot
        message = MAKERS[name](pilot)
        if message is not None:
            self._send(message)
        if name == "SYS_STATUS":
            now = milliseconds(pilot)
            for sensor, value in pilot.settings.values.items():
                measured = value(pilot.time)
                self._send(mavlink.MAVLink_named_value_float_message(now, sensor.encode(), measured))

    def _name(self, number: float) -> str:
        """Return the name of a message that it sends; empty if it does not."""
        name = getattr(mavlink.mavlink_map.get(int(number)), "msgname", "")
        return name if name in self._names else ""

    def _send_events(self) -> None:
        """Send texts, and photos with the objects in them."""
        pilot = self._pilot
        for _, severity, text in pilot.said[self._texts :]:
            self._send(mavlink.MAVLink_statustext_message(severity, text.encode()[:TEXT_BYTES]))
        self._texts = len(pilot.said)
        for number in range(self._photos + 1, len(pilot.photos) + 1):
            self._send(photo(pilot, number))
            self._report_detections(pilot.photos[number - 1])
        self._photos = len(pilot.photos)

    def _report_detections(self, here: Vector) -> None:
        """Report the objects in a photo, with their positions if those fit into a text."""
        for each in seen(self._pilot.settings.sights, *here):
            latitude, longitude = self._pilot.degrees_at((each.north, each.east, 0.0))
            text = f"detected {each.name}"
            placed = f"{text} at {latitude:.6f},{longitude:.6f}"
            self._pilot.say(mavlink.MAV_SEVERITY_NOTICE, placed if len(placed) <= TEXT_BYTES else text)
