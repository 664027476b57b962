"""The rule for covering an area with photos or samples."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.patterns import pattern_of
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Robot, Scene, Task, Work
from mmrs_core.scene.attributes import holes, number, position, ring, text
from mmrs_survey.names import PHOTO_GRID_TASK
from mmrs_survey.passing import capture_of
from mmrs_survey.spacing import spacing_of

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
    capture = capture_of(part, robot, device, spacing.length, altitude)
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
            speed=capture.speed,
            slow_down=None if capture.speed is None else 1.0,
            passing=capture.passing,
            interval=capture.interval,
            start=(entry[0], entry[1]),
            pattern=pattern_of(part),
        ),
        holes(part),
    )
    return replace(work, entry=entry, notes=capture.notes)


PHOTO_GRID_RULE = Rule(RULE, PHOTO_GRID_TASK, photo_grid_work)
