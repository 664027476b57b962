"""Regions of a picture whose colour is neither that of water nor that of the bottom."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from auv_vision.cameras import Numbers, Picture

STANDS_OUT, SURE = 0.055, 0.02
"""How much more a share of a colour must be than around; or than blue's, which it never is in water."""

_LEAST = 25
_AROUND, _COARSE = 31, 4


@dataclass(frozen=True, slots=True)
class Segment:
    """A connected region.

    Attributes:
        mask: of its box, 0 or 255. left, top: of the box. area: pixels.
    """

    mask: Picture
    left: int
    top: int
    area: int

    @property
    def width(self) -> int:
        """Columns."""
        return int(self.mask.shape[1])

    @property
    def height(self) -> int:
        """Rows."""
        return int(self.mask.shape[0])

    def cut_by(self, width: int, height: int) -> bool:
        """Return whether it reaches the edge of a picture."""
        return (
            self.left <= 1
            or self.top <= 1
            or self.left + self.width >= width - 1
            or self.top + self.height >= height - 1
        )


@dataclass(frozen=True, slots=True)
class View:
    """A picture in the forms that detection needs.

    Attributes:
        smooth: the picture without most of its noise, as numbers.
        hue: shares of red less blue and of green less blue, each pixel: free of how bright the light is.
        veil: blue, green, red of water from afar.
    """

    smooth: Numbers
    hue: Numbers
    veil: Numbers


def view_of(picture: Picture) -> View:
    """Convert a picture."""
    smooth = cv2.GaussianBlur(picture, (5, 5), 1.1).astype(np.float32)
    total = cv2.transform(smooth, np.ones((1, 3), np.float32)) + np.float32(12.0)
    blue, green, red = cv2.split(smooth)
    hue = cv2.merge((red - blue, green - blue)) / total[..., None]
    few = smooth[::8, ::8].reshape(-1, 3)
    dull = hue[::8, ::8].sum(axis=-1).ravel()
    veil = np.median(few[dull <= np.quantile(dull, 0.3)], axis=0)
    return View(smooth, hue, veil)


def segments_of(view: View) -> tuple[Picture, list[Segment]]:
    """Return a mask of what stands out, and its connected regions, the largest first."""
    closed = cv2.morphologyEx(_standing_out(view.hue), cv2.MORPH_CLOSE, _CROSS)
    mask: Picture = np.asarray(cv2.morphologyEx(closed, cv2.MORPH_OPEN, _SQUARE), np.uint8)
    count, labels, figures, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    found = []
    for label in range(1, count):
        left, top, width, height, area = (int(each) for each in figures[label])
        part = labels[top : top + height, left : left + width] == label
        if area >= _LEAST:
            found.append(Segment(np.where(part, 255, 0).astype(np.uint8), left, top, area))
        else:
            mask[top : top + height, left : left + width][part] = 0
    return mask, sorted(found, key=lambda each: -each.area)


def matted(hue: Numbers, segment: Segment) -> tuple[float, float, float]:
    """Return column and row of a region's middle and its area, pixels, blurred edges counted as parts.

    The region must be one colour before one other; blur and the threshold that it was found with do not
    change what is returned.
    """
    left, top = max(0, segment.left - _RIM), max(0, segment.top - _RIM)
    part = hue[top : segment.top + segment.height + _RIM, left : segment.left + segment.width + _RIM]
    framed = np.zeros(part.shape[:2], np.uint8)
    rows, columns = segment.top - top, segment.left - left
    framed[rows : rows + segment.height, columns : columns + segment.width] = segment.mask
    grown = cv2.dilate(framed, _DISC)
    inside = cv2.distanceTransform(framed, cv2.DIST_L2, 3)
    thing = part[inside >= 0.6 * float(inside.max())].mean(axis=0)
    behind = np.median(part[grown == 0], axis=0) if (grown == 0).any() else np.zeros(2)
    apart = thing - behind
    share = np.clip((part - behind) @ apart / max(1e-9, float(apart @ apart)), 0.0, 1.0)
    share[grown == 0] = 0.0
    area = max(1e-9, float(share.sum()))
    column = float(share.sum(axis=0) @ np.arange(share.shape[1])) / area
    row = float(share.sum(axis=1) @ np.arange(share.shape[0])) / area
    return left + column, top + row, area


_RIM = 4
_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))
_CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
_SQUARE = np.ones((2, 2), np.uint8)


def _standing_out(hue: Numbers) -> Picture:
    """Return where red or green has a greater share than around, or than it can have in water."""
    small = hue[_COARSE // 2 :: _COARSE, _COARSE // 2 :: _COARSE]
    mask = np.zeros(hue.shape[:2], bool)
    for number in range(2):
        share = hue[..., number]
        rough = np.clip((small[..., number] + 1.0) * 127.5, 0, 255).astype(np.uint8)
        around = cv2.medianBlur(rough, _AROUND).astype(np.float32) / 127.5 - 1.0
        grown = cv2.resize(around, (hue.shape[1], hue.shape[0]), interpolation=cv2.INTER_LINEAR)
        mask |= (share - grown > STANDS_OUT) | (share > SURE)
    return mask.astype(np.uint8) * np.uint8(255)
