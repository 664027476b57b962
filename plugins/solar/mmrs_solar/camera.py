"""What a camera sees of panels, from its properties.

Keys of device properties, as text without units: ``sensor.width``, ``sensor.height`` and ``focal.length`` in
millimetres, ``image.width`` and ``image.height`` in pixels; the width lies along the rows that the camera
faces. ``exposure.time``, the seconds in which an image blurs (of an uncooled thermal camera: the time
constant of its sensor), and ``capture.interval``, the seconds between images. How far it can be tilted, in
degrees, 0 level and -90 straight down: ``gimbal.pitch.min`` and ``gimbal.pitch.max``, or ``mount.pitch`` of a
fixed camera; without any of these it looks straight down.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import figure
from mmrs_core.planning.in_passing import EXPOSURE_KEY, INTERVAL_KEY
from mmrs_core.scene import Device

OPTICS_KEYS = ("sensor.width", "sensor.height", "focal.length", "image.width", "image.height")
RECORDING_KEYS = (EXPOSURE_KEY, INTERVAL_KEY)
LOWEST_KEY, HIGHEST_KEY, FIXED_KEY = "gimbal.pitch.min", "gimbal.pitch.max", "mount.pitch"
PITCH_KEYS = (LOWEST_KEY, HIGHEST_KEY, FIXED_KEY)
DOWN = -90.0


@dataclass(frozen=True, slots=True)
class Optics:
    """A pinhole camera.

    Attributes:
        width, height: of what it sees, metres for each metre of distance.
        pixel: size of a pixel there, metres for each metre of distance; the larger side.
        lowest, highest: how far it can be tilted, degrees.
    """

    width: float
    height: float
    pixel: float
    lowest: float
    highest: float


def optics_of(device: Device) -> Optics:
    """Return the optics of a camera.

    Raises:
        InfeasibleError: the camera does not state them; names what is missing.
    """
    width, height, focal, across, along = figures(device, OPTICS_KEYS)
    lowest, highest = pitches_of(device.properties)
    return Optics(width / focal, height / focal, max(width / across, height / along) / focal, lowest, highest)


def figures(device: Device, keys: tuple[str, ...]) -> tuple[float, ...]:
    """Return the numbers above zero that properties of a device hold.

    Raises:
        InfeasibleError: it does not state them all; names those that are missing.
    """
    found = [figure(device.properties, key) for key in keys]
    missing = [key for key, value in zip(keys, found, strict=True) if value is None]
    if missing:
        raise InfeasibleError(f"device '{device.id}' does not state {', '.join(missing)}")
    return tuple(value for value in found if value is not None)


def pitches_of(properties: Mapping[str, str]) -> tuple[float, float]:
    """Return how far a camera can be tilted, lowest and highest, degrees.

    >>> pitches_of({"gimbal.pitch.min": "-90", "gimbal.pitch.max": "30"})
    (-90.0, 30.0)
    """
    fixed = angle(properties, FIXED_KEY)
    still = DOWN if fixed is None else fixed
    lowest, highest = angle(properties, LOWEST_KEY), angle(properties, HIGHEST_KEY)
    return still if lowest is None else lowest, still if highest is None else highest


def angle(properties: Mapping[str, str], key: str) -> float | None:
    """Return the angle from -90 to 90 degrees that a property holds; None where there is none."""
    try:
        found = float(properties[key])
    except (KeyError, ValueError):
        return None
    return found if -90.0 <= found <= 90.0 else None
