"""What a camera sees of the ground, from its properties.

Keys of device properties, as text: ``sensor.width`` and ``sensor.height`` in millimetres (width is
across the direction of travel), ``focal.length`` in millimetres, ``image.width`` and
``image.height`` in pixels, and those of `mmrs_core.planning.in_passing`. A pinhole camera that looks
straight down on level ground sees ``sensor · distance / focal length``; the ground resolution is that
over the pixels.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import floor

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import figure
from mmrs_core.planning.in_passing import EXPOSURE_KEY, INTERVAL_KEY

SENSOR_KEYS = ("sensor.width", "sensor.height")
IMAGE_KEYS = ("image.width", "image.height")
FOCAL_KEY = "focal.length"
CAMERA_KEYS = (*SENSOR_KEYS, FOCAL_KEY, *IMAGE_KEYS, EXPOSURE_KEY, INTERVAL_KEY)


@dataclass(frozen=True, slots=True)
class Footprint:
    """What one photo or sample covers: metres across and along the direction of travel."""

    width: float
    length: float


def footprint_at(properties: Mapping[str, str], distance: float) -> Footprint | None:
    """Return what the camera sees from a distance; None where its optics are not described.

    >>> footprint_at({"sensor.width": "17.6", "sensor.height": "8.8", "focal.length": "8.8"}, 40.0)
    Footprint(width=80.0, length=40.0)
    """
    figures = [figure(properties, key) for key in (*SENSOR_KEYS, FOCAL_KEY)]
    if None in figures or distance <= 0.0:
        return None
    width, height, focal = (each or 0.0 for each in figures)
    return Footprint(width * distance / focal, height * distance / focal)


def pixel_at(properties: Mapping[str, str], distance: float) -> float | None:
    """Return the longer side of a pixel on the ground, metres; None where the camera is not described.

    >>> optics = {"sensor.width": "17.6", "sensor.height": "8.8", "focal.length": "8.8"}
    >>> pixel_at({**optics, "image.width": "4000", "image.height": "2000"}, 40.0)
    0.02
    """
    seen = footprint_at(properties, distance)
    across, along = (figure(properties, key) for key in IMAGE_KEYS)
    if seen is None or across is None or along is None:
        return None
    return max(seen.width / across, seen.length / along)


def footprint_of(properties: Mapping[str, str], distance: float, resolution: float, device: str) -> Footprint:
    """Return what a photo covers if a pixel may be at most `resolution` metres large.

    Where the optics are known, this is what the camera sees from that distance, otherwise what its
    pixels cover at exactly that resolution.

    Raises:
        InfeasibleError: the image size is not known, or the camera is too coarse from there.
    """
    pixels = [figure(properties, key) for key in IMAGE_KEYS]
    if None in pixels:
        raise InfeasibleError(f"device '{device}' does not state {' and '.join(IMAGE_KEYS)}")
    seen, reached = footprint_at(properties, distance), pixel_at(properties, distance)
    if seen is None or reached is None:
        across, along = (each or 0.0 for each in pixels)
        return Footprint(resolution * across, resolution * along)
    if reached > resolution * (1 + 1e-9):
        near = floor(100.0 * distance * resolution / reached) / 100.0
        raise InfeasibleError(
            f"device '{device}' resolves {reached:.4g} m on the ground from {distance:g} m, "
            f"{resolution:.4g} m is asked for: {near:g} m would do"
        )
    return seen
