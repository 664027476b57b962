"""What the vehicle watches by itself, and what its parameters make it do."""

from __future__ import annotations

from collections.abc import Mapping

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import px4_failsafes
from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.fences import fence_of, watch_fence
from mmrs_mavlink.sitl.modes import BLIND
from mmrs_mavlink.sitl.settings import PX4

CRITICAL = mavlink.MAV_SEVERITY_CRITICAL
WARNING = mavlink.MAV_SEVERITY_WARNING
EKF_SECONDS = 1.0
DISARM = "disarm"

Answers = Mapping[int, tuple[str, ...]]

ON_SILENCE: Mapping[str, Answers] = {
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
ON_ROVERS_LOSS: Answers = {
    1: ("return", "brake"),
    2: ("brake",),
    3: ("smart_return", "return", "brake"),
    4: ("smart_return", "brake"),
    5: (DISARM,),
    6: ("loiter", "brake"),
}
ON_BATTERY: Mapping[str, Answers] = {
    "copter": {
        1: ("land",),
        2: ("return", "land"),
        3: ("smart_return", "return", "land"),
        4: ("smart_return", "land"),
        5: (DISARM,),
        6: ("return", "land"),
        7: ("brake", "land"),
    },
    "sub": {2: (DISARM,), 3: ("surface",)},
    "rover": ON_ROVERS_LOSS,
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
    "rover": ON_ROVERS_LOSS,
}
"""A submarine only says that its fence is broken (``ArduSub/fence.cpp``)."""

ON_IN_MISSIONS = 2
"""Of a copter's FS_OPTIONS: missions go on although the ground is not heard."""


def watch(pilot: Autopilot, seconds: float) -> None:
    """Look for what is wrong, and answer it once."""
    if pilot.settings.firmware == PX4:
        px4_failsafes.watch(pilot, seconds)
        return
    _watch_position(pilot, seconds)
    watch_fence(pilot, "FENCE_ENABLE", outside_fence, breach)
    if not pilot.armed:
        pilot.failed.pop("gcs", None)
        return
    _watch_link(pilot)
    _watch_battery(pilot)


def _watch_position(pilot: Autopilot, seconds: float) -> None:
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
        names = ("alt_hold",) if action == 2.0 else ("land", "surface", "brake", "manual")
        pilot.enter(*names)
        pilot.say(CRITICAL, f"EKF Failsafe: changed to {pilot.mode_name.upper()} Mode")


def _watch_link(pilot: Autopilot) -> None:
    if pilot.heard is None:
        return
    limit = pilot.parameters["FS_GCS_TIMEOUT"] + pilot.parameters.get("FS_TIMEOUT", 0.0)
    if pilot.time - pilot.heard < max(limit, pilot.patience):
        if pilot.failed.pop("gcs", None) is not None and pilot.settings.kind != "sub":
            pilot.say(WARNING, "GCS Failsafe Cleared")
        return
    enabled = pilot.parameters["FS_GCS_ENABLE"]
    if not enabled or "gcs" in pilot.failed:
        return
    pilot.failed["gcs"] = pilot.time
    if pilot.settings.kind == "sub":
        pilot.say(WARNING, f"MYGCS: {pilot.parameters['SYSID_MYGCS']:.0f}, heartbeat lost")
    elif _goes_on(pilot):
        pilot.say(WARNING, "GCS Failsafe - Continuing Auto Mode")
        return
    else:
        pilot.say(WARNING, "GCS Failsafe")
    _answer(pilot, _on_silence(pilot, int(enabled)))


def _goes_on(pilot: Autopilot) -> bool:
    """Return whether a copter is to go on with its mission although it hears no ground."""
    exempt = int(pilot.parameters["FS_OPTIONS"]) & ON_IN_MISSIONS
    return bool(pilot.flies and exempt and pilot.mode_name == "auto")


def _on_silence(pilot: Autopilot, enabled: int) -> tuple[str, ...]:
    if pilot.settings.kind == "rover":
        if enabled == 2 and pilot.mode_name == "auto":
            return ()
        return ON_ROVERS_LOSS.get(int(pilot.parameters["FS_ACTION"]), ())
    return ON_SILENCE[pilot.settings.kind].get(enabled, ())


def _watch_battery(pilot: Autopilot) -> None:
    if not pilot.settings.tells_battery:
        return
    for name, action in (("CRT", "BATT_FS_CRT_ACT"), ("LOW", "BATT_FS_LOW_ACT")):
        volts, reserve = pilot.parameters[f"BATT_{name}_VOLT"], pilot.parameters[f"BATT_{name}_MAH"]
        left = pilot.parameters["BATT_CAPACITY"] - pilot.battery.used
        if not (pilot.battery.voltage < volts or left < reserve):
            pilot.failed.pop(f"{name} since", None)
            continue
        since = pilot.failed.setdefault(f"{name} since", pilot.time)
        if pilot.time - since >= pilot.parameters["BATT_LOW_TIMER"] and name not in pilot.failed:
            pilot.failed[name] = pilot.time
            word = "low" if name == "LOW" else "critical"
            used = f"{pilot.battery.voltage:.2f}V used {pilot.battery.used:.0f} mAh"
            pilot.say(CRITICAL, f"Battery 1 is {word} {used}")
            _answer(pilot, ON_BATTERY[pilot.settings.kind].get(int(pilot.parameters[action]), ()))


def breach(pilot: Autopilot) -> None:
    """Be out of the fence, say so, and do what FENCE_ACTION, or a PX4's GF_ACTION, says."""
    if pilot.settings.firmware == PX4:
        px4_failsafes.breach(pilot)
        return
    pilot.breached = True
    pilot.breaches += 1
    pilot.say(mavlink.MAV_SEVERITY_NOTICE, "Polygon fence breached")
    if pilot.armed and pilot.parameters["FENCE_ENABLE"]:
        _answer(pilot, ON_BREACH[pilot.settings.kind].get(int(pilot.parameters["FENCE_ACTION"]), ()))


def outside_fence(pilot: Autopilot) -> bool:
    """Return whether it is where its fence does not let it be, by what FENCE_TYPE heeds."""
    heeded = int(pilot.parameters["FENCE_TYPE"])
    north, east, up = pilot.body.position
    if heeded & 1 and pilot.flies and up > pilot.parameters["FENCE_ALT_MAX"]:
        return True
    if heeded & 2 and (north**2 + east**2) ** 0.5 > pilot.parameters["FENCE_RADIUS"]:
        return True
    return bool(heeded & 4) and not all(zone.allows((north, east)) for zone in fence_of(pilot))


def _answer(pilot: Autopilot, names: tuple[str, ...]) -> None:
    if (pilot.flies and not pilot.airborne and names) or names == (DISARM,):
        pilot.disarm()
    else:
        pilot.enter(*names)
