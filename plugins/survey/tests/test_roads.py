from dataclasses import replace
from itertools import pairwise
from math import cos, dist, sin, sqrt

import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mmrs_survey.lines import cuts_between, even_distances, passes, without_dense
from mmrs_survey.roads import road_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked

LINE = ((0.0, 0.0, 5.0), (100.0, 0.0, 5.0), (100.0, 80.0, 9.0))


def road(task, **more):
    given = {
        "points": LINE,
        "initialPosition": (-10.0, 0.0, 0.0),
        "altitude": 20.0,
        "actionName": "TakePicture",
    }
    return task("RoadTask", **{**given, **more})


def test_overlaps_alone_ask_for_photos_as_near_as_the_optics_make_them(robot, scene, task):
    """From 20 m, a photo shows 30 by 20 m."""
    asked = road(task, width=40.0, frontOverlap=0.5, sideOverlap=0.5)
    strokes = road_work(asked, robot(), scene()).strokes
    assert len(strokes) == 3
    for each in strokes:
        at = [0.0, *(action.at for action in each.actions)]
        assert len(at) > 10
        assert all(two - one <= 10.0 + 1e-9 for one, two in pairwise(at))
    with pytest.raises(InfeasibleError, match="does not state what one photo covers"):
        road_work(asked, robot(properties={}), scene())


def test_a_line_without_width_is_followed_once_at_its_altitude(robot, scene, task):
    (stroke,) = road_work(road(task), robot(), scene()).strokes
    assert stroke.points == ((0.0, 0.0, 20.0), (100.0, 0.0, 20.0), (100.0, 80.0, 20.0))


def test_a_line_without_altitude_keeps_the_heights_of_its_points(robot, scene, task):
    asked = road(task, altitude=None, initialPosition=(-10.0, 0.0, 5.0))
    assert road_work(asked, robot(), scene()).strokes[0].points == LINE


def test_a_line_drawn_freehand_is_followed_on_longer_legs(robot, scene, task):
    drawn = tuple((step / 10, 10.0 * sin(step / 100), 5.0) for step in range(1001))
    (stroke,) = road_work(road(task, points=drawn), robot(), scene()).strokes
    assert len(stroke.points) < 40
    away = shapely.hausdorff_distance(shapely.LineString(stroke.points), shapely.LineString(drawn))
    assert away <= 0.1 + 1e-9


places = st.tuples(*[st.floats(-20.0, 20.0).map(lambda each: round(each, 2))] * 3)


@given(st.lists(places, max_size=12), st.integers(1, 12))
def test_what_is_left_of_a_line_is_within_a_tenth_of_a_metre_of_all_of_it(corners, parts):
    drawn = [
        tuple(a + (b - a) * part / parts for a, b in zip(one, two, strict=True))
        for one, two in pairwise(corners)
        for part in range(parts)
    ]
    drawn += corners[-1:]
    left = without_dense(drawn)
    assert set(left) <= set(drawn)
    assert bool(left) == bool(drawn)
    for end in (0, -1) if drawn else ():
        assert dist(left[end], drawn[end]) <= 1e-6
    legs = [*pairwise(left)] or [(*left, *left)]
    for point in drawn:
        assert min(away(point, *leg) for leg in legs) <= 0.1 + 1e-6


def away(point, begin, end):
    """Return the distance of a point from a leg, by Heron's formula where no end is nearest."""
    a, b, c = dist(begin, end), dist(point, begin), dist(point, end)
    if a < 1e-9 or b * b >= a * a + c * c or c * c >= a * a + b * b:
        return min(b, c)
    half = (a + b + c) / 2
    return 2 / a * sqrt(max(0.0, half * (half - a) * (half - b) * (half - c)))


def test_an_inverted_line_is_followed_from_its_end(robot, scene, task):
    (stroke,) = road_work(road(task, inverted=True), robot(), scene()).strokes
    assert stroke.points[0] == (100.0, 80.0, 20.0)
    assert not stroke.reversible


def test_the_task_begins_at_its_initial_position(robot, scene, task):
    assert road_work(road(task), robot(), scene()).entry == (-10.0, 0.0, 20.0)


def test_photos_are_taken_every_so_many_metres_and_at_the_end(robot, scene, task):
    (stroke,) = road_work(road(task, photoDistance=50.0), robot(), scene()).strokes
    assert [action.at for action in stroke.actions] == [0.0, 50.0, 100.0, 150.0, 180.0]
    assert {action.device for action in stroke.actions} == {"camera"}


def test_work_is_split_between_photos_never_at_one(robot, scene, task):
    (stroke,) = road_work(road(task, photoDistance=50.0), robot(), scene()).strokes
    assert stroke.cuts == (25.0, 75.0, 125.0, 165.0)


def test_a_wide_corridor_takes_parallel_passes_to_and_fro(robot, scene, task):
    asked = road(task, points=((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)), width=40.0, footprintWidth=15.0)
    strokes = road_work(asked, robot(), scene()).strokes
    ways = [[(round(east, 6), round(north, 6)) for east, north, _ in stroke.points] for stroke in strokes]
    assert ways == [
        [(0.0, -13.333333), (100.0, -13.333333)],
        [(100.0, 0.0), (0.0, 0.0)],
        [(0.0, 13.333333), (100.0, 13.333333)],
    ]


def test_overlaps_set_passes_and_photos_and_passes_turn_around_beyond_the_corridor(robot, scene, task):
    straight = {"points": ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)), "width": 40.0, "turnaroundDistance": 12.0}
    seen = {"footprintWidth": 40.0, "footprintLength": 30.0, "sideOverlap": 0.5, "frontOverlap": 0.6}
    strokes = road_work(road(task, **straight, **seen), robot(), scene()).strokes
    assert [[round(east) for east, *_ in stroke.points] for stroke in strokes] == [
        [-12, 0, 100, 112],
        [112, 100, 0, -12],
    ]
    assert [stroke.points[0][1] for stroke in strokes] == [-10.0, 10.0]
    assert strokes[0].spots == pytest.approx((12, 24, 36, 48, 60, 72, 84, 96, 108, 112))


def test_a_corridor_that_is_seen_at_once_takes_one_pass(robot, scene, task):
    assert len(road_work(road(task, width=30.0), robot(), scene()).strokes) == 1


def test_a_line_that_touches_an_obstacle_is_followed_as_far_as_it_is_clear(robot, scene, task):
    work = road_work(road(task, photoDistance=10.0), robot(), scene((50.0, 0.0, 5.0, 90.0)))
    keep = 6.0 + robot().clearance
    one, two = work.strokes
    assert one.points == ((0.0, 0.0, 20.0), (pytest.approx(50.0 - keep, abs=0.02), 0.0, 20.0))
    assert two.points[0] == (pytest.approx(50.0 + keep, abs=0.02), 0.0, 20.0)
    assert two.points[1:] == ((100.0, 0.0, 20.0), (100.0, 80.0, 20.0))
    assert [each.actions[0].at for each in work.strokes] == [0.0, 0.0]
    for stroke in work.strokes:
        refuse_blocked(robot(), scene((50.0, 0.0, 5.0, 90.0)), stroke.points, "a part")


@pytest.mark.parametrize("inverted", [False, True])
def test_what_is_left_out_of_a_line_is_named_with_its_place_and_length(robot, scene, task, inverted):
    work = road_work(road(task, inverted=inverted), robot(), scene((30.0, 0.0, 5.0, 90.0)))
    (gap,) = work.gaps
    keep = 6.0 + robot().clearance
    assert gap.begin == pytest.approx(30.0 - keep, abs=0.02)
    assert gap.length == pytest.approx(2.0 * keep, abs=0.04)
    assert gap.at == (pytest.approx(30.0), 0.0, 20.0)
    assert (gap.line, gap.area) == ("the line", "'block 0'")
    assert work.strokes[0].points[0] == ((100.0, 80.0, 20.0) if inverted else (0.0, 0.0, 20.0))


def test_parts_too_short_to_go_around_an_obstacle_for_are_left_out(robot, scene, task):
    keep = 6.0 + robot().clearance
    work = road_work(road(task), robot(), scene((keep + 0.5, 0.0, 5.0, 90.0)))
    assert len(work.strokes) == 1
    assert work.gaps[0].begin == 0.0


def test_a_pass_of_which_nothing_is_left_is_left_out_as_a_whole(robot, scene, task):
    asked = road(task, points=((0.0, 0.0, 0.0), (20.0, 0.0, 0.0)), width=90.0, footprintWidth=45.0)
    work = road_work(asked, robot(), scene((10.0, 30.0, 15.0, 90.0)))
    assert len(work.strokes) == 1
    assert [(each.line, each.length) for each in work.gaps] == [("pass 2", pytest.approx(20.0))]


def test_a_line_of_which_nothing_is_left_is_refused_with_the_obstacles_name(robot, scene, task):
    with pytest.raises(InfeasibleError, match="nothing is left of the line: it is too near to 'block 0'"):
        road_work(road(task), robot(), scene((55.0, 40.0, 60.0, 90.0)))


WALLS = (
    (30.0, 0.0, 10.0, 150.0),
    (70.0, 0.0, 10.0, 150.0),
    (50.0, 20.0, 10.0, 150.0),
    (50.0, -20.0, 10.0, 150.0),
)


def test_a_part_of_a_line_that_areas_close_in_is_left_out_and_they_are_named(robot, scene, task):
    keep = 1.0 + robot().clearance
    asked = road(task, points=((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)))
    work = road_work(asked, robot(), scene(*WALLS))
    assert [stroke.points[0][0] for stroke in work.strokes] == pytest.approx([0.0, 80.0 + keep], abs=0.02)
    before, inside, behind = work.gaps
    assert (before.area, behind.area) == ("'block 0'", "'block 1'")
    assert (inside.begin, inside.length) == pytest.approx((40.0 + keep, 20.0 - 2.0 * keep), abs=0.02)
    assert (inside.area, inside.closed_in) == ("'block 0', 'block 1', 'block 2', 'block 3'", True)


def test_a_line_that_areas_close_in_as_a_whole_is_refused_with_their_names(robot, scene, task):
    asked = road(task, points=((48.0, 0.0, 0.0), (52.0, 0.0, 0.0)), initialPosition=(0.0, 0.0, 0.0))
    with pytest.raises(InfeasibleError, match=r"nothing is left of the line: 'block 0', .* close it in"):
        road_work(asked, robot(), scene(*WALLS))


@pytest.mark.parametrize("top", [60.0, 150.0])
def test_a_line_is_followed_whole_where_a_robot_can_get_over_the_areas_or_starts_between_them(
    robot, scene, task, top
):
    inside = replace(robot(), home=(50.0 if top > 100.0 else 0.0, 0.0, 0.0))
    asked = road(task, points=((48.0, 0.0, 0.0), (52.0, 0.0, 0.0)), initialPosition=(50.0, 0.0, 0.0))
    walls = [(east, north, half, top) for east, north, half, _ in WALLS]
    assert road_work(asked, inside, scene(*walls)).gaps == ()


def test_photos_without_a_device_are_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="has no device for action 'Whistle'"):
        road_work(road(task, photoDistance=50.0, actionName="Whistle"), robot(), scene())


@given(st.floats(0.0, 5000.0), st.floats(0.5, 500.0))
def test_even_distances_lie_on_the_line_from_end_to_end_and_never_too_far_apart(length, spacing):
    at = even_distances(length, spacing)
    assert at[0] == 0.0 or length <= 1e-6
    assert at[-1] == length
    assert all(0 < b - a <= spacing * (1 + 1e-6) for a, b in pairwise(at))


def test_a_line_without_actions_may_be_split_at_its_corners_and_every_fifty_metres():
    assert cuts_between(LINE, ()) == pytest.approx((50.0, 100.0, 100.0 + 80.0998 / 2), abs=0.01)


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(60.0, 200.0), st.integers(-1000, 1000).map(lambda turn: turn / 1000)),
        min_size=1,
        max_size=5,
    ),
    st.floats(10.0, 50.0),
    st.floats(5.0, 30.0),
)
def test_passes_cover_all_of_a_corridor(steps, width, strip):
    points, bearing = [(0.0, 0.0, 20.0)], 0.0
    for length, turn in steps:
        bearing += turn
        points.append((points[-1][0] + length * cos(bearing), points[-1][1] + length * sin(bearing), 20.0))
    middle = shapely.LineString([point[:2] for point in points])
    corridor = middle.buffer(width / 2, cap_style="flat")
    assume(middle.is_simple)
    lines = passes(points, width, strip)
    seen = shapely.union_all([shapely.LineString([p[:2] for p in line]).buffer(strip / 2) for line in lines])
    assert corridor.difference(seen).area <= 1e-3 * corridor.area


def test_a_pass_that_a_hairpin_leaves_no_room_for_is_left_out():
    points = [(0.0, 60.0, 20.0), (200.0, 60.0, 20.0), (205.0, 90.0, 20.0), (0.0, 95.0, 20.0)]
    corridor = shapely.LineString([point[:2] for point in points]).buffer(50.0, cap_style="flat")
    lines = passes(points, 100.0, 40.0)
    seen = shapely.union_all([shapely.LineString([p[:2] for p in line]).buffer(20.0) for line in lines])
    assert all(len(line) > 1 for line in lines)
    assert corridor.difference(seen).area <= 1e-3 * corridor.area


@pytest.mark.parametrize(
    ("features", "reason"),
    [
        ({"photoDistance": 1e-5}, "photos or samples, of which 200,000"),
        ({"width": 20.0, "footprintWidth": 1e-3}, "takes about 20,000 passes, of which 1,000"),
    ],
)
def test_more_than_can_be_planned_is_refused_at_once(robot, scene, task, features, reason):
    with pytest.raises(InfeasibleError, match=reason):
        road_work(road(task, **features), robot(), scene())


def test_photos_along_a_line_are_taken_in_passing_by_a_camera_that_can(snapper, scene, task):
    given = {"photoDistance": 50.0, "capture": "AUTOMATIC", "triggerAction": "TriggerByDistance", "blur": 0.5}
    (stroke,) = road_work(road(task, **given), snapper(), scene()).strokes
    assert stroke.spots == (0.0, 45.0, 90.0, 135.0, 180.0)
    assert stroke.cuts == (45.0, 90.0, 135.0)
    assert (stroke.actions, stroke.repetition.device, stroke.speed) == ((), "camera", 45.0)
