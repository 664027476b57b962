"""Failsafes of a simulated PX4, as its ``commander/failsafe`` has them.

Before it returns or lands it holds for COM_FAIL_ACT_T, so that the pilot can intervene, unless its mode
cannot continue without set-points or a position. A mode change during the hold cancels the failsafe.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Failsafe, SimulatedAutopilot
from mmrs_mavlink.sitl.fences import inside_zones, watch_fence
from mmrs_mavlink.sitl.modes import BLIND

CRITICAL, INFO = mavlink.MAV_SEVERITY_CRITICAL, mavlink.MAV_SEVERITY_INFO
DISARM = "disarm"

Answers = Mapping[int, tuple[str, ...]]

ON_LINK_LOSS: Answers = {1: ("loiter",), 2: ("return", "land"), 3: ("land",), 5: (DISARM,), 6: (DISARM,)}
"""Answers by NAV_DLL_ACT."""

EXEMPT = {"auto": 1, "loiter": 2, "take_off": 2, "return": 2, "guided": 4}
"""Bits of COM_DLL_EXCEPT that exempt a mode."""

ON_BREACH: Answers = {2: ("loiter",), 3: ("return", "land"), 4: (DISARM,), 5: ("land",)}
"""Answers by GF_ACTION; 1 only warns."""

ON_CRITICAL: Answers = {1: ("return", "land"), 2: ("land",), 3: ("return", "land")}
ON_EMERGENCY: Answers = {1: ("return", "land"), 2: ("land",), 3: ("land",)}
"""Answers by COM_LOW_BAT_ACT to a critical and to a nearly empty battery."""

ON_SETPOINT_LOSS: Answers = {
    0: ("poshold",),
    1: ("alt_hold",),
    2: ("stabilize",),
    3: ("return", "land"),
    4: ("land",),
    5: ("loiter",),
    6: (DISARM,),
    7: (DISARM,),
}
"""Answers by COM_OBL_RC_ACT."""


def watch(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Detect failures, and answer them."""
    _watch_position(pilot, seconds)
    watch_fence(pilot, "GF_ACTION", _outside, _answer_breach)
    if not pilot.armed:
        pilot.failsafe = None
        pilot.failed.pop("gcs", None)
        pilot.failed.pop("stream", None)
        return
    _watch_link(pilot)
    if pilot.settings.tells_battery:
        _watch_battery(pilot)
    _watch_stream(pilot)
    _end_hold(pilot)


def _answer_breach(pilot: SimulatedAutopilot) -> None:
    pilot.say(CRITICAL, "Geofence: approaching or outside geofence")
    action = int(pilot.parameters["GF_ACTION"])
    _answer(pilot, ON_BREACH.get(action, ()), at_once=action == 2)


def _watch_position(pilot: SimulatedAutopilot, seconds: float) -> None:
    if pilot.located:
        pilot.failed.pop("position", None)
        return
    before = pilot.failed.get("position", 0.0)
    lost = pilot.failed["position"] = before + seconds
    if pilot.armed and pilot.mode_name not in BLIND and before <= pilot.parameters["COM_POS_FS_DELAY"] < lost:
        _answer(pilot, ("return", "land"), at_once=True)


def _outside(pilot: SimulatedAutopilot) -> bool:
    north, east, up = pilot.body.position
    far, high = pilot.parameters["GF_MAX_HOR_DIST"], pilot.parameters["GF_MAX_VER_DIST"]
    return 0.0 < far < hypot(north, east) or 0.0 < high < up or not inside_zones(pilot)


def _watch_link(pilot: SimulatedAutopilot) -> None:
    if pilot.last_heartbeat is None:
        return
    if pilot.time - pilot.last_heartbeat < max(pilot.parameters["COM_DL_LOSS_T"], pilot.link_timeout):
        if pilot.failed.pop("gcs", None) is not None:
            pilot.say(INFO, "GCS connection regained")
    elif "gcs" not in pilot.failed:
        pilot.failed["gcs"] = pilot.time
        pilot.say(INFO, "Connection to ground station lost")
        exempt = int(pilot.parameters["COM_DLL_EXCEPT"]) & EXEMPT.get(pilot.mode_name, 0)
        if pilot.mode_name != "land" and not exempt:
            _answer(pilot, ON_LINK_LOSS.get(int(pilot.parameters["NAV_DLL_ACT"]), ()))


def _watch_battery(pilot: SimulatedAutopilot) -> None:
    action = int(pilot.parameters["COM_LOW_BAT_ACT"])
    for name, text, answers in (
        ("BAT_LOW_THR", "Low battery", {}),
        ("BAT_CRIT_THR", "Critical battery", ON_CRITICAL),
        ("BAT_EMERGEN_THR", "Emergency battery level", ON_EMERGENCY),
    ):
        if pilot.battery.level < pilot.parameters[name] and name not in pilot.failed:
            pilot.failed[name] = pilot.time
            pilot.say(CRITICAL, text)
            pilot.failsafe = pilot.failsafe or Failsafe()
            _answer(pilot, answers.get(action, ()))


def _watch_stream(pilot: SimulatedAutopilot) -> None:
    """Leave OFFBOARD when set-points stop, and return to it when they resume."""
    if pilot.mode_name == "guided" and pilot.setpoints:
        if pilot.time - pilot.setpoints[-1] > max(pilot.parameters["COM_OF_LOSS_T"], pilot.link_timeout):
            answers = ON_SETPOINT_LOSS.get(int(pilot.parameters["COM_OBL_RC_ACT"]), ())
            _answer(pilot, answers, at_once=True)
            pilot.failed["stream"] = pilot.time
    elif "stream" in pilot.failed:
        if not _in_chosen_mode(pilot) or "gcs" in pilot.failed:
            del pilot.failed["stream"]
        elif pilot.is_steered:
            del pilot.failed["stream"]
            pilot.enter("guided")


def _answer(pilot: SimulatedAutopilot, names: tuple[str, ...], *, at_once: bool = False) -> None:
    """Enter the first possible one of these modes, after a hold unless `at_once`; none: continue."""
    if not names:
        return
    pilot.failsafe = pilot.failsafe or Failsafe()
    if names == (DISARM,) or (pilot.flies and not pilot.airborne):
        pilot.disarm()
        return
    holds = 0.0 if at_once or names[0] == "loiter" else pilot.parameters["COM_FAIL_ACT_T"]
    if holds and pilot.mode_name not in ("return", "land"):
        pilot.say(CRITICAL, f"Failsafe activated, entering Hold for {holds:.0f} seconds")
        _choose(pilot, "loiter")
        pilot.failsafe = Failsafe(pilot.mode, names, pilot.time + holds)
    else:
        pilot.say(CRITICAL, "Failsafe activated")
        _choose(pilot, *names)


def _choose(pilot: SimulatedAutopilot, *names: str) -> None:
    pilot.enter(*names)
    pilot.failsafe = replace(pilot.failsafe or Failsafe(), mode=pilot.mode)


def _end_hold(pilot: SimulatedAutopilot) -> None:
    """Enter the chosen mode after the hold, unless another mode was set meanwhile."""
    failsafe = pilot.failsafe
    if failsafe is None or not failsafe.then:
        return
    chosen = _in_chosen_mode(pilot)
    if chosen and pilot.time < failsafe.until:
        return
    pilot.failsafe = Failsafe(failsafe.mode)
    if chosen:
        pilot.say(CRITICAL, "Failsafe activated")
        _choose(pilot, *failsafe.then)


def _in_chosen_mode(pilot: SimulatedAutopilot) -> bool:
    return pilot.failsafe is not None and pilot.mode == pilot.failsafe.mode
