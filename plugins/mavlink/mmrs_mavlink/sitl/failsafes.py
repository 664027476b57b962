"""Failsafes of a simulated ArduPilot, as its parameters configure them."""

from __future__ import annotations

from collections.abc import Mapping

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.fences import inside_zones, watch_fence
from mmrs_mavlink.sitl.modes import BLIND

CRITICAL, WARNING = mavlink.MAV_SEVERITY_CRITICAL, mavlink.MAV_SEVERITY_WARNING
EKF_SECONDS = 1.0
DISARM = "disarm"

Answers = Mapping[int, tuple[str, ...]]
"""Modes of which the first possible one is entered, by the value of a parameter."""

ON_LINK_LOSS: Mapping[str, Answers] = {
    "copter": {
        1: ("return", "land"),
        2: ("return", "land"),
        3: ("smart_return", "return", "land"),
        4: ("smart_return", "land"),
        5: ("land",),
        6: ("return", "land"),
        7: ("brake", "land"),
    },
    "sub": {1: (), 2: (DISARM,), 3: ("alt_hold",), 4: ("surface",)},
}
ROVER_ACTIONS: Answers = {
    1: ("return", "brake"),
    2: ("brake",),
    3: ("smart_return", "return", "brake"),
    4: ("smart_return", "brake"),
    5: (DISARM,),
    6: ("loiter", "brake"),
}
ON_BATTERY: Mapping[str, Answers] = {
    "copter": {**ON_LINK_LOSS["copter"], 1: ("land",), 5: (DISARM,)},
    "sub": {2: (DISARM,), 3: ("surface",)},
    "rover": ROVER_ACTIONS,
}
ON_BREACH: Mapping[str, Answers] = {
    "copter": {
        1: ("return", "land"),
        2: ("land",),
        3: ("smart_return", "return", "land"),
        4: ("brake", "land"),
        5: ("smart_return", "land"),
    },
    "sub": {},
    "rover": ROVER_ACTIONS,
}
"""A submarine only reports a breach (``ArduSub/fence.cpp``)."""

CONTINUE_IN_AUTO = 2
"""Bit of a copter's FS_OPTIONS: a mission continues without a ground station."""


def watch(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Detect failures, and answer each once."""
    _watch_position(pilot, seconds)
    watch_fence(pilot, "FENCE_ENABLE", outside_fence, _answer_breach)
    if not pilot.armed:
        pilot.failed.pop("gcs", None)
        return
    _watch_link(pilot)
    if pilot.settings.tells_battery:
        _watch_battery(pilot, "CRT", "critical")
        _watch_battery(pilot, "LOW", "low")


def _watch_position(pilot: SimulatedAutopilot, seconds: float) -> None:
    if pilot.located:
        pilot.failed.pop("position", None)
        pilot.failed.pop("ekf", None)
        return
    lost = pilot.failed["position"] = pilot.failed.get("position", 0.0) + seconds
    if not pilot.armed or pilot.mode_name in BLIND or lost <= EKF_SECONDS or "ekf" in pilot.failed:
        return
    pilot.failed["ekf"] = pilot.time
    action = pilot.parameters["FS_EKF_ACTION"]
    if action:
        pilot.enter(*(("alt_hold",) if action == 2.0 else ("land", "surface", "brake", "manual")))
        pilot.say(CRITICAL, f"EKF Failsafe: changed to {pilot.mode_name.upper()} Mode")


def _watch_link(pilot: SimulatedAutopilot) -> None:
    if pilot.last_heartbeat is None:
        return
    limit = pilot.parameters["FS_GCS_TIMEOUT"] + pilot.parameters.get("FS_TIMEOUT", 0.0)
    if pilot.time - pilot.last_heartbeat < max(limit, pilot.link_timeout):
        if pilot.failed.pop("gcs", None) is not None and pilot.settings.kind != "sub":
            pilot.say(WARNING, "GCS Failsafe Cleared")
        return
    enabled = int(pilot.parameters["FS_GCS_ENABLE"])
    if not enabled or "gcs" in pilot.failed:
        return
    pilot.failed["gcs"] = pilot.time
    in_auto = pilot.mode_name == "auto"
    if pilot.settings.kind == "sub":
        pilot.say(WARNING, f"MYGCS: {pilot.parameters['SYSID_MYGCS']:.0f}, heartbeat lost")
    elif pilot.flies and in_auto and int(pilot.parameters["FS_OPTIONS"]) & CONTINUE_IN_AUTO:
        pilot.say(WARNING, "GCS Failsafe - Continuing Auto Mode")
        return
    else:
        pilot.say(WARNING, "GCS Failsafe")
    if pilot.settings.kind != "rover":
        _answer(pilot, ON_LINK_LOSS[pilot.settings.kind].get(enabled, ()))
    elif not (enabled == 2 and in_auto):
        _answer(pilot, ROVER_ACTIONS.get(int(pilot.parameters["FS_ACTION"]), ()))


def _watch_battery(pilot: SimulatedAutopilot, level: str, word: str) -> None:
    volts, reserve = pilot.parameters[f"BATT_{level}_VOLT"], pilot.parameters[f"BATT_{level}_MAH"]
    left = pilot.parameters["BATT_CAPACITY"] - pilot.battery.used
    if not (pilot.battery.voltage < volts or left < reserve):
        pilot.failed.pop(f"{level} since", None)
        return
    since = pilot.failed.setdefault(f"{level} since", pilot.time)
    if pilot.time - since < pilot.parameters["BATT_LOW_TIMER"] or level in pilot.failed:
        return
    pilot.failed[level] = pilot.time
    used = f"{pilot.battery.voltage:.2f}V used {pilot.battery.used:.0f} mAh"
    pilot.say(CRITICAL, f"Battery 1 is {word} {used}")
    _answer(pilot, ON_BATTERY[pilot.settings.kind].get(int(pilot.parameters[f"BATT_FS_{level}_ACT"]), ()))


def outside_fence(pilot: SimulatedAutopilot) -> bool:
    """Return whether a vehicle is outside the parts of its fence that FENCE_TYPE enables."""
    enabled = int(pilot.parameters["FENCE_TYPE"])
    north, east, up = pilot.body.position
    if enabled & 1 and pilot.flies and up > pilot.parameters["FENCE_ALT_MAX"]:
        return True
    if enabled & 2 and (north**2 + east**2) ** 0.5 > pilot.parameters["FENCE_RADIUS"]:
        return True
    return bool(enabled & 4) and not inside_zones(pilot)


def _answer_breach(pilot: SimulatedAutopilot) -> None:
    pilot.say(mavlink.MAV_SEVERITY_NOTICE, "Polygon fence breached")
    if pilot.armed and pilot.parameters["FENCE_ENABLE"]:
        _answer(pilot, ON_BREACH[pilot.settings.kind].get(int(pilot.parameters["FENCE_ACTION"]), ()))


def _answer(pilot: SimulatedAutopilot, names: tuple[str, ...]) -> None:
    if (pilot.flies and not pilot.airborne and names) or names == (DISARM,):
        pilot.disarm()
    else:
        pilot.enter(*names)
