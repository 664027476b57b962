"""Whether photos are taken in passing, and how fast the robot may then go."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.in_passing import passing_speed
from mmrs_core.scene import DISTANCE, Device, Part, Robot
from mmrs_core.scene.attributes import number, text
from mmrs_survey.camera import pixel_at

AT_STOPS, IN_PASSING = "AT_STOPS", "IN_PASSING"


@dataclass(frozen=True, slots=True)
class Trigger:
    """How a camera takes photos in passing: its action, and the largest speed, metres per second."""

    action: str
    speed: float


def trigger_of(part: Part, robot: Robot, camera: Device, spacing: float, height: float) -> Trigger | None:
    """Return how a task's photos are taken in passing; None where the robot stops for each.

    Args:
        camera: that takes them.
        spacing: metres between two photos, at most.
        height: of the camera above the ground, metres; not above 0: unknown.

    Raises:
        InfeasibleError: the task asks for photos in passing, and the camera or the robot cannot do that.
    """
    asked, action = text(part, "capture"), text(part, "triggerAction")
    if asked == AT_STOPS:
        return None
    try:
        if action not in camera.actions or DISTANCE not in camera.actions[action].parameters:
            raise InfeasibleError(
                f"device '{camera.id}' has no action '{action}' with a parameter '{DISTANCE}' to take photos "
                "in passing"
            )
        blur, pixel = number(part, "blur") or 0.0, pixel_at(camera.properties, height)
        most = number(part, "speed") or inf
        return Trigger(action, passing_speed(camera, robot, spacing, pixel, blur, most))
    except InfeasibleError:
        if asked == IN_PASSING:
            raise
        return None
