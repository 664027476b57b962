"""What colour things have, once what water did to it is undone."""

from __future__ import annotations

from colorsys import rgb_to_hsv

import numpy as np

from auv_vision.cameras import Numbers
from auv_vision.water import PALETTE, TOLD_APART, Water

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
