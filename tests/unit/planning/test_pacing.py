from dataclasses import replace
from itertools import combinations_with_replacement
from math import cos, dist, radians, sin

import pytest
from plain_scenes import box, photo, road, robot, scene, visit, with_kinematics

from mmrs_core.planning.flown_legs import halts_of
from mmrs_core.planning.pacing import paced
from mmrs_core.planning.strokes import joined, parts_of, serve_seconds, turned
from mmrs_core.planning.team import Team
from mmrs_core.scene import Device, Look
from mmrs_runtime.timing import LegTiming

SLUGGISH = with_kinematics(robot(), timing=LegTiming(0.5))
STEP = LegTiming(2.5, deceleration=1.5, jerk=5.0, spread=0.18)
MISSION = LegTiming(2.5, jerk=0.9, corner_radius=2.0, settling=1.55, spread=0.18)
CUTS = (25.0, 50.0, 75.0)


def pilot_of(each=SLUGGISH, **features):
    whole = scene([each], {"a": visit((0.0, 9.0, 20.0))}, **features)
    return Team(whole).pilots[each.name]


def parts(*points, **features):
    (stroke,) = road(*points, **{"cuts": CUTS, **features}).strokes
    return parts_of(stroke), stroke


def test_a_cut_costs_no_stop_where_one_robot_does_both_sides():
    cut, stroke = parts((0.0, 0.0, 20.0), (400.0, 0.0, 20.0))
    spans = paced(cut, pilot_of())
    assert spans[-1][1] - spans[0][0] == pytest.approx(40.0 + 20.0)
    assert serve_seconds(stroke, SLUGGISH, SLUGGISH.kinematics) == pytest.approx(40.0 + 20.0)


def test_each_run_of_parts_takes_as_long_as_its_stroke():
    cut, _ = parts((0.0, 0.0, 20.0), (1200.0, 0.0, 20.0), cuts=(300.0, 600.0, 900.0))
    spans = paced(cut, pilot_of())
    assert spans[1][1] - spans[1][0] == pytest.approx(30.0 + 20.0)
    assert spans[2][1] - spans[1][0] == pytest.approx(60.0 + 20.0)


def test_a_cut_at_a_bend_costs_nothing_more():
    cut, _ = parts((0.0, 0.0, 20.0), (300.0, 0.0, 20.0), (300.0, 300.0, 20.0), cuts=(300.0,))
    assert paced(cut, pilot_of()) == [(0.0, pytest.approx(50.0)), (pytest.approx(50.0), pytest.approx(100.0))]


def test_an_action_at_a_cut_is_counted_with_the_part_that_it_belongs_to():
    cut, _ = parts((0.0, 0.0, 20.0), (600.0, 0.0, 20.0), cuts=(300.0,), actions=(photo(300.0),))
    assert paced(cut, pilot_of())[0] == (0.0, pytest.approx(50.0))
    other = paced([turned(part) for part in reversed(cut)], pilot_of())
    assert other[0] == (0.0, pytest.approx(51.0))
    assert other[1] == (pytest.approx(51.0), pytest.approx(101.0))


def test_a_hold_comes_at_the_end_of_the_last_part():
    cut, _ = parts((0.0, 0.0, 20.0), (400.0, 0.0, 20.0), hold=9.0)
    assert paced(cut, pilot_of())[-1][1] == pytest.approx(69.0)


def test_hops_are_between_parts_that_do_not_meet():
    one, two = (road((0.0, north, 20.0), (300.0, north, 20.0)).strokes[0] for north in (0.0, 200.0))
    spans = paced([one, turned(two)], pilot_of())
    assert spans[1][0] - spans[0][1] == pytest.approx(20.0 + 20.0)


def test_points_are_hopped_to_at_their_speed():
    slow = visit((0.0, 0.0, 20.0), (100.0, 0.0, 20.0), slow_down=0.5).strokes
    assert paced(slow, pilot_of(robot()))[1][0] == pytest.approx(20.0)


def test_nothing_takes_no_time():
    assert paced([], pilot_of()) == []


def test_hops_keep_clear():
    one, two = visit((0.0, 0.0, 20.0), (100.0, 0.0, 20.0)).strokes
    around = pilot_of(robot(), areas=(box("wall", 40, -30, 60, 30),))
    assert paced([one, replace(two)], around)[1][0] > 11.0


def test_at_the_soonest_a_robot_goes_on_where_nothing_is_done():
    bend, _ = parts((0.0, 0.0, 20.0), (300.0, 0.0, 20.0), (300.0, 300.0, 20.0), cuts=(150.0,))
    assert paced(bend, pilot_of(), -1)[-1][1] == pytest.approx(60.0)


def test_at_the_soonest_a_robot_still_stops_between_two_actions():
    cut, _ = parts((0.0, 0.0, 20.0), (300.0, 0.0, 20.0), cuts=(), actions=(photo(0.0), photo(300.0)))
    assert paced(cut, pilot_of(), -1)[-1][1] == pytest.approx(50.0 + 2.0)


def test_at_the_soonest_actions_take_as_long_as_they_take_at_least():
    cut, _ = parts((0.0, 0.0, 20.0), (300.0, 0.0, 20.0), cuts=(), actions=(photo(0.0), photo(300.0)))
    spread = with_kinematics(robot(), timing=LegTiming(spread=0.2))
    assert paced(cut, pilot_of(spread), -1)[-1][1] == pytest.approx(0.8 * (30.0 + 2.0))


def test_where_robots_stop_at_every_corner_the_soonest_is_what_is_planned():
    cut, _ = parts((0.0, 0.0, 20.0), (300.0, 0.0, 20.0), (300.0, 300.0, 20.0))
    strict = pilot_of(minimum_separation=5.0)
    assert paced(cut, strict, -1) == paced(cut, strict)


@pytest.mark.parametrize(("photo_at", "flown_as_mission"), [(200.0, True), (300.0, False)])
def test_a_leg_a_hop_and_a_leg_in_one_go_may_take_as_long_as_on_a_mission(photo_at, flown_as_mission):
    flown = with_kinematics(robot(), timing=LegTiming(2.0), mission=LegTiming(0.5))
    pilot = pilot_of(flown)
    one, two = (
        road((0.0, north, 20.0), (300.0, north, 20.0), actions=(photo(at),)).strokes[0]
        for north, at in ((0.0, 100.0), (50.0, photo_at))
    )
    alone, led_on = (paced(parts, pilot, 1, (1, 1))[0][1] for parts in ([one], [one, turned(two)]))
    longer = 20.0 - 5.0
    beside = pilot.travel.upload_seconds(1)
    assert led_on - alone == pytest.approx((longer + beside) * flown_as_mission)


def test_a_robot_that_looks_at_one_place_stops_only_where_it_begins_and_ends_that():
    ring = road(*((north, 0.0, 20.0) for north in (0.0, 30.0, 60.0, 90.0)), look=Look((45.0, 50.0, 0.0)))
    (stroke,), type = ring.strokes, robot().type
    assert halts_of(stroke, type) == [True, False, False, True]
    aside = replace(stroke, look=replace(stroke.look, angle_degrees=90.0))
    assert halts_of(aside, type) == [True] * 4
    on_the_left = Device("camera", {}, {"mount.yaw": "-90"})
    mounted = replace(type, devices={"camera": on_the_left})
    assert halts_of(replace(stroke, look=replace(stroke.look, device="camera")), mounted) == [True] * 4


@pytest.mark.parametrize("cut", [60.0, 67.0, 100.0])
def test_parts_of_a_curve_take_no_longer_than_their_spans_when_they_are_flown_alone(cut):
    """What is flown in one go passes the corner at the cut; what begins or ends there does not."""
    ring = [(60.0 * sin(angle), 60.0 * cos(angle), 20.0) for angle in (radians(10.0 * k) for k in range(19))]
    cuts = tuple(cut * k for k in range(1, 4) if cut * k < 180.0)
    (stroke,) = road(*ring, cuts=cuts, look=Look((0.0, 0.0, 0.0))).strokes
    pieces, pilot = parts_of(stroke), pilot_of(with_kinematics(robot(), timing=STEP, mission=MISSION))
    spans = paced(pieces, pilot, 1)
    for first, last in combinations_with_replacement(range(len(pieces)), 2):
        alone = paced([*joined(pieces[first : last + 1])], pilot, 1)
        assert spans[last][1] - spans[first][0] >= alone[-1][1] - alone[0][0] - 1e-9


@pytest.mark.parametrize(
    "mission", [MISSION, replace(MISSION, jerk=3.0, turning=0.5), replace(MISSION, passes=False)]
)
@pytest.mark.parametrize("look", [Look((0.0, 0.0, 0.0)), None])
@pytest.mark.parametrize("cut", [60.0, 67.0, 100.0])
def test_a_curve_that_is_flown_in_one_go_takes_as_long_as_its_mission(mission, look, cut):
    """A cut within a leg is counted about a second too early or late on either side."""
    ring = [(60.0 * sin(angle), 60.0 * cos(angle), 20.0) for angle in (radians(10.0 * k) for k in range(19))]
    cuts = tuple(cut * k for k in range(1, 4) if cut * k < 180.0)
    (stroke,) = road(*ring, cuts=cuts, look=look).strokes
    pieces, pilot = (
        parts_of(stroke),
        pilot_of(with_kinematics(robot(), timing=replace(STEP, passes=False), mission=mission)),
    )
    spans = paced(pieces, pilot)
    assert spans[-1][1] == pytest.approx(pilot.serve_seconds(stroke))
    stepped = serve_seconds(stroke, pilot.robot, pilot.kinematics)
    assert (pilot.serve_seconds(stroke) < stepped - 3.0) is mission.passes
    for first, last in combinations_with_replacement(range(len(pieces)), 2):
        (alone,) = joined(pieces[first : last + 1])
        assert spans[last][1] - spans[first][0] == pytest.approx(
            pilot.serve_seconds(alone), rel=0.06, abs=2.2
        )


def test_what_is_cut_off_may_become_part_of_a_mission_with_a_hop():
    """In the whole line a photo ends each two legs, which are too few for a mission."""
    corners = [(30.0 * k, 20.0 * (k % 2), 20.0) for k in range(9)]
    length = dist(*corners[:2])
    photos, cuts = (tuple(2.0 * length * k for k in numbers) for numbers in (range(5), range(1, 4)))
    (stroke,) = road(*corners, cuts=cuts, actions=tuple(map(photo, photos))).strokes
    pieces, pilot = parts_of(stroke), pilot_of(with_kinematics(robot(), timing=STEP, mission=MISSION))
    spans = paced(pieces, pilot, 1)
    for first, last in combinations_with_replacement(range(len(pieces)), 2):
        alone = paced([*joined(pieces[first : last + 1])], pilot, 1)
        assert spans[last][1] - spans[first][0] >= alone[-1][1] - alone[0][0] - 1e-9


def test_places_on_a_straight_line_are_passed_where_no_missions_are_uploaded():
    each = with_kinematics(robot(), timing=STEP, mission=MISSION)
    whole = scene([each], {"a": visit((0.0, 9.0, 20.0))})
    local = Team(replace(whole, frame=replace(whole.frame, latitude=None, longitude=None))).pilots["r1"]
    (line,) = road(*((20.0 * k, 0.0, 20.0) for k in range(5))).strokes
    (bent,) = road(*((20.0 * k, 20.0 * (k % 2), 20.0) for k in range(5))).strokes
    assert local.serve_seconds(line) < serve_seconds(line, each, each.kinematics) - 3.0
    assert local.serve_seconds(bent) == pytest.approx(serve_seconds(bent, each, each.kinematics))
    assert paced(parts_of(line), local)[-1][1] == pytest.approx(local.serve_seconds(line))
