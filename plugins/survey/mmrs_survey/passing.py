"""Whether photos are taken in passing, and how fast the robot may then go."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import figure
from mmrs_core.planning.in_passing import INTERVAL_KEY, passing_speed
from mmrs_core.scene import DISTANCE, Device, Part, Robot
from mmrs_core.scene.attributes import number, text
from mmrs_survey.camera import pixel_at

AT_STOPS, IN_PASSING = "AT_STOPS", "IN_PASSING"


@dataclass(frozen=True, slots=True)
class Capture:
    """How a robot takes the photos of a task.

    Attributes:
        passing: action of the camera that takes them in passing; None: the robot stops for each.
        speed: largest, metres per second; None: as on any way.
        notes: why it stops where the task leaves that open.
        interval: seconds between two in passing, at least.
    """

    passing: str | None
    speed: float | None
    notes: tuple[str, ...] = ()
    interval: float = 0.0


def capture_of(part: Part, robot: Robot, camera: Device, spacing: float, height: float) -> Capture:
    """Return how a robot takes the photos of a task.

    Args:
        camera: that takes them.
        spacing: metres between two photos, at most.
        height: of the camera above the ground, metres; not above 0: unknown.

    Raises:
        InfeasibleError: the task asks for photos in passing, and the camera or the robot cannot do that.
    """
    asked, action, speed = text(part, "capture"), text(part, "triggerAction"), number(part, "speed")
    if asked == AT_STOPS:
        return Capture(None, speed)
    try:
        if action not in camera.actions or DISTANCE not in camera.actions[action].parameters:
            raise InfeasibleError(
                f"device '{camera.id}' has no action '{action}' with a parameter '{DISTANCE}' to take photos "
                "in passing"
            )
        blur, pixel = number(part, "blur") or 0.0, pixel_at(camera.properties, height)
        speed = passing_speed(camera, robot, spacing, pixel, blur, speed or inf)
        return Capture(action, speed, interval=figure(camera.properties, INTERVAL_KEY) or 0.0)
    except InfeasibleError as error:
        if asked == IN_PASSING:
            raise
        return Capture(None, speed, (f"stops for each photo: {error}",))
