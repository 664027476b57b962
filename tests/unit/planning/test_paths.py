from math import inf

import pytest

from mmrs_core.errors import UnreachableError
from mmrs_core.geometry.segments import legs_of, prism_distance
from mmrs_core.planning.paths import Space
from mmrs_core.scene import Area, AreaUse
from mmrs_core.scene.timing import Rates


def box(west, south, east, north, *, low=-inf, high=inf, safety=0.0, name="box"):
    ring = ((west, south), (east, south), (east, north), (west, north))
    return Area(name, AreaUse.OBSTACLE, ring, low, high, safety)


def least_margin(route, areas, clearance):
    legs = legs_of(route)
    return min(
        prism_distance(legs, area.shell, area.low, area.high).min() - area.safety_distance - clearance
        for area in areas
    )


def test_a_free_way_is_straight():
    assert Space((), 1.0).route((0, 0, 5), (100, 50, 20)) == ((0, 0, 5), (100, 50, 20))


def test_a_way_around_keeps_its_distance_and_is_hardly_longer_than_it_must_be():
    areas = (box(40, -30, 60, 30, safety=2.0),)
    route = Space(areas, 1.0).route((0, 0, 5), (100, 0, 5))
    assert least_margin(route, areas, 1.0) >= 0.0
    assert 2 * (39.0**2 + 32.0**2) ** 0.5 < Space((), 0.0).seconds(route) < 124.2
    assert {point[2] for point in route} == {5}


def test_a_low_obstacle_is_flown_over():
    areas = (box(40, -300, 60, 300, high=10.0),)
    route = Space(areas, 1.0, 2.0, 50.0).route((0, 0, 5), (100, 0, 5))
    assert max(point[2] for point in route) == pytest.approx(11.0, abs=0.01)
    assert least_margin(route, areas, 1.0) >= 0.0


def test_a_raised_obstacle_is_passed_below():
    areas = (box(40, -300, 60, 300, low=10.0),)
    route = Space(areas, 1.0, 2.0, 50.0).route((0, 0, 20), (100, 0, 20))
    assert 2.0 <= min(point[2] for point in route) <= 9.0
    assert least_margin(route, areas, 1.0) >= 0.0


def test_the_ceiling_sends_a_route_around():
    areas = (box(40, -300, 60, 300, high=10.0),)
    route = Space(areas, 1.0, 2.0, 10.9).route((0, 0, 5), (100, 0, 5))
    assert max(abs(point[1]) for point in route) > 300
    assert least_margin(route, areas, 1.0) >= 0.0


def test_slow_climbing_sends_a_route_around():
    areas = (box(40, -30, 60, 30, high=40.0),)
    around = Space(areas, 1.0, rates=Rates(10.0, 0.5, 0.5)).route((0, 0, 5), (100, 0, 5))
    over = Space(areas, 1.0, rates=Rates(1.0, 50.0, 50.0)).route((0, 0, 5), (100, 0, 5))
    assert max(point[2] for point in around) == 5
    assert max(point[2] for point in over) > 40


def test_touching_counts_as_clear():
    areas = (box(0, 0, 10, 10, safety=2.0),)
    assert Space(areas, 1.0).is_clear(((-3, -50, 5), (-3, 50, 5)))
    assert not Space(areas, 1.0).is_clear(((-2.99, -50, 5), (-2.99, 50, 5)))


def test_touching_from_above_counts_as_clear():
    areas = (box(0, 0, 10, 10, high=20.0),)
    assert Space(areas, 1.0).is_clear(((-5, 5, 21), (15, 5, 21)))
    assert not Space(areas, 1.0).is_clear(((-5, 5, 20.9), (15, 5, 20.9)))


def test_a_route_may_begin_in_the_rim_that_growing_gives_away():
    areas = (box(0, 0, 10, 10, safety=9.0),)
    route = Space(areas, 1.0).route((-10, 5, 5), (20, 5, 5))
    assert least_margin(route, areas, 1.0) >= -1e-9


def test_a_robot_walled_in_everywhere_is_told_by_what():
    walls = (
        box(-20, -20, 20, -10, name="south"),
        box(-20, 10, 20, 20, name="north"),
        box(-20, -15, -10, 15, name="west"),
        box(10, -15, 20, 15, name="east"),
    )
    with pytest.raises(UnreachableError, match="'east', 'north', 'south', 'west'"):
        Space(walls, 1.0).route((0, 0, 5), (100, 0, 5))


def test_a_goal_within_a_clearance_is_told_by_what():
    with pytest.raises(UnreachableError, match=r"goal \(5\.0, 5\.0, 5\.0\) is within the clearance of 'box'"):
        Space((box(0, 0, 10, 10),), 1.0).route((-50, 0, 5), (5, 5, 5))


def test_a_yard_with_a_roof_is_entered_by_changing_height_twice():
    yard = (
        box(-20, -20, 20, -10, high=30.0, name="south"),
        box(-20, 10, 20, 20, high=30.0, name="north"),
        box(-20, -15, -10, 15, high=30.0, name="west"),
        box(10, -15, 20, 15, high=30.0, name="east"),
        box(-6, -6, 6, 6, low=15.0, high=100.0, name="roof"),
    )
    route = Space(yard, 1.0, 2.0, 60.0).route((0, 0, 5), (100, 0, 5))
    assert least_margin(route, yard, 1.0) >= 0.0


def test_a_robot_that_cannot_climb_stays_at_its_height():
    with pytest.raises(UnreachableError, match="up or down"):
        Space((), 1.0, rates=Rates(1.0, 0.0, 0.0)).route((0, 0, 0), (10, 0, 5))


def test_the_same_question_has_the_same_answer():
    areas = tuple(box(20 * k, -15 + 3 * k, 20 * k + 10, 15 + 3 * k, name=f"b{k}") for k in range(5))
    space = Space(areas, 1.0)
    first = space.route((-20, 0, 5), (130, 0, 5))
    assert space.route((-20, 0, 5), (130, 0, 5)) == first == Space(areas, 1.0).route((-20, 0, 5), (130, 0, 5))
