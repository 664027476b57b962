"""Where pairs of pictures come from: the simulated water, a file, cameras."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from .cameras import Camera, Picture, Pose
from .renderer import Renderer

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
    """Draws what a camera sees from where the vehicle is told to be."""

    def __init__(self, renderer: Renderer, camera: Camera) -> None:
        self._renderer, self._camera = renderer, camera

    def take(self, time: float, pose: Pose) -> tuple[Picture, Picture]:
        """Return both pictures."""
        return self._renderer.pair(self._camera, pose, time)

    def close(self) -> None:
        """Take no more."""


class Captured:
    """Reads a file or cameras as OpenCV opens them.

    One capture has both eyes side by side in each picture; two captures have one eye each.
    """

    def __init__(self, text: str) -> None:
        """Open a file by its path, one camera by its number, or two as in ``0,1``.

        Raises:
            SourceError: it cannot be opened.
        """
        self._ends = not _is_camera(text)
        self._text = text
        self._captures = [_opened(each) for each in (text.split(",") if _is_camera(text) else [text])]

    def take(self, time: float, pose: Pose) -> tuple[Picture, Picture] | None:
        """Return both pictures."""
        pictures = []
        for capture in self._captures:
            there, picture = capture.read()
            if not there:
                if self._ends:
                    return None
                raise SourceError(f"camera {self._text}: no picture")
            pictures.append(np.asarray(picture, np.uint8))
        if len(pictures) == 2:
            return pictures[0], pictures[1]
        half = pictures[0].shape[1] // 2
        return pictures[0][:, :half], pictures[0][:, half : 2 * half]

    def close(self) -> None:
        """Take no more."""
        for capture in self._captures:
            capture.release()


class Adjusted:
    """Brings pictures to a camera's resolution and to an even brightness.

    Attributes:
        gain: by which the last pictures were brightened, both the same.
    """

    def __init__(self, camera: Camera, bright: float = BRIGHT) -> None:
        self.gain = 1.0
        self._camera, self._bright = camera, bright
        self._fresh = True

    def pair(self, left: Picture, right: Picture) -> tuple[Picture, Picture]:
        """Return both pictures as detection takes them."""
        left, right = (self._sized(each) for each in (left, right))
        mean = float(left[::_SAMPLED, ::_SAMPLED].mean()) or 1.0
        wanted = min(max(self._bright / mean, _GAINS[0]), _GAINS[1])
        self.gain += (1.0 if self._fresh else _STEP) * (wanted - self.gain)
        self._fresh = False
        one, other = (
            np.asarray(cv2.convertScaleAbs(each, alpha=self.gain), np.uint8) for each in (left, right)
        )
        return one, other

    def _sized(self, picture: Picture) -> Picture:
        size = (self._camera.width, self._camera.height)
        if picture.shape[1::-1] == size:
            return picture
        return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), np.uint8)


def opened(text: str, camera: Camera, simulated: Callable[[], Renderer]) -> Source:
    """Return the source that ``simulated``, a file's path or cameras' numbers stand for.

    Raises:
        SourceError: it cannot be opened.
    """
    return Simulated(simulated(), camera) if text == "simulated" else Captured(text)


def _is_camera(text: str) -> bool:
    return all(part.isdecimal() for part in text.split(",")) and text.count(",") <= 1


def _opened(text: str) -> cv2.VideoCapture:
    if not text.isdecimal() and not Path(text).is_file():
        raise SourceError(f"{text}: there is no such file")
    capture = cv2.VideoCapture(int(text)) if text.isdecimal() else cv2.VideoCapture(text)
    if not capture.isOpened():
        raise SourceError(f"{text}: OpenCV cannot open it")
    return capture
