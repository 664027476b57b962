from __future__ import annotations

from dataclasses import replace
from math import inf

import pytest

from mmrs_core.mavlink.safety import clearance_of, escape_from, policies_of, refuges
from mmrs_core.scene import Area, AreaUse, Policy
from mmrs_core.testing.programs import program, quad, robot_program, target_input

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


def test_an_emergency_area_that_is_too_small_has_no_refuge():
    area = Area("yard", AreaUse.EMERGENCY, SQUARE, safety_distance=2.0)
    assert refuges([area], 2.0) == ((5.0, 5.0),)
    assert refuges([area], 3.1) == ()


def test_clearance_is_half_the_diagonal_and_the_position_error():
    assert clearance_of(quad(), 1.0) == 1.5
    assert clearance_of(None, 1.0) == 1.0


def test_the_nearest_refuge_is_taken():
    assert escape_from((0.0, 0.0, 20.0), [(50.0, 0.0), (-30.0, 0.0)], [], 1.0) == (-30.0, 0.0, 20.0)


def wall(low: float = -inf, distance: float = 0.0) -> Area:
    ring = ((-20.0, -5.0), (-10.0, -5.0), (-10.0, 5.0), (-20.0, 5.0))
    return Area("wall", AreaUse.OBSTACLE, ring, low, inf, distance)


def test_a_refuge_behind_an_obstacle_is_not_gone_to():
    points = [(50.0, 0.0), (-30.0, 0.0)]
    assert escape_from((0.0, 0.0, 20.0), points, [wall()], 1.0) == (50.0, 0.0, 20.0)
    assert escape_from((0.0, 0.0, 20.0), points[1:], [wall()], 1.0) is None


def test_a_refuge_under_an_obstacle_that_hangs_above_is_gone_to():
    assert escape_from((0.0, 0.0, 20.0), [(-30.0, 0.0)], [wall(low=40.0)], 1.0) == (-30.0, 0.0, 20.0)


@pytest.mark.parametrize(("north", "safe"), [(6.9, False), (7.1, True)])
def test_an_escape_keeps_clearance_and_safety_distance(north, safe):
    found = escape_from((0.0, north, 20.0), [(-30.0, north)], [wall(distance=1.0)], 1.0)
    assert (found is not None) is safe


def test_a_policy_of_the_type_counts_where_mission_and_robot_say_nothing():
    type = replace(quad(), policies=(Policy("PEER_LOST", "LAND", 7.0), Policy("LINK_LOST", "LAND")))
    robot = replace(robot_program("a", []), policies=(Policy("LINK_LOST", "HOLD", 1.0),))
    assert policies_of(robot, target_input(program(robot), [type])) == (
        Policy("LINK_LOST", "HOLD", 1.0),
        Policy("PEER_LOST", "LAND", 7.0),
    )
