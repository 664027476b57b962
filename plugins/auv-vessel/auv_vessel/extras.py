"""What `Sheet.extra` may say of a vehicle: names that nobody reads are refused, with the nearest."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields

from auv_vessel.instruments import Instruments
from auv_vessel.sheet import Sheet, unknown

_ALONG, _ABOUT = ("surge", "sway", "heave"), ("roll", "pitch", "yaw")
_AXES = {
    "added_mass": _ALONG,
    "linear_drag": (*_ALONG, *_ABOUT),
    "quadratic_drag": (*_ALONG, *_ABOUT),
    "inertia": _ABOUT,
    "added_inertia": _ABOUT,
}

EXTRAS = frozenset((
    *(each.name.replace("_", ".", 1) for each in fields(Instruments)),
    *(f"{name}.{axis}" for name, axes in _AXES.items() for axis in axes),
    "righting_arm", "munk", "thruster.lag", "deadman.time", "antenna.height", "sonar.range",
    "peak.time", "rise.time", "power.limit", "climb.speed", "turn.rate", "search.radius", "search.spacing",
    "movement.patience", "position.lost", "bottom.clearance",
    "camera.front.forward", "camera.front.down", "camera.bottom.forward", "camera.bottom.down",
    "camera.baseline", "camera.focal",
))  # fmt: skip
"""All names but those of devices, which are ``device0.seconds``, ``device1.seconds`` and so on."""

_DEVICE = re.compile(r"device(0|[1-9][0-9]{0,8})\.seconds")


def misnamed(sheet: Sheet) -> Iterator[str]:
    """Yield a line for each name of a sheet's `extra` that nobody reads."""
    devices = [f"device{number}.seconds" for number in range(len(sheet.devices))]
    for key in sheet.extra:
        found = _DEVICE.fullmatch(key) if isinstance(key, str) else None
        if found and int(found[1]) >= len(devices):
            yield f"extra {key!r}: there is no device {found[1]}, there are {len(devices)}"
        elif not found and key not in EXTRAS:
            yield f"extra {key!r}: {unknown(key, (*EXTRAS, *devices))}"
