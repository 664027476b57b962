from __future__ import annotations

from itertools import pairwise
from math import cos, sin

import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from mmrs_survey.lines import cuts_between, even_distances, passes
from mmrs_survey.roads import road_work

from mmrs_core.errors import InfeasibleError

LINE = ((0.0, 0.0, 5.0), (100.0, 0.0, 5.0), (100.0, 80.0, 9.0))


def road(task, **more):
    given = {
        "points": LINE,
        "initialPosition": (-10.0, 0.0, 0.0),
        "altitude": 20.0,
        "actionName": "TakePicture",
    }
    return task("RoadTask", **{**given, **more})


def test_a_line_without_width_is_followed_once_at_its_altitude(robot, scene, task):
    (stroke,) = road_work(road(task), robot(), scene()).strokes
    assert stroke.points == ((0.0, 0.0, 20.0), (100.0, 0.0, 20.0), (100.0, 80.0, 20.0))


def test_a_line_without_altitude_keeps_the_heights_of_its_points(robot, scene, task):
    asked = road(task, altitude=None, initialPosition=(-10.0, 0.0, 5.0))
    assert road_work(asked, robot(), scene()).strokes[0].points == LINE


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


def test_a_corridor_that_is_seen_at_once_takes_one_pass(robot, scene, task):
    assert len(road_work(road(task, width=30.0), robot(), scene()).strokes) == 1


def test_a_line_too_near_to_an_obstacle_is_refused_with_its_name(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"the line comes 1\.50 m too near to 'block 0'"):
        road_work(road(task), robot(), scene((50.0, 0.0, 5.0, 90.0)))


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
