"""The camera actions of panel tasks, and what they record."""

from __future__ import annotations

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import device_for
from mmrs_core.scene import ActionAt, Device, Part, Robot
from mmrs_core.scene.attributes import number, text
from mmrs_solar.camera import Optics
from mmrs_solar.names import IRRADIANCE
from mmrs_solar.views import View

TOLERANCE = 1e-9
"""Relative; so that a distance that was computed from a size of pixels keeps it."""


def camera_for(task: Part, robot: Robot, *actions: str) -> Device:
    """Return the camera that does the actions of a task and records the irradiance that it needs.

    Raises:
        InfeasibleError: the robot has no such camera, or it does not take the irradiance.
    """
    camera = device_for(robot.type, actions[0], text(task, "deviceId"))
    for action in actions:
        if action not in camera.actions:
            raise InfeasibleError(f"device '{camera.id}' does not support action '{action}'")
    if IRRADIANCE not in camera.actions[actions[0]].parameters:
        raise InfeasibleError(
            f"action '{actions[0]}' of device '{camera.id}' takes no parameter '{IRRADIANCE}' to record"
        )
    return camera


def recorded(task: Part, camera: Device, action: str, at: float) -> ActionAt:
    """Return an action along a stroke that records the irradiance that it needs."""
    least = number(task, IRRADIANCE) or 0.0
    return ActionAt(at, action, camera.id, ((IRRADIANCE, f"{least:g}"),))


def distance_for(task: Part, camera: str, optics: Optics, view: View) -> float:
    """Return how far from the panels a camera looks, metres: as the task says, or as it resolves them.

    Raises:
        InfeasibleError: its pixels are too large from there.
    """
    asked, size = number(task, "distance"), number(task, "pixelSize") or 0.0
    farthest = size / (optics.pixel * view.stretch)
    if asked is not None and asked > farthest * (1.0 + TOLERANCE):
        reached = asked * optics.pixel * view.stretch
        raise InfeasibleError(
            f"device '{camera}' sees pixels of {reached:.3g} m from {asked:g} m, {size:.3g} m is asked for: "
            f"go as near as {farthest:.1f} m"
        )
    return farthest if asked is None else asked
