"""The rule for covering an area with photos or samples."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Device, Part, Robot, Scene, Task, Work
from mmrs_core.scene.attributes import holes, number, position, ring, text
from mmrs_survey.camera import CAMERA_KEYS, Footprint, footprint_at, footprint_of
from mmrs_survey.names import PHOTO_GRID_TASK
from mmrs_survey.passing import trigger_of

RULE = "photo_grid"


def photo_grid_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the swaths from which photos or samples cover the area."""
    part = task.part
    altitude = number(part, "altitude")
    if altitude is None:
        raise InfeasibleError("altitude is missing")
    initial = position(part, "initialPosition")
    entry = (initial[0], initial[1], altitude)
    refuse_heights(robot, (entry,))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    action = text(part, "actionName")
    device = device_for(robot.type, action, text(part, "deviceId"))
    spacing = spacing_of(part, device, altitude)
    trigger = trigger_of(part, robot, device, spacing.length, altitude)
    speed = number(part, "speed") if trigger is None else trigger.speed
    work = work_over(
        scene,
        robot,
        ring(part, "shell"),
        Sweep(
            altitude=altitude,
            width=spacing.width,
            length=spacing.length,
            rule=RULE,
            action=action,
            device=device.id,
            speed=speed,
            slow_down=None if speed is None else 1.0,
            passing=None if trigger is None else trigger.action,
            start=(entry[0], entry[1]),
        ),
        holes(part),
    )
    return replace(work, entry=entry)


def spacing_of(part: Part, device: Device, altitude: float) -> Footprint:
    """Return how far apart swaths, and photos along them, may be: footprints less their overlaps.

    The ground is taken to be level at the height of the origin.

    Raises:
        InfeasibleError: neither the task nor the device defines what one photo covers, or the camera is
            too coarse.
    """
    grid = number(part, "gridResolution")
    seen = Footprint(grid, grid) if grid is not None else _footprint(part, device, altitude)
    side, front = number(part, "sideOverlap") or 0.0, number(part, "frontOverlap") or 0.0
    left = Footprint(seen.width * (1.0 - side), seen.length * (1.0 - front)) if grid is None else seen
    if not (left.width > 0.0 and left.length > 0.0):
        raise InfeasibleError("grid, footprint and overlaps leave no distance between photos")
    return left


def _footprint(part: Part, device: Device, altitude: float) -> Footprint:
    width, length = number(part, "footprintWidth"), number(part, "footprintLength")
    if width is not None and length is not None:
        return Footprint(width, length)
    resolution = number(part, "groundResolution")
    if resolution is not None:
        return footprint_of(device.properties, altitude, resolution, device.id)
    if altitude <= 0.0:
        raise InfeasibleError(f"what one photo covers is not known at {altitude:g} m: give a footprint")
    seen = footprint_at(device.properties, altitude)
    if seen is None:
        keys = ", ".join(CAMERA_KEYS[:3])
        raise InfeasibleError(f"device '{device.id}' does not state what one photo covers ({keys})")
    return seen


PHOTO_GRID_RULE = Rule(RULE, PHOTO_GRID_TASK, photo_grid_work)
