"""In a corridor, a robot passes a corner without a stop only where the corridor leaves room to cut it."""

from dataclasses import replace
from itertools import pairwise

import pytest
from plain_scenes import box, robot, scene, visit, with_kinematics

from mmrs_core.planning.corners import LEAST_CUT, Corners
from mmrs_core.planning.team import Team
from mmrs_core.scene import Corridor
from mmrs_runtime.timing import LegTiming

BEND = Corridor("bend", ((0.0, 0.0), (50.0, 0.0), (50.0, 50.0)), 20.0)
SLOW = with_kinematics(robot(), cruise=2.0, timing=LegTiming(3.0))
LEGS = ((0.0, 0.0, 20.0), (50.0, 0.0, 20.0), (50.0, 50.0, 20.0))


def passes(corridor, legs=LEGS, areas=(), each=SLOW):
    return Corners(each, areas, (corridor,)).may_pass(*legs, None)


@pytest.mark.parametrize(("width", "expected"), [(2.0 * (1.0 + LEAST_CUT), True), (5.9, False)])
def test_a_bend_is_cut_where_the_corridor_is_wide_enough(width, expected):
    assert passes(replace(BEND, width=width)) is expected


@pytest.mark.parametrize(("high", "expected"), [(23.0, True), (22.9, False)])
def test_heights_leave_room_too(high, expected):
    assert passes(replace(BEND, high=high)) is expected


def test_corners_elsewhere_and_straight_paths_need_no_room_in_it():
    narrow = replace(BEND, width=2.0)
    assert passes(narrow, ((0.0, 9.0, 20.0), (40.0, 9.0, 20.0), (40.0, 90.0, 20.0)))
    assert passes(narrow, ((0.0, 0.0, 20.0), (25.0, 0.0, 20.0), (50.0, 0.0, 20.0)))


def test_areas_count_as_well():
    assert not passes(BEND, areas=(box("wall", 52.0, -5.0, 60.0, 5.0),))


@pytest.mark.parametrize(("width", "slower"), [(20.0, True), (5.9, False)])
def test_legs_count_as_those_of_a_mission_only_where_their_corner_is_passed(width, slower):
    flown = with_kinematics(SLOW, mission=LegTiming(0.5))
    corridors = (replace(BEND, width=width),)
    travel = Team(scene((flown,), {"a": visit((300.0, 0.0, 20.0))}, corridors=corridors)).pilots["r1"].travel
    alone = sum(travel.going(leg).longest for leg in pairwise(LEGS))
    assert (travel.going(LEGS).longest > alone + 1.0) is slower
    assert slower or travel.going(LEGS).longest == pytest.approx(alone)
