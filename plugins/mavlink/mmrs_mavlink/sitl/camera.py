"""The simulated vehicle's camera: photos on command, and every so many metres."""

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
        works: whether it takes photos at all.
        photos: all that were taken, oldest first.
        untold: how many of them are still to be told.
    """

    def __init__(self) -> None:
        """Wait for the first command."""
        self.works = True
        self.photos: list[Photo] = []
        self.untold = 0
        self._every = 0.0
        self._last: Vector | None = None

    def obey(self, number: int, params: tuple[float, ...], body: Body) -> None:
        """Do what a command says, if it is for cameras."""
        once = number == mavlink.MAV_CMD_DO_DIGICAM_CONTROL and params[4:5] == (1.0,)
        if once or number == mavlink.MAV_CMD_IMAGE_START_CAPTURE:
            self._take(body)
        elif number == mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST:
            self._every, self._last = params[0], None
            if params[2:3] == (1.0,):
                self._take(body)

    def move(self, body: Body) -> None:
        """Take a photo where the last one is far enough away."""
        if self._every <= 0.0:
            return
        if self._last is None:
            self._last = body.position
        if dist(self._last, body.position) >= self._every:
            self._take(body)

    def _take(self, body: Body) -> None:
        self._last = body.position
        if self.works:
            self.photos.append(Photo(len(self.photos) + 1, body.position, body.heading))
            self.untold += 1
