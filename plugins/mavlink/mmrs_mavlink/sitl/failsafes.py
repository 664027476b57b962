"""Failsafes of a simulated vehicle, as its parameters configure them; of its fence, limits about its home."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import BLIND, SimulatedAutopilot
from mmrs_mavlink.sitl.settings import ARDUPILOT, PX4

DISARM = "disarm"

EKF_SECONDS = 3.3
"""Time from the loss of its satellites to the failsafe, as measured on ArduCopter 4.7-dev."""

_COPTER = {3: "smart_return return land", 4: "smart_return land"}
_ROVER = {1: "return hold", 2: "hold", 3: "smart_return return hold", 4: "smart_return hold", 5: DISARM}
ANSWERS: Mapping[str, Mapping[str, Mapping[int, str]]] = {
    "arducopter": {
        "FS_GCS_ENABLE": {1: "return land", 2: "return land", **_COPTER, 5: "land", 7: "hold land"},
        "BATT_FS_LOW_ACT": {1: "land", 2: "return land", **_COPTER, 5: DISARM},
        "FENCE_ACTION": {1: "return land", 2: "land", 3: _COPTER[3], 4: "hold land", 5: _COPTER[4]},
        "FS_EKF_ACTION": {1: "land", 2: "altitude_hold", 3: "land"},
    },
    "ardurover": {
        "FS_ACTION": {**_ROVER, 6: "loiter"},
        "BATT_FS_LOW_ACT": _ROVER,
        "FENCE_ACTION": _ROVER,
        "FS_EKF_ACTION": {1: "hold"},
    },
    "ardusub": {
        "FS_GCS_ENABLE": {2: DISARM, 3: "depth_hold", 4: "surface"},
        "BATT_FS_LOW_ACT": {2: DISARM, 3: "surface"},
        "FS_EKF_ACTION": {2: DISARM},
    },
    "px4-multicopter": {
        "NAV_DLL_ACT": {1: "hold", 2: "return land", 3: "land", 6: DISARM},
        "COM_OBL_RC_ACT": {0: "position", 1: "altitude", 2: "stabilize", 3: "return land", 4: "land"}
        | {5: "hold", 7: DISARM},
    },
}
"""Modes of which the first possible one is entered, by profile, parameter and value."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A failure that an armed vehicle detects.

    Attributes:
        present: returns whether it is present.
        text: reported when it is answered. cleared: reported when it is over; empty: nothing.
        parameter: its value chooses the answer; empty: that of the failsafe for a lost link.
        lasting: seconds, or the parameter for them, until it is answered.
    """

    present: Callable[[SimulatedAutopilot], bool]
    text: str
    parameter: str = ""
    cleared: str = ""
    lasting: str | float = 0.0


def watch(pilot: SimulatedAutopilot) -> None:
    """Detect failures, and answer each once."""
    pilot.breached = pilot.forced_breach or (pilot.located and _outside_fence(pilot))
    for name, failure in FAILURES[pilot.settings.firmware].items():
        if not (pilot.armed and failure.present(pilot)):
            pilot.failing.pop(name, None)
            if name in pilot.answered:
                pilot.answered.remove(name)
                if failure.cleared and pilot.armed:
                    pilot.say(mavlink.MAV_SEVERITY_WARNING, failure.cleared)
            continue
        since = pilot.failing.setdefault(name, pilot.time)
        lasting = pilot.parameters[failure.lasting] if isinstance(failure.lasting, str) else failure.lasting
        if name not in pilot.answered and pilot.time - since >= lasting:
            pilot.answered.add(name)
            _answer(pilot, failure)


def _answer(pilot: SimulatedAutopilot, failure: Failure) -> None:
    """Enter the mode of a failsafe, and announce it; an ArduRover announces no broken fence."""
    profile = pilot.settings.profile
    parameter = failure.parameter or next(iter(profile.lost_link.modes))
    answers = ANSWERS[profile.name].get(parameter, {})
    names = answers.get(int(pilot.parameters[parameter]), "").split()
    if names == [DISARM] or (names and pilot.flies and not pilot.airborne):
        pilot.disarm()
    else:
        pilot.enter(*names)
    if failure.parameter != "FENCE_ACTION" or pilot.settings.kind != "rover":
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, failure.text.format(mode=pilot.mode_name.upper()))


def _outside_fence(pilot: SimulatedAutopilot) -> bool:
    fence, values = pilot.settings.profile.autopilot.fence, pilot.parameters
    if not values.get(fence.enabled_by, 1):
        return False
    enabled = int(values[fence.types]) if fence.types else -1
    north, east, up = pilot.body.position
    extents = {"radius": hypot(north, east), "height": up if pilot.flies else 0.0}
    limits = [each for each in fence.limits if not fence.types or enabled & each.bit]
    return any(0.0 < values[each.parameter] < extents[each.of] for each in limits)


def _has_no_position(pilot: SimulatedAutopilot) -> bool:
    return not pilot.located and pilot.mode_name not in BLIND


def _has_no_link(pilot: SimulatedAutopilot) -> bool:
    """Return whether heartbeats are missing for long enough, and its failsafe is on."""
    values, failsafe = pilot.parameters, pilot.settings.profile.lost_link
    if pilot.last_heartbeat is None or not values.get(failsafe.enabled_by, 1):
        return False
    limit = sum(values.get(name, 0.0) for name in ("FS_GCS_TIMEOUT", "COM_DL_LOSS_T"))
    return pilot.time - pilot.last_heartbeat >= max(limit, pilot.link_timeout)


def _has_no_setpoints(pilot: SimulatedAutopilot) -> bool:
    if pilot.mode_name != "guided" or not pilot.setpoints:
        return False
    limit = max(pilot.parameters["COM_OF_LOSS_T"], pilot.link_timeout)
    return pilot.time - pilot.setpoints[-1] > limit


def _has_low_battery(pilot: SimulatedAutopilot) -> bool:
    values, battery = pilot.parameters, pilot.battery
    left = values["BATT_CAPACITY"] - battery.used
    low = battery.voltage < values["BATT_LOW_VOLT"] or left < values["BATT_LOW_MAH"]
    return pilot.settings.tells_battery and low


FAILURES: Mapping[str, Mapping[str, Failure]] = {
    ARDUPILOT: {
        "position": Failure(
            _has_no_position, "EKF Failsafe: changed to {mode} Mode", "FS_EKF_ACTION", lasting=EKF_SECONDS
        ),
        "fence": Failure(
            lambda pilot: pilot.breached and pilot.parameters["FENCE_ENABLE"] > 0.0,
            "Circle fence breached",
            "FENCE_ACTION",
        ),
        "link": Failure(_has_no_link, "GCS Failsafe", cleared="GCS Failsafe Cleared"),
        "low": Failure(_has_low_battery, "Battery 1 is low", "BATT_FS_LOW_ACT", lasting="BATT_LOW_TIMER"),
    },
    PX4: {
        "link": Failure(_has_no_link, "Connection to ground station lost", cleared="GCS connection regained"),
        "setpoints": Failure(_has_no_setpoints, "Failsafe activated", "COM_OBL_RC_ACT"),
    },
}
