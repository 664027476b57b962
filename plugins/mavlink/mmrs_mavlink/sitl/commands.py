"""Commands of a simulated vehicle, and set-points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import CURVED, MANUAL, SimulatedAutopilot
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.items import MISSION
from mmrs_mavlink.sitl.simulation import jump

ACCEPTED = int(mavlink.MAV_RESULT_ACCEPTED)
DENIED = int(mavlink.MAV_RESULT_DENIED)
FAILED = int(mavlink.MAV_RESULT_FAILED)
UNSUPPORTED = int(mavlink.MAV_RESULT_UNSUPPORTED)
NOT_NOW = int(mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
FORCE_DISARM = 21_196
DEVICES = frozenset(
    {181, 182, 183, 184, 203, 204, 205, 206, 211, 530, 531} | {1000, 1001, 2000, 2001, 2500, 2501, 42600}
)
"""Commands for devices, which are only recorded."""

FULL_STICK = (1.0, 1.0, 0.5, 45.0)
"""Speeds of a submarine ahead, aside and up, metres per second, and turn rate, degrees per second."""

Params = tuple[float, ...]


def execute(pilot: SimulatedAutopilot, number: int, params: Params) -> int:
    """Execute a command with its seven parameters; return its MAV_RESULT: a PX4 fails by `NOT_NOW`."""
    handler = _HANDLERS.get(number)
    if handler is None and number not in DEVICES:
        return UNSUPPORTED
    result = ACCEPTED if handler is None else handler(pilot, params)
    if result == ACCEPTED:
        pilot.record(number, params)
    return NOT_NOW if result == FAILED and pilot.px4 else result


def steer(pilot: SimulatedAutopilot, target: Vector, heading: float | None) -> None:
    """Follow a set-point, if the mode is GUIDED (OFFBOARD) and a flying vehicle is in the air.

    The first set-point in ArduCopter's GUIDED resets the speed to its default. ArduSub plans its leg from a
    stop at each.
    """
    pilot.setpoints = [*pilot.setpoints[-20:], pilot.time]
    if pilot.mode_name == "guided" and pilot.armed and (pilot.airborne or not pilot.flies):
        if not pilot.aimed and not pilot.px4 and pilot.flies:
            pilot.body.speed = pilot.usual_speed()
        pilot.aimed = True
        pilot.body.target, pilot.body.onward = target, None
        pilot.body.driven = None
        if pilot.settings.profile.dives:
            pilot.body.plan_anew()
        if heading is not None:
            pilot.body.wanted_heading = heading


def drive(pilot: SimulatedAutopilot, speed: float, rate: float) -> None:
    """Drive at a speed and a turn rate, degrees per second, if a rover is in GUIDED, and armed."""
    if pilot.mode_name == "guided" and pilot.armed and pilot.settings.kind == "rover":
        pilot.body.target = pilot.body.onward = None
        pilot.body.driven = (speed, 0.0, 0.0, rate)


def take_sticks(pilot: SimulatedAutopilot, message: Any) -> None:
    """Move as the sticks of a MANUAL_CONTROL command; ArduSub's z ranges from 0 to 1000, neutral at 500."""
    if pilot.settings.kind == "sub" and pilot.mode_name in MANUAL:
        sticks = (message.x / 1000.0, message.y / 1000.0, (message.z - 500) / 500.0, message.r / 1000.0)
        ahead, aside, up, turn = (part * full for part, full in zip(sticks, FULL_STICK, strict=True))
        pilot.body.driven, pilot.driven_at = (ahead, aside, up, turn), pilot.time


def arming_refusal(pilot: SimulatedAutopilot) -> str:
    """Return why a vehicle refuses to arm; empty if it does not."""
    manual = pilot.settings.profile.dives and pilot.mode_name in MANUAL
    return "" if pilot.ready and (pilot.located or manual) else "Need Position Estimate"


def _arm(pilot: SimulatedAutopilot, params: Params) -> int:
    if params[0] == 0.0:
        if pilot.airborne and params[1] != FORCE_DISARM:
            return FAILED
        pilot.disarm()
        return ACCEPTED
    why = arming_refusal(pilot)
    if not why and not pilot.px4 and pilot.mode_name == "auto":
        why = "" if int(pilot.parameters.get("AUTO_OPTIONS", 1)) & 1 else "Mode not armable"
    if why:
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"Arm: {why}")
        return FAILED
    if not pilot.armed:
        pilot.arm()
    return ACCEPTED


def _take_off(pilot: SimulatedAutopilot, params: Params) -> int:
    may = pilot.px4 or pilot.mode_name == "guided"
    if not (may and pilot.armed and pilot.flies) or pilot.airborne:
        return FAILED
    height = pilot.above_ground(params[6], above_sea=pilot.px4)
    if pilot.px4:
        pilot.enter("take_off")
    pilot.aimed = False
    pilot.spin_up()
    pilot.body.target = (*pilot.body.position[:2], height)
    return ACCEPTED


def _enter(name: str) -> Callable[[SimulatedAutopilot, Params], int]:
    def handler(pilot: SimulatedAutopilot, params: Params) -> int:
        pilot.enter(name)
        return ACCEPTED if pilot.mode_name == name else FAILED

    return handler


def _speed(pilot: SimulatedAutopilot, params: Params) -> int:
    moves = pilot.aimed if pilot.mode_name == "guided" else pilot.mode_name in CURVED
    if params[1] <= 0.0 and not pilot.px4:
        return DENIED
    if pilot.settings.profile.drives and not moves:
        return FAILED
    pilot.body.change_speed(params[1] if params[1] > 0.0 else pilot.usual_speed())
    return ACCEPTED


def _yaw(pilot: SimulatedAutopilot, params: Params) -> int:
    if pilot.mode_name != "guided":
        return FAILED
    turn = -params[0] if params[2] < 0 else params[0]
    pilot.body.wanted_heading = (pilot.body.heading + turn if params[3] else params[0]) % 360.0
    return ACCEPTED


def _look_at(pilot: SimulatedAutopilot, params: Params) -> int:
    pilot.interest = pilot.local(params[4], params[5], 0.0) if pilot.mode_name == "auto" else None
    return ACCEPTED


def _look_ahead(pilot: SimulatedAutopilot, params: Params) -> int:
    pilot.interest = None
    return ACCEPTED


def _set_current(pilot: SimulatedAutopilot, params: Params) -> int:
    items = pilot.stores[MISSION]
    if not 0 <= params[0] < len(items):
        return DENIED
    if not pilot.px4 and not any(item.is_flown for item in items[int(params[0]) :]):
        return FAILED
    jump(pilot, int(params[0]))
    return ACCEPTED


def _start_mission(pilot: SimulatedAutopilot, params: Params) -> int:
    if params[0] or params[1] or not pilot.armed:
        return DENIED
    pilot.finished = False
    return pilot.set_mode(pilot.numbers["auto"])


def _set_mode(pilot: SimulatedAutopilot, params: Params) -> int:
    return pilot.set_mode(int(params[1]) << 16 | int(params[2]) << 24 if pilot.px4 else int(params[1]))


def _enable_fence(pilot: SimulatedAutopilot, params: Params) -> int:
    pilot.parameters["FENCE_ENABLE"] = params[0]
    return ACCEPTED


def _set_home(pilot: SimulatedAutopilot, params: Params) -> int:
    here = (*pilot.degrees(), pilot.settings.altitude + pilot.body.position[2])
    pilot.home = here if params[0] == 1.0 else (params[4], params[5], params[6])
    pilot.home_set = True
    return ACCEPTED


def _run_checks(pilot: SimulatedAutopilot, params: Params) -> int:
    if why := arming_refusal(pilot):
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"PreArm: {why}")
    return FAILED if pilot.armed else ACCEPTED


_HANDLERS: Mapping[int, Callable[[SimulatedAutopilot, Params], int]] = {
    int(mavlink.MAV_CMD_COMPONENT_ARM_DISARM): _arm,
    int(mavlink.MAV_CMD_NAV_TAKEOFF): _take_off,
    int(mavlink.MAV_CMD_NAV_LAND): _enter("land"),
    int(mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH): _enter("return"),
    int(mavlink.MAV_CMD_DO_CHANGE_SPEED): _speed,
    int(mavlink.MAV_CMD_CONDITION_YAW): _yaw,
    int(mavlink.MAV_CMD_DO_SET_ROI_LOCATION): _look_at,
    int(mavlink.MAV_CMD_DO_SET_ROI_NONE): _look_ahead,
    int(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT): _set_current,
    int(mavlink.MAV_CMD_MISSION_START): _start_mission,
    int(mavlink.MAV_CMD_DO_SET_MODE): _set_mode,
    int(mavlink.MAV_CMD_DO_FENCE_ENABLE): _enable_fence,
    int(mavlink.MAV_CMD_DO_SET_HOME): _set_home,
    int(mavlink.MAV_CMD_RUN_PREARM_CHECKS): _run_checks,
}
