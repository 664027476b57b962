"""The rule for coming up to find out where the vehicle is."""

from __future__ import annotations

from mmrs_auv.names import SURFACE_TASK
from mmrs_core.contributions.rules import Rule
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, position

RULE = "surface_fix"


def surface_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return the place at the surface above the point, and how long to stay there."""
    east, north, _ = position(task.part, "point")
    place = (east, north, scene.frame.surface)
    refuse_heights(robot, (place,))
    refuse_blocked(robot, scene, (place,), "the place at the surface")
    return Work((Stroke((place,), hold=number(task.part, "duration") or 0.0),), divisible=False, rule=RULE)


SURFACE_RULE = Rule(RULE, SURFACE_TASK, surface_work)
