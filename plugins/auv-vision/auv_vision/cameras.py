"""Stereo cameras and how they are mounted: from places in the water to pixels and back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from auv_vessel.body.rotation import of_angles, rows_of
from auv_vessel.eyes import BOTTOM, FRONT
from auv_vessel.sheet import Sheet, Vector

Picture: TypeAlias = NDArray[np.uint8]
"""Rows, columns, and blue, green and red, as OpenCV has them."""
Numbers: TypeAlias = NDArray[np.floating[Any]]

LEFT, RIGHT = -0.5, 0.5
"""Where the eyes sit across the middle, as part of the distance between them."""

_BODY = {
    FRONT: ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
    BOTTOM: ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
}
"""Right, down and ahead in the picture, in body axes: the bottom camera's upper edge is towards the bow."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a vehicle is: metres north, east and below the surface; degrees."""

    north: float
    east: float
    depth: float
    roll: float = 0.0
    pitch: float = 0.0
    heading: float = 0.0

    @property
    def axes(self) -> Numbers:
        """North, east and down, each in body axes."""
        return np.array(rows_of(*of_angles(self.roll, self.pitch, self.heading)))

    @property
    def place(self) -> Numbers:
        """North, east, depth."""
        return np.array((self.north, self.east, self.depth))


@dataclass(frozen=True, slots=True)
class Camera:
    """Two identical pinhole cameras side by side whose pictures are rectified.

    Attributes:
        name: one of `eyes.CAMERAS`, which states where it points.
        position: of the middle between both, metres forward, to starboard and down of the centre of gravity.
        baseline: metres from one to the other.
        focal: pixels. width, height: of a picture, pixels.
    """

    name: str
    position: Vector
    baseline: float
    focal: float = 250.0
    width: int = 320
    height: int = 240

    @property
    def middle(self) -> tuple[float, float]:
        """Column and row that look straight ahead."""
        return (self.width - 1) / 2.0, (self.height - 1) / 2.0

    @property
    def axes(self) -> Numbers:
        """Right, down and ahead in the picture, each in body axes."""
        return np.array(_BODY[self.name])

    def eye(self, pose: Pose, side: float) -> Numbers:
        """Return where one of both eyes is: north, east, depth."""
        across = self.axes[0] * (side * self.baseline)
        place: Numbers = pose.place + pose.axes @ (np.array(self.position) + across)
        return place

    def seen(self, points: Numbers, pose: Pose, side: float) -> Numbers:
        """Return points of the world, one in each row, as metres right, down and ahead of an eye."""
        turned: Numbers = (points - self.eye(pose, side)) @ pose.axes @ self.axes.T
        return turned

    def pixels(self, seen: Numbers) -> Numbers:
        """Return columns and rows of points ahead of an eye."""
        found: Numbers = seen[:, :2] * (self.focal / seen[:, 2:]) + np.array(self.middle)
        return found

    def point(self, column: float, row: float, disparity: float) -> Vector:
        """Return what the left eye sees at a pixel, as metres right, down and ahead of the middle."""
        scale = self.baseline / disparity
        right = (column - self.middle[0]) * scale + LEFT * self.baseline
        return right, (row - self.middle[1]) * scale, self.focal * scale

    def world(self, point: Vector, pose: Pose) -> Vector:
        """Return a point, metres right, down and ahead of the middle, as north, east, depth."""
        body = np.array(self.position) + np.array(point) @ self.axes
        north, east, depth = pose.place + pose.axes @ body
        return float(north), float(east), float(depth)

    def scaled(self, width: int, height: int) -> Camera:
        """Return the camera as it is for pictures of another resolution and the same proportions."""
        return replace(self, focal=self.focal * width / self.width, width=width, height=height)


def cameras_of(sheet: Sheet) -> tuple[Camera, Camera]:
    """Return the front and the bottom camera of a vehicle.

    `Sheet.extra` may say ``camera.front.forward`` and ``.down``, ``camera.bottom.forward`` and ``.down``,
    metres from the centre of gravity: at bow and keel if it does not; ``camera.baseline``, metres: a
    quarter, or as wide as the vehicle is; and ``camera.focal``: pixels at a width of 320.
    """
    extra = sheet.extra
    baseline = extra.get("camera.baseline", min(0.25, sheet.width))
    focal = extra.get("camera.focal", 250.0)
    places = {FRONT: (sheet.length / 2.0, 0.0), BOTTOM: (0.0, sheet.height / 2.0)}
    front, bottom = (
        Camera(
            name,
            (extra.get(f"camera.{name}.forward", ahead), 0.0, extra.get(f"camera.{name}.down", down)),
            baseline,
            focal,
        )
        for name, (ahead, down) in places.items()
    )
    return front, bottom
