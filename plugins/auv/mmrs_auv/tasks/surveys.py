"""The rule for covering an area by sonar at one depth."""

from __future__ import annotations

from dataclasses import replace

from mmrs_auv.names import DEPTH_HOLD_SURVEY_TASK
from mmrs_auv.tasks.recording import recorded
from mmrs_auv.tasks.sonar import swath_of
from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Robot, Scene, Task, Work
from mmrs_core.scene.attributes import holes, number, position, ring

RULE = "depth_hold_survey"


def survey_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return parallel lines at one depth whose swaths cover the area."""
    part = task.part
    depth, overlap = number(part, "depth"), number(part, "overlap") or 0.0
    if depth is None:
        raise InfeasibleError("depth is missing")
    width = swath_of(part, robot.type) * (1.0 - overlap)
    if not width > 0.0:
        raise InfeasibleError("swath and overlap leave no distance between lines")
    initial, up = position(part, "initialPosition"), scene.frame.surface - depth
    entry = (initial[0], initial[1], up)
    refuse_heights(robot, (entry,))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    sweep = Sweep(altitude=up, width=width, rule=RULE, start=(entry[0], entry[1]))
    work = work_over(scene, robot, ring(part, "shell"), sweep, holes(part))
    return replace(work, strokes=tuple(recorded(part, robot, each) for each in work.strokes), entry=entry)


SURVEY_RULE = Rule(RULE, DEPTH_HOLD_SURVEY_TASK, survey_work)
