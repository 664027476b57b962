"""Where robots come down when all of them have to at once."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from math import dist

from mmrs_core.behaviour.refuges import refuges_of
from mmrs_core.scene import Area, AreaUse
from mmrs_core.testing.programs import program, quad, robot_program


def refuges(*areas, robots=1, error=1.0, separation=None):
    """Return where each of so many robots comes down."""
    fleet = program(*(robot_program(f"r{n}", []) for n in range(robots)))
    fleet = replace(fleet, position_error=error, minimum_separation=separation)
    return [refuges_of(robot, fleet, {quad().name: quad()}, areas) for robot in fleet.robots]


def yard(side=40.0, *, name="yard", distance=2.0):
    ring = ((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))
    return Area(name, AreaUse.EMERGENCY, ring, safety_distance=distance)


def test_an_emergency_area_that_is_too_small_has_no_refuge():
    (found,) = refuges(yard(10.0))
    assert found.points == ((5.0, 5.0),)
    (none,) = refuges(yard(6.9))
    assert none.points == ()


def test_each_robot_comes_down_elsewhere():
    found = [each.points for each in refuges(yard(), yard(60.0, name="field"), robots=4, separation=8.0)]
    for points in zip(*found, strict=True):
        assert min(dist(a, b) for a, b in combinations(points, 2)) >= 8.0
    assert all(min(*point, 40.0 - point[0], 40.0 - point[1]) >= 3.5 for point, _ in found)


def test_robots_for_which_there_is_no_room_in_one_area_use_the_others():
    small, large = yard(10.0, name="small"), yard(80.0, name="large")
    one, two = refuges(small, large, robots=2, separation=8.0)
    assert (len(one.points), len(two.points)) == (2, 1)
    assert (one.shared, two.shared) == ("", "")


def test_people_are_told_where_robots_must_share_a_place():
    one, two = refuges(yard(10.0), robots=2, separation=8.0)
    assert one.points == two.points == ((5.0, 5.0),)
    assert one.shared == ""
    assert "no room for all of them in 'yard'" in two.shared
