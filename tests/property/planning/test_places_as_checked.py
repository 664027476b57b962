"""The planner knows of every place and time at which the check of separation counts a robot."""

from math import inf
from pathlib import Path

import numpy as np
import pytest

from mmrs_core.analysis.occupations import occupations_of
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.planning.proximity import legs_apart
from mmrs_core.planning.separation import tracks_of
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
    tracks = tracks_of(stages.scene, stages.plan)
    for robot in program.robots:
        fine, turning = tracks[robot.id].cut(COARSE), robots[robot.id].kinematics.turning_radius
        for each in occupations_of(found, robot):
            last = min(each.end, each.begin + 1e4)
            for time in (each.begin + share * (last - each.begin) for share in MOMENTS):
                there = (fine.times[:, 0] <= time + COARSE) & (fine.times[:, 1] >= time - COARSE)
                for point in each.between(time, time):
                    legs = np.broadcast_to(np.array(point), fine.places[there].shape)
                    off = legs_apart(fine.places[there], legs) - fine.radii[there]
                    if off.min(initial=inf) + each.radius > turning + COARSE:
                        yield robot.id, robot.moves[each.move].id, time, point, off.min(initial=inf)


@pytest.mark.parametrize("robot", ["BlueROV2", "Clearpath Husky A300", "Amovlab P600 camera"])
@pytest.mark.parametrize("tasks", [OBJECTS])
def test_the_planner_knows_wherever_a_robot_may_be(robot, tasks):
    team = [RobotWanted(name, robot) for name in ("Alpha", "Bravo")]
    able = [TaskWanted(each) for each in tasks if BEGINNING.doers(TaskWanted(each), [robot])[0]]
    made = BEGINNING.project(Path("new"), "new", team, able)
    assert list(unforeseen(Stages(lambda: made.models, CONTRIBUTIONS))) == []
