"""The heights tell what a robot passes over, under or beside."""

import pytest

from mmrs_core.pictures.preview.crossings import corners, crossings
from mmrs_core.pictures.preview.picture import Leg, RobotPicture, Zone
from mmrs_core.scene import AreaUse

BARN = Zone("barn", AreaUse.OBSTACLE, ((4.0, -1.0), (6.0, -1.0), (6.0, 1.0), (4.0, 1.0)), 0.0, 8.0)


def robot(*legs):
    return RobotPicture("Alba", "quad", (0.0, 0.0, 0.0), legs, (), ())


def test_time_passes_evenly_along_a_leg():
    leg = Leg("transit", ((0.0, 0.0, 0.0), (3.0, 4.0, 0.0), (3.0, 4.0, 5.0)), 10.0, 20.0)
    assert [time for time, _ in corners(leg)] == [10.0, 15.0, 20.0]


def test_a_leg_over_an_obstacle_passes_it_when_it_is_above():
    over = Leg("transit", ((0.0, 0.0, 20.0), (10.0, 0.0, 20.0)), 100.0, 110.0)
    found = list(crossings(robot(over), [BARN]))
    assert [(each.begin, each.end) for each in found] == [pytest.approx((104.0, 106.0))]


def test_the_way_back_passes_it_again():
    there = Leg("transit", ((0.0, 0.0, 20.0), (10.0, 0.0, 20.0)), 0.0, 10.0)
    back = Leg("transit", ((10.0, 0.0, 20.0), (0.0, 0.0, 20.0)), 10.0, 20.0)
    found = list(crossings(robot(there, back), [BARN]))
    assert [(each.begin, each.end) for each in found] == [
        pytest.approx((4.0, 6.0)),
        pytest.approx((14.0, 16.0)),
    ]


def test_a_climb_beside_an_obstacle_passes_nothing():
    climb = Leg("launch", ((0.0, 0.0, 0.0), (0.0, 0.0, 20.0)), 0.0, 10.0)
    assert list(crossings(robot(climb), [BARN])) == []


def test_a_climb_above_an_obstacle_is_over_it_all_the_time():
    climb = Leg("launch", ((5.0, 0.0, 9.0), (5.0, 0.0, 20.0)), 0.0, 10.0)
    assert [(each.begin, each.end) for each in crossings(robot(climb), [BARN])] == [(0.0, 10.0)]


def test_emergency_areas_are_passed_in_silence():
    meadow = Zone("meadow", AreaUse.EMERGENCY, BARN.shell)
    over = Leg("transit", ((0.0, 0.0, 20.0), (10.0, 0.0, 20.0)), 0.0, 10.0)
    assert list(crossings(robot(over), [meadow])) == []
