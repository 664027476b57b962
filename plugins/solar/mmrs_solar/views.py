"""From where, and in which direction, a camera looks at panels."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin, tan

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Position

LARGEST_OFF_NORMAL = 30.0
"""Degrees from the normal of panels beyond which glass mirrors the sky more than it shows its own heat."""

STEEPEST = -85.0
"""Degrees: a camera that looks straight down sees its robot mirrored, and leaves its heading undefined."""

PARALLAX = 1.0
"""Degrees by which the direction to the point that a camera aims at may change along a row."""

SWING = 5.0
"""Degrees by which the robot's heading towards that point may change."""


@dataclass(frozen=True, slots=True)
class View:
    """A direction of looking at panels; all in degrees.

    Attributes:
        azimuth: of the panels.
        pitch: of the camera, -90 straight down.
        off_normal: between the direction and the panels' normal.
    """

    azimuth: float
    pitch: float
    off_normal: float

    @property
    def stretch(self) -> float:
        """Return by how much longer lengths on a panel are than those that the camera faces squarely."""
        return 1.0 / cos(radians(self.off_normal))


def view_of(azimuth: float, tilt: float, lowest: float, highest: float) -> View:
    """Return the direction nearest to the normal of panels in which a camera can look; all in degrees.

    Args:
        azimuth, tilt: of the panels.
        lowest, highest: pitch of the camera.

    Raises:
        InfeasibleError: that is too far from the normal.

    >>> view_of(180.0, 30.0, -90.0, 0.0)
    View(azimuth=180.0, pitch=-60.0, off_normal=0.0)
    """
    normal = tilt - 90.0
    pitch = min(max(normal, STEEPEST, lowest), highest)
    off = abs(pitch - normal)
    if off > LARGEST_OFF_NORMAL + 1e-9:
        raise InfeasibleError(
            f"its camera looks at panels with a tilt of {tilt:g} degrees {off:.1f} degrees off their normal, "
            f"{LARGEST_OFF_NORMAL:g} are allowed"
        )
    return View(azimuth, pitch, off)


def before(place: Position, view: View, distance: float) -> Position:
    """Return the position of a camera that has a point in the middle of its image, at a distance."""
    return _along(place, view.azimuth, view.pitch, -distance)


def aim_beyond(place: Position, view: View, length: float) -> Position:
    """Return a point that lies in nearly the same direction all along a row.

    A camera that keeps looking at it keeps heading and pitch, to within the swing and the parallax.

    Args:
        place: of the camera in the middle of its path.
        length: of the way, metres.
    """
    pitch, half = max(view.pitch, STEEPEST), max(1.0, length / 2.0)
    far = max(half / tan(radians(PARALLAX)), half / tan(radians(SWING)) / cos(radians(pitch)))
    return _along(place, view.azimuth, pitch, far)


def _along(place: Position, azimuth: float, pitch: float, distance: float) -> Position:
    facing, down = radians(azimuth), radians(pitch)
    east, north = -sin(facing) * cos(down), -cos(facing) * cos(down)
    return (place[0] + distance * east, place[1] + distance * north, place[2] + distance * sin(down))
