"""The planner knows of every place and time at which the check of separation counts a robot."""

from math import inf
from pathlib import Path

import numpy as np
import pytest

from mmrs_core.analysis.occupations import occupations_of
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.planning.proximity import pieces_of
from mmrs_core.planning.timeline import timelines_of
from mmrs_core.plugins import load_plugins
from mmrs_core.projects.beginning import Beginning, TaskWanted
from mmrs_core.projects.team import RobotWanted
from mmrs_core.stages import Stages

CONTRIBUTIONS = load_plugins().contributions
BEGINNING = Beginning((43.77, 11.25), CONTRIBUTIONS)
OBJECTS = ("AlignTask", "ApproachTask", "InspectObjectTask", "ObserveTask", "MeasureTask")
MOMENTS = (0.0, 0.02, 0.3, 0.5, 0.7, 0.98, 1.0)
COARSE = 0.25
"""Metres, and seconds, within which a place is one that the planner knows."""


def distances_of(point, time, pieces):
    """Return the distances (n,) of a point (3,) from where a robot may be on pieces at a time."""
    (early, late), least = pieces.times.T, np.maximum(pieces.least, 1e-9)
    first = np.clip(1.0 - (late - time + COARSE) / least, 0.0, 1.0)
    last = np.clip((time + COARSE - early) / least, 0.0, 1.0)
    along = pieces.places[:, 1] - pieces.places[:, 0]
    gap, length2 = point - pieces.places[:, 0], (along**2).sum(axis=1)
    share = (gap * along).sum(axis=1) / np.where(length2 > 0.0, length2, 1.0)
    away = np.linalg.norm(gap - np.clip(share, first, last)[:, None] * along, axis=1)
    return np.where((early <= time + COARSE) & (late >= time - COARSE), away, inf)


def unforeseen(stages):
    """Yield where and when a robot may be without the planner's knowing."""
    program, place = stages.program, stages.place
    found = CheckInput(
        program=program,
        types=place.types,
        robot_kinds=CONTRIBUTIONS.robot_kinds,
        move_kinds=CONTRIBUTIONS.move_kinds,
        areas=place.areas,
        environment=place.environment or {},
        elements=place.elements,
    )
    robots = {robot.name: robot for robot in stages.scene.robots}
    timelines = timelines_of(stages.plan, robots)
    for robot in program.robots:
        pieces, turning = pieces_of(timelines[robot.id].rides), robots[robot.id].kinematics.turning_radius
        for each in occupations_of(found, robot):
            last = min(each.end, each.begin + 1e4)
            for time in (each.begin + share * (last - each.begin) for share in MOMENTS):
                for point in each.between(time, time):
                    off = distances_of(np.array(point), time, pieces) - pieces.radii
                    if off.min(initial=inf) + each.radius > turning + COARSE:
                        yield robot.id, robot.moves[each.move].id, time, point, off.min(initial=inf)


@pytest.mark.parametrize("robot", ["BlueROV2", "Clearpath Husky A300", "Amovlab P600 camera"])
@pytest.mark.parametrize("tasks", [OBJECTS])
def test_the_planner_knows_wherever_a_robot_may_be(robot, tasks):
    team = [RobotWanted(name, robot) for name in ("Alpha", "Bravo")]
    able = [TaskWanted(each) for each in tasks if BEGINNING.doers(TaskWanted(each), [robot])[0]]
    made = BEGINNING.project(Path("new"), "new", team, able)
    assert list(unforeseen(Stages(lambda: made.models, CONTRIBUTIONS))) == []
