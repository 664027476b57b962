"""How water changes colours, and the colours that things have."""

from __future__ import annotations

from colorsys import rgb_to_hsv
from dataclasses import dataclass
from typing import Final

import numpy as np

from auv_vision.cameras import Numbers

PALETTE: Final = {
    "red": (205, 35, 30),
    "orange": (245, 125, 20),
    "yellow": (240, 215, 35),
    "green": (35, 170, 55),
    "blue": (30, 60, 190),
    "white": (235, 235, 230),
    "black": (20, 20, 20),
    "grey": (128, 128, 128),
}
"""Red, green, blue of things in air."""

TOLD_APART = ("red", "orange", "yellow", "green")
"""Colours that stand out from water and bottom, and that detections tell from each other."""


@dataclass(frozen=True, slots=True)
class Water:
    """How water changes light between a thing and an eye.

    Attributes:
        attenuation: of blue, green and red, per metre.
        veil: blue, green and red that water itself looks like, from afar.
    """

    attenuation: tuple[float, float, float] = (0.09, 0.10, 0.22)
    veil: tuple[float, float, float] = (135.0, 95.0, 25.0)

    def left(self, metres: Numbers) -> Numbers:
        """Return the part of each colour that is left after a way; another axis for the colours."""
        found: Numbers = np.exp(-metres[..., None] * np.array(self.attenuation))
        return found

    def seen(self, colour: Numbers, metres: Numbers) -> Numbers:
        """Return what colours (blue, green, red last) look like from so far."""
        left = self.left(metres)
        found: Numbers = colour * left + np.array(self.veil) * (1.0 - left)
        return found


POOL: Final = Water()


def hazier(water: Water, times: float) -> Water:
    """Return water that is so many times as hazy."""
    blue, green, red = water.attenuation
    return Water((times * blue, times * green, times * red), water.veil)


def bgr(name: str) -> Numbers:
    """Return blue, green and red of a colour; of one that is not in the palette: grey."""
    red, green, blue = PALETTE.get(name, PALETTE["grey"])
    return np.array((blue, green, red), dtype=float)


FARTHEST = 28.0
"""Degrees of hue by which a colour may differ from that of the palette."""

_LEAST_SATURATED = 0.3


def colour_of(pixel: Numbers, veil: Numbers, metres: float, water: Water) -> tuple[str, float] | None:
    """Return the name of a colour, and how far from the next one it is, from 0 to 1.

    Args:
        pixel: blue, green, red as seen. veil: of water from afar.
        metres: to the thing.

    Returns:
        None where it is none of `TOLD_APART`.
    """
    left = np.exp(-metres * np.array(water.attenuation))
    blue, green, red = np.clip(veil + (pixel - veil) / left, 0.0, None)
    bright = max(blue, green, red, 1e-6)
    hue, saturation, _ = rgb_to_hsv(red / bright, green / bright, blue / bright)
    if saturation < _LEAST_SATURATED:
        return None
    nearest, next_one = sorted((_apart(360.0 * hue, other), name) for name, other in _HUES.items())[:2]
    if nearest[0] > FARTHEST:
        return None
    return nearest[1], 1.0 - nearest[0] / max(1e-6, next_one[0])


def _hue(name: str) -> float:
    red, green, blue = PALETTE[name]
    return 360.0 * rgb_to_hsv(red / 255.0, green / 255.0, blue / 255.0)[0]


_HUES = {name: _hue(name) for name in TOLD_APART}


def _apart(one: float, other: float) -> float:
    return abs((one - other + 180.0) % 360.0 - 180.0)
