"""What the vehicle does on command."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.failsafes import outside_fence
from mmrs_mavlink.sitl.items import MISSION
from mmrs_mavlink.sitl.missions import jump
from mmrs_mavlink.sitl.modes import BLIND
from mmrs_mavlink.sitl.settings import PX4

ACCEPTED = int(mavlink.MAV_RESULT_ACCEPTED)
DENIED = int(mavlink.MAV_RESULT_DENIED)
FAILED = int(mavlink.MAV_RESULT_FAILED)
UNSUPPORTED = int(mavlink.MAV_RESULT_UNSUPPORTED)
NOT_NOW = int(mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
"""What a PX4 answers to whatever it does not do, as if that could change (``Commander.cpp``)."""


FORCE_DISARM = 21_196
ON_ITS_WAY = frozenset({"auto", "return", "smart_return"})
DEVICES = frozenset(
    {181, 182, 183, 184, 203, 204, 205, 206, 211, 530, 531, 1000, 1001, 2000, 2001, 2500, 2501, 42600}
)
"""Commands for devices: carried out, as far as somebody who looks at the history can tell."""

Params = tuple[float, ...]


def obey(pilot: Autopilot, number: int, params: Params) -> int:
    """Carry out a command with its seven parameters; return its MAV_RESULT."""
    handler = _HANDLERS.get(number)
    if number in pilot.settings.refuse or (handler is None and number not in DEVICES):
        return UNSUPPORTED
    result = ACCEPTED if handler is None else handler(pilot, params)
    if result == ACCEPTED:
        pilot.note(number, params)
    return NOT_NOW if result == FAILED and pilot.settings.firmware == PX4 else result


def steer(pilot: Autopilot, target: Vector, heading: float | None) -> None:
    """Go to a position, if in a mode that is steered and, for what flies, in the air.

    With the first position ArduCopter's GUIDED goes back to its usual speed.
    """
    pilot.steered = [*pilot.steered[-20:], pilot.time]
    if pilot.mode_name == "guided" and pilot.armed and (pilot.airborne or not pilot.flies):
        if not pilot.aimed and pilot.settings.firmware != PX4 and pilot.flies:
            pilot.body.speed = pilot.usual_speed()
        pilot.aimed = True
        pilot.body.target, pilot.body.onward, pilot.body.origin = target, None, None
        if heading is not None:
            pilot.body.wanted_heading = heading


def complaint(pilot: Autopilot) -> str:
    """Return why it does not let itself be armed; empty if it does."""
    if pilot.unfit:
        return pilot.unfit
    by_hand = pilot.settings.kind == "sub" and pilot.mode_name in BLIND
    if not (pilot.located or by_hand) or pilot.uptime < pilot.settings.ready:
        return "Need Position Estimate"
    fenced = pilot.settings.firmware != PX4 and pilot.parameters["FENCE_ENABLE"]
    return "vehicle outside Polygon fence" if fenced and outside_fence(pilot) else ""


def _arm(pilot: Autopilot, params: Params) -> int:
    if params[0] == 0.0:
        if pilot.airborne and params[1] != FORCE_DISARM:
            return FAILED
        pilot.disarm()
        return ACCEPTED
    why = complaint(pilot)
    if not why and pilot.settings.firmware != PX4 and pilot.mode_name == "auto":
        why = "" if int(pilot.parameters.get("AUTO_OPTIONS", 1)) & 1 else "Mode not armable"
    if why:
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"Arm: {why}")
        return FAILED
    if not pilot.armed:
        pilot.arm()
    return ACCEPTED


def _take_off(pilot: Autopilot, params: Params) -> int:
    if not pilot.armed or not pilot.flies or pilot.airborne:
        return FAILED
    px4 = pilot.settings.firmware == PX4
    height = pilot.above_ground(params[6], above_sea=px4)
    if px4:
        pilot.enter("take_off")
    elif pilot.mode_name != "guided":
        return FAILED
    pilot.aimed = False
    pilot.body.target = (*pilot.body.position[:2], height)
    return ACCEPTED


def _land(pilot: Autopilot, params: Params) -> int:
    pilot.enter("land")
    return ACCEPTED if pilot.mode_name == "land" else FAILED


def _return(pilot: Autopilot, params: Params) -> int:
    pilot.enter("return")
    return ACCEPTED if pilot.mode_name == "return" else FAILED


def _speed(pilot: Autopilot, params: Params) -> int:
    if params[1] <= 0.0:
        return _usual_speed(pilot)
    if pilot.settings.kind == "rover" and not _heeds_speeds(pilot):
        return FAILED
    if params[0] in (2.0, 3.0):
        pilot.body.climb = params[1] if params[0] == 2.0 else pilot.body.climb
        pilot.body.descent = params[1] if params[0] == 3.0 else pilot.body.descent
    else:
        pilot.body.speed = params[1]
    return ACCEPTED


def _usual_speed(pilot: Autopilot) -> int:
    """Have a PX4 take the speed of its parameters; others are not told so."""
    if pilot.settings.firmware != PX4:
        return DENIED
    pilot.body.speed = pilot.usual_speed()
    return ACCEPTED


def _heeds_speeds(pilot: Autopilot) -> bool:
    """Return whether a rover goes anywhere by itself; in GUIDED it does not before it has a target."""
    return pilot.aimed if pilot.mode_name == "guided" else pilot.mode_name in ON_ITS_WAY


def _yaw(pilot: Autopilot, params: Params) -> int:
    if pilot.mode_name != "guided":
        return FAILED
    way = -1.0 if params[2] < 0 else 1.0
    wanted = pilot.body.heading + way * params[0] if params[3] else params[0]
    pilot.body.wanted_heading = wanted % 360.0
    return ACCEPTED


def _current(pilot: Autopilot, params: Params) -> int:
    items = pilot.stores[MISSION]
    if not 0 <= params[0] < len(items):
        return DENIED
    flown = any(item.is_flown for item in items[int(params[0]) :])
    if pilot.settings.firmware != PX4 and not flown:
        return FAILED
    jump(pilot, int(params[0]))
    if params[1] == 1.0:
        pilot.loops.clear()
    return ACCEPTED


def _start(pilot: Autopilot, params: Params) -> int:
    if params[0] or params[1] or not pilot.armed:
        return DENIED
    pilot.finished = False
    return pilot.set_mode(pilot.numbers["auto"])


def _mode(pilot: Autopilot, params: Params) -> int:
    if pilot.settings.firmware == PX4:
        return pilot.set_mode(int(params[1]) << 16 | int(params[2]) << 24)
    return pilot.set_mode(int(params[1]))


def _pause(pilot: Autopilot, params: Params) -> int:
    if params[0] == 0.0:
        pilot.body.target = None
        pilot.enter("brake" if pilot.mode_name == "auto" else pilot.mode_name, "loiter")
    return ACCEPTED


def _reposition(pilot: Autopilot, params: Params) -> int:
    wanted = "loiter" if pilot.settings.firmware == PX4 else "guided"
    if pilot.mode_name != wanted:
        if not int(params[1]) & 1:
            return DENIED
        pilot.enter(wanted)
    pilot.body.target = pilot.local(params[4], params[5], params[6])
    return ACCEPTED


def _fence(pilot: Autopilot, params: Params) -> int:
    pilot.parameters["FENCE_ENABLE"] = params[0]
    return ACCEPTED


def _roi(pilot: Autopilot, params: Params) -> int:
    pilot.roi = pilot.local(params[4], params[5], params[6]) if params[4] or params[5] else None
    return ACCEPTED


def _no_roi(pilot: Autopilot, params: Params) -> int:
    pilot.roi = None
    return ACCEPTED


def _reboot(pilot: Autopilot, params: Params) -> int:
    if pilot.armed:
        return FAILED
    pilot.reboots = True
    return ACCEPTED


def _battery(pilot: Autopilot, params: Params) -> int:
    pilot.battery.change(params[1] / 100.0)
    return ACCEPTED


def _home(pilot: Autopilot, params: Params) -> int:
    here = (*pilot.degrees(), pilot.settings.altitude + pilot.body.position[2])
    pilot.home = here if params[0] == 1.0 else (params[4], params[5], params[6])
    pilot.settled = True
    return ACCEPTED


def _terminate(pilot: Autopilot, params: Params) -> int:
    if params[0] == 1.0:
        pilot.armed = False
    return ACCEPTED


def _check(pilot: Autopilot, params: Params) -> int:
    why = complaint(pilot)
    if why:
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"PreArm: {why}")
    return FAILED if pilot.armed else ACCEPTED


def _inject(pilot: Autopilot, params: Params) -> int:
    """Fail on purpose, as PX4's simulation does: its GPS receiver only, off or on again."""
    if pilot.settings.firmware != PX4 or params[0] != mavlink.FAILURE_UNIT_SENSOR_GPS:
        return UNSUPPORTED
    pilot.located = params[1] == mavlink.FAILURE_TYPE_OK
    return ACCEPTED


_HANDLERS: Mapping[int, Callable[[Autopilot, Params], int]] = {
    int(mavlink.MAV_CMD_COMPONENT_ARM_DISARM): _arm,
    int(mavlink.MAV_CMD_NAV_TAKEOFF): _take_off,
    int(mavlink.MAV_CMD_NAV_LAND): _land,
    int(mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH): _return,
    int(mavlink.MAV_CMD_DO_CHANGE_SPEED): _speed,
    int(mavlink.MAV_CMD_CONDITION_YAW): _yaw,
    int(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT): _current,
    int(mavlink.MAV_CMD_MISSION_START): _start,
    int(mavlink.MAV_CMD_DO_SET_MODE): _mode,
    int(mavlink.MAV_CMD_DO_PAUSE_CONTINUE): _pause,
    int(mavlink.MAV_CMD_DO_REPOSITION): _reposition,
    int(mavlink.MAV_CMD_DO_FENCE_ENABLE): _fence,
    int(mavlink.MAV_CMD_DO_SET_ROI): _roi,
    int(mavlink.MAV_CMD_DO_SET_ROI_LOCATION): _roi,
    int(mavlink.MAV_CMD_DO_SET_ROI_NONE): _no_roi,
    int(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN): _reboot,
    int(mavlink.MAV_CMD_BATTERY_RESET): _battery,
    int(mavlink.MAV_CMD_DO_SET_HOME): _home,
    int(mavlink.MAV_CMD_DO_FLIGHTTERMINATION): _terminate,
    int(mavlink.MAV_CMD_RUN_PREARM_CHECKS): _check,
    int(mavlink.MAV_CMD_INJECT_FAILURE): _inject,
}
