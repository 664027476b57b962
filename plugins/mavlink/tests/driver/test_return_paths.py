"""Ways back: where the program has led or still leads, and no farther than needed."""

from itertools import pairwise

import pytest

from mmrs_mavlink.program import Choose, GoTo, Land, Local, Robot, Start, Step, Stop, TakeOff, Then
from mmrs_runtime.controllers.geodesy import distance_to_leg
from mmrs_runtime.controllers.return_paths import way_back

FAR = Local(400.0, 80.0, 10.0)
HOME, UP = Local(0.0, 0.0, 0.0), Local(0.0, 0.0, 10.0)
A, B, C = Local(100.0, 0.0, 10.0), Local(100.0, 80.0, 10.0), Local(0.0, 80.0, 10.0)


def robot(*places, last=None, **more):
    """Fly by these places, named p0, p1 …, then home, and land."""
    names = [f"p{index}" for index in range(len(places))] + ["home", "down"]
    steps = [Step("start", Start(), then=Then("up")), Step("up", TakeOff(10.0), then=Then(names[0]))]
    steps += [
        Step(n, GoTo(p), then=Then(f)) for n, p, f in zip(names, [*places, UP], names[1:], strict=False)
    ]
    steps[-1] = last or steps[-1]
    steps += [Step("down", Land(), then=Then("stop")), Step("stop", Stop())]
    return Robot("r", "r.jsonl", "copter", HOME, "start", tuple(steps), **more)


def track(*places):
    return [("up", UP), *((f"p{index}", place) for index, place in enumerate(places))]


def back(given, passed, here, response="RETURN"):
    return list(way_back(given, response, passed, here))


def test_a_robot_goes_back_the_way_it_came():
    assert back(robot(A, B, FAR), track(A, B), Local(105.0, 80.0, 10.0)) == [B, A, UP]


def test_a_robot_in_the_middle_of_an_earlier_leg_begins_there():
    assert back(robot(A, B, C), track(A, B), Local(100.0, 40.0, 10.0)) == [A, UP]


def test_a_way_that_came_back_to_a_place_is_cut_short_there():
    passed = track(A, B, C, B)
    assert back(robot(A, B, C, B, FAR), passed, Local(105.0, 80.0, 10.0)) == [B, A, UP]


@pytest.mark.parametrize("height", [8.0, 12.0])
def test_above_home_there_is_no_way_left_to_go(height):
    assert back(robot(A, B), [*track(A, B), ("home", UP)], Local(0.3, 0.0, height)) == []


def test_on_the_last_leg_home_is_nearer_ahead():
    assert back(robot(A, B, C), track(A, B, C), Local(0.0, 10.0, 10.0)) == [UP]
    assert back(robot(A, B, C), track(A, B, C), Local(0.0, 75.0, 10.0)) == [UP]


def test_the_whole_rest_of_the_way_counts_where_it_is_shorter():
    assert back(robot(A, B, C), track(A, B), Local(20.0, 80.0, 10.0)) == [C, UP]


def test_nobody_goes_ahead_where_a_choice_is_still_open():
    given = robot(A, B, C, last=Step("home", GoTo(UP), then=Choose("calm", "down", "p0")))
    assert back(given, track(A, B, C), Local(0.0, 10.0, 10.0)) == [C, B, A, UP]


def test_an_emergency_area_is_left_for_where_its_leg_was_checked():
    area = Local(120.0, -20.0, 10.0)
    given = robot(A, B, C, escapes=(("p0", (area,)),))
    assert back(given, track(A, B), Local(95.0, 80.0, 10.0), "EMERGENCY_AREA") == [B, A, area]


def test_other_responses_have_no_way():
    assert back(robot(A), track(A), A, "LAND") == []


def test_the_way_to_an_emergency_area_may_have_corners():
    over, area = Local(100.0, 0.0, 30.0), Local(120.0, -20.0, 30.0)
    given = robot(A, B, C, escapes=(("p0", (over, area)),))
    assert back(given, track(A, B), Local(95.0, 80.0, 10.0), "EMERGENCY_AREA") == [B, A, over, area]


def test_the_end_of_the_leg_that_a_robot_is_on_is_gone_to_where_the_area_is_nearer_from_there():
    area = Local(-20.0, 100.0, 10.0)
    given = robot(A, B, C, escapes=(("p0", (area,)), ("p2", (area,))))
    assert back(given, track(A, B), Local(20.0, 80.0, 10.0), "EMERGENCY_AREA") == [C, area]
    assert back(given, track(A, B), Local(20.0, 60.0, 10.0), "EMERGENCY_AREA") == [B, A, area]
    assert back(given, track(A, B), B, "EMERGENCY_AREA") == [A, area]


def test_places_on_one_line_are_gone_through_at_once():
    row = [Local(100.0, float(east), 10.0) for east in range(0, 81, 10)]
    assert back(robot(*row, FAR), track(*row), row[-1]) == [row[0], UP]


def test_a_line_that_bends_little_by_little_is_no_straight_one():
    bend = [Local(100.0 - 0.001 * east**2, float(east), 10.0) for east in range(0, 81, 10)]
    found = back(robot(*bend, FAR), track(*bend), bend[-1])
    assert 4 < len(found) < 9
    legs = list(pairwise([bend[-1], *found]))
    assert max(min(distance_to_leg(place, *leg) for leg in legs) for place in bend) <= 0.1
