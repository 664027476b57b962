"""What a vehicle still lacks before it may be armed, in words: all of it, not the first thing only."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link
from ..links.messages import tells_place
from .texts import Texts

PREARM = mavlink.MAV_SYS_STATUS_PREARM_CHECK
REPEATED_SECONDS = 35.0
"""ArduPilot says every 30 seconds again what fails."""

FIX_3D = 3
FIXES = {0: "no GPS", 1: "no GPS fix", 2: "a GPS fix without height"}

EKF: Mapping[int, str] = {
    1: "attitude",
    2: "horizontal velocity",
    4: "vertical velocity",
    16: "horizontal position",
    32: "height",
}
"""What the estimator must know, by bit of EKF_STATUS_REPORT (ArduPilot) and ESTIMATOR_STATUS (PX4)."""

ESTIMATE = "EKF_STATUS_REPORT"
"""In its first seconds an ArduPilot reports a position and passed checks, and no estimate yet."""

NEAR = 8
"""The bit for a horizontal position relative to the start, which is enough for local programs."""

CONSTANT, UNINITIALISED = 128, 1024
"""Bits of EKF_STATUS_REPORT alone: a PX4 sets the former in ESTIMATOR_STATUS also where it knows its position
and stands still (``ekf_helper.cpp``, ``get_ekf_soln_status``)."""

SENSORS: Mapping[int, str] = {
    1: "gyroscope",
    2: "accelerometer",
    4: "compass",
    8: "barometer",
    32: "GPS",
    64: "optical flow",
    65_536: "radio control",
    1_048_576: "geofence",
    2_097_152: "attitude and heading",
    4_194_304: "terrain data",
    16_777_216: "logging",
    33_554_432: "battery",
    67_108_864: "proximity sensor",
    536_870_912: "obstacle avoidance",
    1_073_741_824: "propulsion",
}
"""Parts of a vehicle by bit of SYS_STATUS."""


def lacks(link: Link, texts: Texts, position: str, *, geographic: bool) -> tuple[str, ...]:
    """Return what a vehicle lacks; empty when it knows its position and its own checks pass.

    Args:
        link: to the vehicle.
        texts: of the vehicle.
        position: the message with its position.
        geographic: whether it must know its geographic position.
    """
    found = [*_unlocated(link, position, geographic=geographic)]
    status = link.latest("SYS_STATUS")
    if status is None:
        found.append("it has not reported its state (SYS_STATUS)")
    elif _checks_fail(link, status):
        found.append(_why(link, status, texts))
    return tuple(found)


def unlocated(link: Link, *, geographic: bool) -> str:
    """Return why a vehicle that told its position before does not know it now; empty if it does."""
    return ", ".join([*_estimate_trouble(link, geographic=geographic), *_fix_trouble(link, geographic)])


def _unlocated(link: Link, position: str, *, geographic: bool) -> Iterator[str]:
    reported = link.latest(position)
    if reported is None or not tells_place(reported):
        yield f"it has not reported its position ({position})"
    if ESTIMATE in link.profile.autopilot.streamed and link.latest(ESTIMATE) is None:
        yield f"it has not reported what its estimator knows ({ESTIMATE})"
    yield from _estimate_trouble(link, geographic=geographic)
    yield from _fix_trouble(link, geographic)


def _estimate_trouble(link: Link, *, geographic: bool) -> Iterator[str]:
    """Yield what the estimator does not know; a vehicle that tells nothing of it is believed."""
    ekf = link.latest(ESTIMATE)
    estimate = ekf or link.latest("ESTIMATOR_STATUS")
    if estimate is None:
        return
    if ekf is not None and ekf.flags & UNINITIALISED:
        yield "its estimator (EKF) has not begun"
        return
    known = estimate.flags | (16 if not geographic and estimate.flags & NEAR else 0)
    needed = {16: EKF[16]} if not _tells_all(known) else EKF
    missing = [name for bit, name in needed.items() if not known & bit]
    if missing:
        yield f"its estimator (EKF) knows no {' and no '.join(missing)}"
    elif ekf is not None and ekf.flags & CONSTANT:
        yield "its estimator (EKF) only assumes that it stands still"


def _tells_all(flags: int) -> bool:
    """Return whether more than the position is reported, as real vehicles do."""
    return bool(flags & ~16)


def _fix_trouble(link: Link, geographic: bool) -> Iterator[str]:
    gps = link.latest("GPS_RAW_INT")
    if geographic and gps is not None and gps.fix_type < FIX_3D:
        seen = "" if gps.satellites_visible == 255 else f" ({gps.satellites_visible} satellites)"
        yield f"it has {FIXES.get(gps.fix_type, 'no GPS fix')}{seen}"


def _checks_fail(link: Link, status: object) -> bool:
    """Return whether the vehicle's own checks fail, as far as it must report that they pass."""
    health, present = (
        int(getattr(status, f"onboard_control_sensors_{word}")) for word in ("health", "present")
    )
    beat = link.latest("HEARTBEAT")
    if health & PREARM:
        return False
    if beat is None:
        return True
    armed = bool(beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
    return link.profile.autopilot.must_report_checks(armed, beat.custom_mode) or bool(present & PREARM)


def _why(link: Link, status: object, texts: Texts) -> str:
    said = texts.starting_with(link.profile.autopilot.refusals, REPEATED_SECONDS)
    if said:
        return f"its own checks fail: {'; '.join(said)}"
    enabled, health = (
        int(getattr(status, f"onboard_control_sensors_{word}")) for word in ("enabled", "health")
    )
    ill = [name for bit, name in SENSORS.items() if enabled & bit and not health & bit]
    return f"its own checks fail{': unhealthy: ' if ill else ''}{', '.join(ill)}"
