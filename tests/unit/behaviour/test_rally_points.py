"""Where robots come down when all of them have to at once."""

from dataclasses import replace
from itertools import combinations
from math import dist

import pytest
from mmrs_multicopter.testing import go_to, quad, robot_program

from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.scene import Area, AreaUse
from mmrs_core.testing.programs import program


def rally_points(*areas, robots=1, error=1.0, separation=None):
    """Return where each of so many robots, whose ways lead from 0 to 30 m of height, comes down."""
    moves = [go_to("out", (100.0, 100.0, 30.0))]
    fleet = program(*(robot_program(f"r{n}", moves) for n in range(robots)))
    fleet = replace(fleet, position_error=error, minimum_separation=separation)
    return [rally_points_of(robot, fleet, {quad().name: quad()}, areas) for robot in fleet.robots]


def yard(side=40.0, *, name="yard", distance=2.0):
    ring = ((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))
    return Area(name, AreaUse.EMERGENCY, ring, safety_distance=distance)


def test_an_emergency_area_that_is_too_small_has_no_refuge():
    (found,) = rally_points(yard(10.0))
    assert found.points == ((5.0, 5.0),)
    (none,) = rally_points(yard(6.9))
    assert none.points == ()


def test_each_robot_comes_down_elsewhere():
    found = [each.points for each in rally_points(yard(), yard(60.0, name="field"), robots=4, separation=8.0)]
    for points in zip(*found, strict=True):
        assert min(dist(a, b) for a, b in combinations(points, 2)) >= 8.0
    assert all(min(*point, 40.0 - point[0], 40.0 - point[1]) >= 3.5 for point, _ in found)


def test_robots_for_which_there_is_no_room_in_one_area_use_the_others():
    small, large = yard(10.0, name="small"), yard(80.0, name="large")
    one, two = rally_points(small, large, robots=2, separation=8.0)
    assert (len(one.points), len(two.points)) == (2, 1)
    assert (one.shared, two.shared) == ("", "")


def test_shared_rally_points_are_reported():
    one, two = rally_points(yard(10.0), robots=2, separation=8.0)
    assert one.points == two.points == ((5.0, 5.0),)
    assert one.shared == ""
    assert "no room for all robots in 'yard'" in two.shared


def beside(use=AreaUse.FORBIDDEN, **heights):
    """Return an area west of the yard, from which robots keep 10 m."""
    ring = ((-10.0, -10.0), (-2.0, -10.0), (-2.0, 50.0), (-10.0, 50.0))
    return Area("west", use, ring, safety_distance=10.0, **heights)


@pytest.mark.parametrize("other", [beside(), beside(AreaUse.OBSTACLE, high=8.0)], ids=["forbidden", "low"])
def test_no_robot_comes_down_too_near_to_what_it_keeps_from(other):
    found = [point for each in rally_points(yard(), other, robots=6) for point in each.points]
    assert len(found) == 6
    assert all(east >= -2.0 + 10.0 + 1.5 for east, _ in found)


def test_what_is_above_or_below_all_ways_keeps_nobody_from_coming_down():
    above, below = beside(AreaUse.OBSTACLE, low=31.0), beside(AreaUse.OBSTACLE, high=-1.0)
    assert rally_points(yard(), above, below, robots=3) == rally_points(yard(), robots=3)


def test_an_emergency_area_without_a_clear_place_has_no_refuge():
    (found,) = rally_points(yard(10.0), replace(beside(), safety_distance=30.0))
    assert found.points == ()
