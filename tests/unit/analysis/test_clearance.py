"""Distances kept from areas, worked out by hand."""

from dataclasses import replace
from math import inf, sqrt

import pytest
from checking import finding, findings, given, kind, land, rover, square, strange, take_off

from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.contributions.checks import Status
from mmrs_core.scene import Area, AreaUse, Part
from mmrs_core.testing.small_programs import go, hold, robot


def past(*moves, area, home=(0.0, 0.0, 0.0), **more):
    return finding("clearance", given(robot("a", moves, home=home), areas=(area,), **more))


def to_object(move, target):
    return replace(move, target=target)


def test_margin_is_distance_less_safety_distance_half_diagonal_and_position_error():
    verdict = past(go("by", (20.0, 0.0, 0.0)), area=square(at=(10.0, 6.0), distance=2.0), position_error=0.25)
    assert verdict.status is Status.SAFE
    assert verdict.margin == pytest.approx(5.0 - 2.0 - 0.5 - 0.25)
    assert (verdict.robot, verdict.move, verdict.area, verdict.unit) == ("a", "by", "tower", "m")


def test_a_leg_through_an_area_is_violated_by_all_that_is_required():
    verdict = past(go("m1", (20.0, 0.0, 0.0)), area=square(distance=2.0))
    assert verdict.status is Status.VIOLATED
    assert verdict.margin == pytest.approx(-2.5)
    assert (verdict.robot, verdict.move, verdict.area) == ("a", "m1", "tower")


def test_touching_the_required_distance_is_safe():
    assert past(go("by", (20.0, 0.0, 0.0)), area=square(at=(10.0, 1.5))).status is Status.SAFE


def test_a_millimetre_too_near_is_violated():
    verdict = past(go("by", (20.0, 0.0, 0.0)), area=square(at=(10.0, 1.499)))
    assert verdict.status is Status.VIOLATED
    assert verdict.margin == pytest.approx(-0.001)
    assert verdict.message == "a: GoTo 'by' keeps 0.499 m from 'tower', 0.500 m are required"


def test_an_obstacle_may_be_passed_above_with_the_same_distance():
    high = past(go("over", (20.0, 0.0, 9.5)), area=square(high=9.0), home=(0.0, 0.0, 9.5))
    low = past(go("over", (20.0, 0.0, 9.4)), area=square(high=9.0), home=(0.0, 0.0, 9.4))
    assert (high.status, low.status) == (Status.SAFE, Status.VIOLATED)
    assert low.margin == pytest.approx(-0.1)


def test_an_obstacle_may_be_passed_beneath():
    verdict = past(go("under", (20.0, 0.0, 0.0)), area=square(low=4.0, high=9.0))
    assert verdict.status is Status.SAFE
    assert verdict.margin == pytest.approx(3.5)


def test_distance_to_an_upper_edge_is_measured_across():
    verdict = past(go("by", (20.0, 0.0, 13.0)), area=square(at=(10.0, 5.0), high=10.0), home=(0.0, 0.0, 13.0))
    assert verdict.margin == pytest.approx(sqrt(4.0**2 + 3.0**2) - 0.5)


def test_the_notch_of_a_concave_area_may_be_entered():
    notched = Area(
        "u", AreaUse.FORBIDDEN, ((5, -5), (15, -5), (15, 5), (12, 5), (12, -2), (8, -2), (8, 5), (5, 5))
    )
    verdict = past(go("in", (10.0, 3.0, 0.0)), area=notched, home=(10.0, 20.0, 0.0))
    assert verdict.status is Status.SAFE
    assert verdict.margin == pytest.approx(2.0 - 0.5)


def test_emergency_areas_forbid_nothing():
    verdict = past(go("m1", (20.0, 0.0, 0.0)), area=square(use=AreaUse.EMERGENCY))
    assert verdict.status is Status.SAFE


def test_launch_and_landing_columns_count():
    crane = square("crane", at=(0.0, 0.0), low=5.0, high=6.0)
    flight = robot("a", [take_off("up", 10.0), land("down")])
    verdict = finding("clearance", given(flight, areas=(crane,), robot_kind=kind(launches=True)))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "up")


def test_the_home_of_a_robot_that_stays_counts():
    verdict = past(area=square(at=(0.0, 0.0)))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "start")


def test_each_violated_area_is_named_once_at_its_worst_move():
    areas = (square("near", at=(10.0, 1.2)), square("far", at=(30.0, 1.4)), square("off", at=(10.0, 40.0)))
    moves = [go("m1", (20.0, 0.0, 0.0)), go("m2", (40.0, 0.1, 0.0)), go("m3", (0.0, 0.2, 0.0))]
    found = findings("clearance", given(robot("a", moves), areas=areas))
    assert [(v.area, v.move, v.status) for v in found] == [
        ("near", "m3", Status.VIOLATED),
        ("far", "m3", Status.VIOLATED),
    ]


def test_both_arms_of_a_choice_count():
    detour = [hold("fork"), go("left", (20.0, 30.0, 0.0)), go("right", (20.0, 0.0, 0.0))]
    made = robot("a", detour, choices={"fork": ("c", "left", "right")}, jumps={"left": "stop"})
    verdict = finding("clearance", given(made, areas=(square(),)))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "right")


def test_a_leg_begins_wherever_an_arm_of_a_choice_may_have_ended():
    moves = [
        hold("fork"),
        go("left", (0.0, 30.0, 0.0)),
        go("right", (5.0, 0.0, 0.0)),
        go("on", (20.0, 0.0, 0.0)),
    ]
    made = robot("a", moves, choices={"fork": ("c", "left", "right")}, jumps={"left": "on"})
    verdict = finding("clearance", given(made, areas=(square(at=(10.0, 15.0)),)))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "on")


def test_an_object_is_as_far_as_its_tolerance_from_its_place():
    near = MoveTarget((20.0, 0.0, 0.0), "buoy", 3.0)
    moves = [to_object(go("to buoy", (0.0, 0.0, 0.0)), near)]
    verdict = past(*moves, area=square(at=(20.0, 6.0)))
    assert verdict.margin == pytest.approx(5.0 - 3.0 - 0.5)


def test_what_is_not_known_of_an_object_is_carried_into_the_next_leg_until_a_known_target():
    near = MoveTarget((20.0, 0.0, 0.0), "buoy", 3.0)
    moves = [
        to_object(go("to buoy", (0.0, 0.0, 0.0)), near),
        go("aside", (20.0, -40.0, 0.0)),
        go("back", (0.0, -40.0, 0.0)),
    ]
    both = (square("by", at=(26.0, -20.0)), square("end", at=(20.0, -44.0)))
    by = past(*moves, area=both[0])
    end = past(*moves, area=both[1])
    assert by.margin == pytest.approx(5.0 - 3.0 - 0.5)
    assert end.margin == pytest.approx(3.0 - 0.5 - 3.0)


def test_an_object_without_a_place_is_unknown_and_says_so():
    lost = to_object(go("to buoy", (0.0, 0.0, 0.0)), MoveTarget(None, "buoy", None))
    verdict = past(lost, go("home", (0.0, 0.0, 0.0)), area=square(at=(0.0, 30.0)))
    assert (verdict.status, verdict.move) == (Status.UNKNOWN, "to buoy")
    assert verdict.message == (
        "a: GoTo 'to buoy': where the object 'buoy' is, is not known, and 1 more move is not known"
    )


def test_an_object_without_a_tolerance_is_unknown():
    vague = to_object(go("to buoy", (0.0, 0.0, 0.0)), MoveTarget((5.0, 0.0, 0.0), "buoy", None))
    verdict = past(vague, area=square(at=(0.0, 30.0)))
    assert verdict.status is Status.UNKNOWN
    assert "how far the object 'buoy' may be from its place" in verdict.message


def test_a_violation_is_reported_beside_what_is_unknown():
    moves = [go("m1", (20.0, 0.0, 0.0)), strange("dig")]
    found = findings("clearance", given(robot("a", moves), areas=(square(),)))
    assert [verdict.status for verdict in found] == [Status.VIOLATED, Status.UNKNOWN]
    assert "no plug-in provides the move kind 'Burrow'" in found[1].message


def test_a_robot_whose_way_of_turning_nobody_knows_is_unknown():
    nobody = kind(metaclass=("urn:elsewhere:1.0", "Crawler"))
    verdict = past(go("by", (20.0, 0.0, 0.0)), area=square(at=(10.0, 6.0)), robot_kind=nobody)
    assert verdict.status is Status.UNKNOWN
    assert verdict.message == "a: no plug-in provides a robot kind for type 'plain'"


def test_a_leg_that_is_too_near_however_the_robot_turns_is_violated_beside_that():
    made = given(
        robot("a", [go("m1", (20.0, 0.0, 0.0))]),
        areas=(square(),),
        robot_kind=kind(metaclass=("urn:elsewhere:1.0", "Crawler")),
    )
    found = findings("clearance", made)
    assert [verdict.status for verdict in found] == [Status.VIOLATED, Status.UNKNOWN]


def test_no_context_is_not_checked():
    verdict = finding("clearance", given(robot("a", [go("m1", (1.0, 0.0, 0.0))])))
    assert (verdict.status, verdict.message) == (Status.NOT_CHECKED, "a: no context was given")


def test_a_robot_without_a_home_is_unknown():
    verdict = past(go("m1", (1.0, 0.0, 0.0)), area=square(at=(0.0, 30.0)), home=None)
    assert verdict.status is Status.UNKNOWN


def test_a_missing_robot_type_is_unknown_and_named():
    verdict = finding("clearance", given(robot("a", []), type=rover(), areas=(square(),)))
    without = given(robot("a", []), areas=(square(),))
    without.types.clear()
    verdict = finding("clearance", without)
    assert (verdict.status, verdict.message) == (Status.UNKNOWN, "a: robot type 'plain' is not described")


def test_half_the_diagonal_is_computed_from_the_dimensions_of_the_type():
    size = Part((), {"width": 2.0, "length": 3.0, "height": 6.0})
    verdict = past(
        go("by", (20.0, 0.0, 0.0)),
        area=square(at=(10.0, 6.0)),
        type=rover(half_diagonal=0.1, attributes={"size": size}),
    )
    assert verdict.margin == pytest.approx(5.0 - 3.5)


def round_a_corner(*, fluid: bool, away: float, speed: float = 5.0, end=(20.0, 20.0, 0.0)):
    """Return the verdict on a way to the east and then to `end`, so far below an area at its corner."""
    moves = [replace(go("to", (20.0, 0.0, 0.0)), speed=speed), go("on", end)]
    flown = robot("a", moves)
    flows = {index: replace(each, fluid=fluid and index == 1) for index, each in flown.transitions.items()}
    area = square(at=(20.5, -away - 1.0))
    return finding(
        "clearance",
        given(replace(flown, transitions=flows), areas=(area,), robot_kind=kind(acceleration=2.0)),
    )


def test_a_corner_that_is_gone_through_without_a_stop_needs_the_room_by_which_it_is_cut():
    stops, flows = (round_a_corner(fluid=fluid, away=3.0, speed=1.0) for fluid in (False, True))
    assert flows.margin == pytest.approx(stops.margin - 2.0)
    assert (flows.move, flows.status) == ("to", Status.SAFE)
    assert round_a_corner(fluid=True, away=1.5, speed=1.0).status is Status.VIOLATED


def test_the_faster_a_corner_is_gone_through_the_more_room_it_needs():
    margins = [round_a_corner(fluid=True, away=40.0, speed=speed).margin for speed in (1.0, 2.0, 5.0, 10.0)]
    assert margins == sorted(margins, reverse=True)
    assert margins[0] > margins[-1]


def test_a_way_that_goes_straight_on_cuts_nothing():
    flows = round_a_corner(fluid=True, away=3.0, end=(40.0, 0.0, 0.0))
    stops = round_a_corner(fluid=False, away=3.0, end=(40.0, 0.0, 0.0))
    assert flows.margin == pytest.approx(stops.margin)


def round_a_corner_like_a_car(*, fluid: bool, then: float):
    """Return the verdict on ten metres to the east and then some to the north, with a turning radius of 2."""
    flown = robot("a", [go("to", (10.0, 0.0, 0.0)), go("on", (10.0, then, 0.0))])
    flows = {index: replace(each, fluid=fluid and index == 1) for index, each in flown.transitions.items()}
    area = square(at=(10.0, -10.0))
    made = given(replace(flown, transitions=flows), areas=(area,), robot_kind=kind(turning_radius=2.0))
    return finding("clearance", made)


def test_a_corner_that_the_narrowest_curve_fits_into_needs_no_more_room_than_to_turn():
    stops, flows = (round_a_corner_like_a_car(fluid=fluid, then=4.0) for fluid in (False, True))
    assert flows.margin == pytest.approx(stops.margin)


def test_a_corner_that_the_narrowest_curve_does_not_fit_into_is_overrun_by_the_turning_circle():
    stops, flows = (round_a_corner_like_a_car(fluid=fluid, then=3.0) for fluid in (False, True))
    assert flows.margin == pytest.approx(stops.margin - 4.0)


def before_an_area(*, length: float = 20.0, acceleration=inf, then=None, fluid=False, speed=4.0):
    """Return the margin to an area ten metres beyond the end of a leg to the east, at 0.1 s of overshoot."""
    end = (length, 0.0, 0.0)
    moves = [replace(go("to", end), speed=speed), *([] if then is None else [go("on", then)])]
    flown = robot("a", moves)
    flows = {index: replace(each, fluid=fluid and index == 1) for index, each in flown.transitions.items()}
    found = kind(acceleration=acceleration, overshoot=0.1)
    areas = (square(at=(length + 11.0, 0.0)),)
    made = given(replace(flown, transitions=flows), areas=areas, robot_kind=found)
    return finding("clearance", made).margin


def test_a_robot_that_stops_late_comes_nearer_to_what_is_ahead():
    assert before_an_area() == pytest.approx(10.0 - 0.5 - 0.1 * 4.0)


def test_a_robot_that_stops_late_does_so_less_where_it_is_slower_or_its_leg_too_short_to_be_fast():
    assert before_an_area(speed=1.0) == pytest.approx(10.0 - 0.5 - 0.1)
    assert before_an_area(length=2.0, acceleration=2.0) == pytest.approx(10.0 - 0.5 - 0.1 * 2.0)


def test_a_robot_that_passes_a_place_without_a_stop_does_not_stop_late_there():
    on = (20.0, 0.5, 0.0)
    stops, flows = (before_an_area(then=on, fluid=fluid, speed=30.0) for fluid in (False, True))
    assert stops == pytest.approx(10.0 - 0.5 - 3.0)
    assert flows > stops


def test_a_way_through_an_obstacle_is_violated_though_the_type_is_not_described():
    made = given(robot("a", [go("m1", (20.0, 0.0, 0.0))]), areas=(square(),))
    found = findings("clearance", replace(made, types={}))
    assert [verdict.status for verdict in found] == [Status.VIOLATED, Status.UNKNOWN]
    assert found[0].area == "tower"
