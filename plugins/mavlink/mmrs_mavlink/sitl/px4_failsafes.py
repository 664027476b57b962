"""What a PX4 watches by itself, and does by its parameters, as its ``commander/failsafe`` has it.

Before it returns or lands it holds for COM_FAIL_ACT_T, so that a pilot may intervene, but not where its
mode cannot go on: without set-points or a position. Whoever gives it another mode meanwhile has it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.fences import fence_of, watch_fence
from mmrs_mavlink.sitl.modes import BLIND

CRITICAL, INFO = mavlink.MAV_SEVERITY_CRITICAL, mavlink.MAV_SEVERITY_INFO
DISARM = "disarm"

Answers = Mapping[int, tuple[str, ...]]

ON_SILENCE: Answers = {1: ("loiter",), 2: ("return", "land"), 3: ("land",), 5: (DISARM,), 6: (DISARM,)}
"""By NAV_DLL_ACT."""

EXEMPT = {"auto": 1, "loiter": 2, "take_off": 2, "return": 2, "guided": 4}
"""By mode, the bit of COM_DLL_EXCEPT by which nothing is done then."""

ON_BREACH: Answers = {2: ("loiter",), 3: ("return", "land"), 4: (DISARM,), 5: ("land",)}
"""By GF_ACTION; 1: it only says so."""

ON_CRITICAL: Answers = {1: ("return", "land"), 2: ("land",), 3: ("return", "land")}
ON_EMERGENCY: Answers = {1: ("return", "land"), 2: ("land",), 3: ("land",)}
"""By COM_LOW_BAT_ACT, where the battery is critical, and nearly empty."""

ON_STILLNESS: Answers = {
    0: ("poshold",),
    1: ("alt_hold",),
    2: ("stabilize",),
    3: ("return", "land"),
    4: ("land",),
    5: ("loiter",),
    6: (DISARM,),
    7: (DISARM,),
}
"""By COM_OBL_RC_ACT, where set-points stay away."""


@dataclass(frozen=True, slots=True)
class Failsafe:
    """What a PX4 does because something is wrong.

    Attributes:
        mode: number of the mode that it has chosen; None: it has chosen none, and goes on.
        then: modes of which it goes into the first that it may, once it has held; none: it does not hold.
        until: when it has held for long enough.
    """

    mode: int | None = None
    then: tuple[str, ...] = ()
    until: float = 0.0


def watch(pilot: Autopilot, seconds: float) -> None:
    """Look for what is wrong, and answer it."""
    _watch_position(pilot, seconds)
    watch_fence(pilot, "GF_ACTION", _outside, breach)
    if not pilot.armed:
        pilot.failsafe = None
        pilot.failed.pop("gcs", None)
        pilot.failed.pop("stream", None)
        return
    _watch_link(pilot)
    _watch_battery(pilot)
    _watch_stream(pilot)
    _go_on(pilot)


def breach(pilot: Autopilot) -> None:
    """Be out of the fence, say so, and do what GF_ACTION says."""
    pilot.breached = True
    pilot.breaches += 1
    pilot.say(CRITICAL, "Geofence: approaching or outside geofence")
    action = int(pilot.parameters["GF_ACTION"])
    _answer(pilot, ON_BREACH.get(action, ()), at_once=action == 2)


def _watch_position(pilot: Autopilot, seconds: float) -> None:
    if pilot.located:
        pilot.failed.pop("position", None)
        return
    before = pilot.failed.get("position", 0.0)
    lost = pilot.failed["position"] = before + seconds
    if pilot.armed and pilot.mode_name not in BLIND and before <= pilot.parameters["COM_POS_FS_DELAY"] < lost:
        _answer(pilot, ("return", "land"), at_once=True)


def _outside(pilot: Autopilot) -> bool:
    north, east, up = pilot.body.position
    far, high = pilot.parameters["GF_MAX_HOR_DIST"], pilot.parameters["GF_MAX_VER_DIST"]
    if 0.0 < far < hypot(north, east) or 0.0 < high < up:
        return True
    return not all(zone.allows((north, east)) for zone in fence_of(pilot))


def _watch_link(pilot: Autopilot) -> None:
    if pilot.heard is None:
        return
    if pilot.time - pilot.heard < max(pilot.parameters["COM_DL_LOSS_T"], pilot.patience):
        if pilot.failed.pop("gcs", None) is not None:
            pilot.say(INFO, "GCS connection regained")
    elif "gcs" not in pilot.failed:
        pilot.failed["gcs"] = pilot.time
        pilot.say(INFO, "Connection to ground station lost")
        exempt = int(pilot.parameters["COM_DLL_EXCEPT"]) & EXEMPT.get(pilot.mode_name, 0)
        if pilot.mode_name != "land" and not exempt:
            _answer(pilot, ON_SILENCE.get(int(pilot.parameters["NAV_DLL_ACT"]), ()))


def _watch_battery(pilot: Autopilot) -> None:
    if not pilot.settings.tells_battery:
        return
    action = int(pilot.parameters["COM_LOW_BAT_ACT"])
    for name, text, answers in (
        ("BAT_LOW_THR", "Low battery", {}),
        ("BAT_CRIT_THR", "Critical battery", ON_CRITICAL),
        ("BAT_EMERGEN_THR", "Emergency battery level", ON_EMERGENCY),
    ):
        if pilot.battery.level < pilot.parameters[name] and name not in pilot.failed:
            pilot.failed[name] = pilot.time
            pilot.say(CRITICAL, text)
            _answer(pilot, answers.get(action, ()), warns=True)


def _watch_stream(pilot: Autopilot) -> None:
    """Leave OFFBOARD where set-points stay away, and go back by itself when they come again."""
    if pilot.mode_name == "guided" and pilot.steered:
        if pilot.time - pilot.steered[-1] > max(pilot.parameters["COM_OF_LOSS_T"], pilot.patience):
            _answer(pilot, ON_STILLNESS.get(int(pilot.parameters["COM_OBL_RC_ACT"]), ()), at_once=True)
            pilot.failed["stream"] = pilot.time
    elif "stream" in pilot.failed:
        if not _has_its_mode(pilot) or "gcs" in pilot.failed:
            del pilot.failed["stream"]
        elif pilot.is_steered():
            del pilot.failed["stream"]
            pilot.enter("guided")


def _answer(pilot: Autopilot, names: tuple[str, ...], *, at_once: bool = False, warns: bool = False) -> None:
    """Go into the first of these modes that it may go into, or hold before that for a while.

    Args:
        pilot: of the vehicle.
        names: of modes, or `DISARM`; none: it goes on.
        at_once: whether it does not hold before.
        warns: whether it counts as a failsafe, too, where it goes on.
    """
    if names or warns:
        pilot.failsafe = pilot.failsafe or Failsafe()
    if not names:
        return
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


def _choose(pilot: Autopilot, *names: str) -> None:
    pilot.enter(*names)
    pilot.failsafe = replace(pilot.failsafe or Failsafe(), mode=pilot.mode)


def _go_on(pilot: Autopilot) -> None:
    """Do what it has held for, unless somebody has given it another mode meanwhile."""
    failsafe = pilot.failsafe
    if failsafe is None or not failsafe.then:
        return
    ours = _has_its_mode(pilot)
    if ours and pilot.time < failsafe.until:
        return
    pilot.failsafe = Failsafe(failsafe.mode)
    if ours:
        pilot.say(CRITICAL, "Failsafe activated")
        _choose(pilot, *failsafe.then)


def _has_its_mode(pilot: Autopilot) -> bool:
    """Return whether it is in the mode that it has chosen by itself."""
    return pilot.failsafe is not None and pilot.mode == pilot.failsafe.mode
