"""Flight modes by name, and the numbers that each firmware has for them."""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_mavlink.sitl.settings import PX4, Settings


def _px4(main: int, sub: int = 0) -> int:
    """Return PX4's custom mode: the main mode in its third byte, the sub-mode in its fourth."""
    return main << 16 | sub << 24


MODES: Mapping[str, Mapping[str, int]] = {
    "copter": {
        "stabilize": 0,
        "alt_hold": 2,
        "auto": 3,
        "guided": 4,
        "loiter": 5,
        "return": 6,
        "land": 9,
        "poshold": 16,
        "brake": 17,
        "smart_return": 21,
    },
    "sub": {"stabilize": 0, "alt_hold": 2, "auto": 3, "guided": 4, "surface": 9, "brake": 16, "manual": 19},
    "rover": {
        "manual": 0,
        "stabilize": 3,
        "brake": 4,
        "loiter": 5,
        "auto": 10,
        "return": 11,
        "smart_return": 12,
        "guided": 15,
    },
    PX4: {
        "stabilize": _px4(7),
        "manual": _px4(1),
        "alt_hold": _px4(2),
        "poshold": _px4(3),
        "take_off": _px4(4, 2),
        "loiter": _px4(4, 3),
        "auto": _px4(4, 4),
        "return": _px4(4, 5),
        "land": _px4(4, 6),
        "guided": _px4(6),
    },
}
"""Numbers of modes by kind of vehicle, and of PX4: its OFFBOARD is ``guided``, its Hold is ``loiter``."""

BLIND = frozenset({"stabilize", "alt_hold", "manual", "land", "surface"})
"""Modes that need no position."""

MANUAL = frozenset({"stabilize", "alt_hold", "manual"})
"""Modes in which a flying vehicle drifts with the wind."""


def numbers(settings: Settings) -> Mapping[str, int]:
    """Return the modes of a vehicle, by name."""
    return MODES[PX4 if settings.firmware == PX4 else settings.kind]


def first_mode(settings: Settings) -> str:
    """Return the mode of a vehicle after boot."""
    if settings.firmware == PX4:
        return "loiter"
    return "manual" if settings.kind == "rover" else "stabilize"
