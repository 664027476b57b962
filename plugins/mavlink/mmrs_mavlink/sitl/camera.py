"""The camera of a simulated vehicle: photos on command, and at distance intervals."""

from __future__ import annotations

from dataclasses import dataclass
from math import dist

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.body import Body, Vector


@dataclass(frozen=True, slots=True)
class Photo:
    """A photo: its number, and where it was taken with which heading."""

    number: int
    place: Vector
    heading: float


class Camera:
    """A camera.

    Attributes:
        works: whether it takes photos.
        photos: all photos, oldest first. unsent: how many of them are not yet reported.
    """

    def __init__(self) -> None:
        self.works = True
        self.photos: list[Photo] = []
        self.unsent = 0
        self._interval = 0.0
        self._last: Vector | None = None

    def execute(self, number: int, params: tuple[float, ...], body: Body) -> None:
        """Execute a command, if it is one for cameras."""
        once = number == mavlink.MAV_CMD_DO_DIGICAM_CONTROL and params[4:5] == (1.0,)
        if once or number == mavlink.MAV_CMD_IMAGE_START_CAPTURE:
            self._take(body)
        elif number == mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST:
            self._interval, self._last = params[0], None
            if params[2:3] == (1.0,):
                self._take(body)

    def move(self, body: Body) -> None:
        """Take a photo if the last one is an interval away."""
        if self._interval <= 0.0:
            return
        if self._last is None:
            self._last = body.position
        if dist(self._last, body.position) >= self._interval:
            self._take(body)

    def _take(self, body: Body) -> None:
        self._last = body.position
        if self.works:
            self.photos.append(Photo(len(self.photos) + 1, body.position, body.heading))
            self.unsent += 1
