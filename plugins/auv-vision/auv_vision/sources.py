"""Where pairs of pictures come from: the simulated water, a film, cameras."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from auv_vision.cameras import Camera, Picture, Pose
from auv_vision.renderer import Renderer

SIMULATED = "simulated"

LEAST = 160
"""Pixels across that a picture of one eye has at least."""

BRIGHT = 110.0
"""Mean of all pixels, of 255, to which pictures are brightened or dimmed."""

_GAINS, _STEP, _SAMPLED = (0.4, 4.0), 0.3, 8


class SourceError(OSError):
    """Pictures cannot be had, or none any more."""


class Source(Protocol):
    """Takes pairs of pictures."""

    def take(self, time: float, pose: Pose) -> tuple[Picture, Picture] | None:
        """Return the pictures of the left and the right eye; None: there are no more.

        Raises:
            SourceError: a camera is gone.
        """
        ...

    def close(self) -> None:
        """Take no more."""
        ...


class Simulated:
    """Draws what a camera sees from the reported position of the vehicle."""

    def __init__(self, renderer: Renderer, camera: Camera) -> None:
        self._renderer, self._camera = renderer, camera

    def take(self, time: float, pose: Pose) -> tuple[Picture, Picture]:
        """Return both pictures."""
        return self._renderer.pair(self._camera, pose, time)

    def close(self) -> None:
        """Take no more."""


class Captured:
    """Reads a film or cameras as OpenCV opens them.

    One capture has both eyes side by side in each picture; two captures have one eye each. Films run as
    time does: pictures between two pairs are left out.
    """

    def __init__(self, text: str) -> None:
        """Open a film by its path, a camera by its number or device, or two cameras as in ``0,1``.

        Raises:
            SourceError: it cannot be opened, or its pictures are not pairs.
        """
        cameras = _cameras(text)
        self._text, self._ends = text, not cameras
        self._captures = [_opened(each) for each in cameras or (text,)]
        try:
            _check_sizes(text, [_size(each) for each in self._captures])
        except SourceError:
            self.close()
            raise
        self._pace = self._captures[0].get(cv2.CAP_PROP_FPS) if self._ends else 0.0
        self._last, self._passed, self._read = inf, 0.0, 0

    def take(self, time: float, pose: Pose) -> tuple[Picture, Picture] | None:
        """Return both pictures."""
        self._passed += max(0.0, time - self._last)
        self._last = time
        left_out = round(self._passed * self._pace) - self._read if isfinite(self._pace) else 0
        for _ in range(max(1, 1 + left_out)):
            self._read += 1
            if not all([each.grab() for each in self._captures]):
                self._check_ended()
                return None
        pictures = []
        for capture in self._captures:
            there, picture = capture.retrieve()
            if not there:
                self._check_ended()
                return None
            pictures.append(np.asarray(picture, np.uint8))
        if len(pictures) == 2:
            return pictures[0], pictures[1]
        half = pictures[0].shape[1] // 2
        return pictures[0][:, :half], pictures[0][:, half : 2 * half]

    def close(self) -> None:
        """Take no more."""
        for capture in self._captures:
            capture.release()

    def _check_ended(self) -> None:
        """Return if a film has ended; raise SourceError if there should be more."""
        if not self._ends:
            raise SourceError(f"camera {self._text}: no picture")
        if self._read == 1:
            raise SourceError(f"{self._text}: there is no picture in it")


class Adjusted:
    """Brings pictures to a camera's resolution and to an even brightness.

    Attributes:
        gain: by which the last pictures were brightened, both the same.
    """

    def __init__(self, camera: Camera) -> None:
        self.gain = 1.0
        self._camera, self._fresh = camera, True

    def pair(self, left: Picture, right: Picture) -> tuple[Picture, Picture]:
        """Return both pictures as detection takes them."""
        left, right = (self._sized(each) for each in (left, right))
        mean = float(left[::_SAMPLED, ::_SAMPLED].mean()) or 1.0
        wanted = min(max(BRIGHT / mean, _GAINS[0]), _GAINS[1])
        self.gain += (1.0 if self._fresh else _STEP) * (wanted - self.gain)
        self._fresh = False
        one, other = (
            np.asarray(cv2.convertScaleAbs(each, alpha=self.gain), np.uint8) for each in (left, right)
        )
        return one, other

    def _sized(self, picture: Picture) -> Picture:
        """Return the middle of a picture, of the camera's proportions, in its resolution."""
        size = (self._camera.width, self._camera.height)
        if picture.shape[1::-1] == size:
            return picture
        height, width = picture.shape[:2]
        across = min(width, round(height * size[0] / size[1]))
        down = min(height, round(width * size[1] / size[0]))
        left, top = (width - across) // 2, (height - down) // 2
        middle = picture[top : top + down, left : left + across]
        return np.asarray(cv2.resize(middle, size, interpolation=cv2.INTER_AREA), np.uint8)


def opened(text: str, camera: Camera, simulated: Callable[[], Renderer]) -> Source:
    """Return the source that ``simulated``, a film's path or cameras stand for.

    Raises:
        SourceError: it cannot be opened, or its pictures are not pairs.
    """
    return Simulated(simulated(), camera) if text == SIMULATED else Captured(text)


def _cameras(text: str) -> tuple[str, ...]:
    """Return the one or two cameras that a text names; none: it names a film."""
    parts = tuple(text.split(","))
    is_all = all(part.isdecimal() or Path(part).is_char_device() for part in parts)
    return parts if is_all and len(parts) <= 2 else ()


def _opened(text: str) -> cv2.VideoCapture:
    path = Path(text)
    if not text.isdecimal() and not path.is_char_device() and not path.is_file():
        raise SourceError(f"{text}: there is no such film or camera")
    capture = cv2.VideoCapture(int(text)) if text.isdecimal() else cv2.VideoCapture(text)
    if not capture.isOpened():
        raise SourceError(f"{text}: OpenCV cannot open it")
    capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
    return capture


def _size(capture: cv2.VideoCapture) -> tuple[int, int]:
    return int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT))


def _check_sizes(text: str, sizes: Sequence[tuple[int, int]]) -> None:
    """Raise SourceError for pictures that are not a pair: of one eye only, of different sizes, too small."""
    width, height = sizes[0]
    if len(set(sizes)) > 1:
        raise SourceError(f"{text}: pictures of {width}x{height} and of {sizes[1][0]}x{sizes[1][1]} pixels")
    each = width // (1 if len(sizes) > 1 else 2)
    if each < height:
        raise SourceError(f"{text}: {width}x{height} pixels are not two pictures side by side")
    if each < LEAST:
        raise SourceError(f"{text}: pictures {each} pixels wide; no less than {LEAST} will do")
