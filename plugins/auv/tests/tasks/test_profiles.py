from dataclasses import replace
from itertools import pairwise
from math import atan2, degrees, dist, hypot, radians, tan

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mmrs_auv.tasks.profiles import yo_yo_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked

BENT = ((10.0, 0.0, 0.0), (60.0, 0.0, 0.0), (60.0, 37.0, 0.0))
RELAXED = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def yo_yo(task, **more):
    given_ = {"initialPosition": (5.0, 0.0, 0.0), "points": BENT, "minDepth": 2.0, "maxDepth": 8.0}
    return task("YoYoTask", **{**given_, "pitch": 20.0, **more})


def test_it_begins_and_ends_up_and_turns_at_the_depths_asked_for(robot, scene, task):
    (stroke,) = yo_yo_work(yo_yo(task), robot(), scene()).strokes
    ups = [up for _, _, up in stroke.points]
    assert ups[0] == ups[-1] == -5.0
    assert (max(ups), min(ups)) == (-5.0, pytest.approx(-11.0))
    assert stroke.points[0][:2] == BENT[0][:2]
    assert stroke.points[-1][:2] == pytest.approx(BENT[-1][:2])


@RELAXED
@given(st.floats(0.0, 10.0), st.floats(0.5, 20.0), st.floats(5.0, 60.0))
def test_no_way_is_steeper_than_asked_for_and_the_line_is_followed(robot, scene, task, upper, more, pitch):
    asked = yo_yo(task, minDepth=upper, maxDepth=upper + more, pitch=pitch)
    if 2.0 * more / tan(radians(pitch)) > 87.0:
        with pytest.raises(InfeasibleError, match="too short"):
            yo_yo_work(asked, robot(), scene())
        return
    work = yo_yo_work(asked, robot(), scene())
    points = work.strokes[0].points
    for a, b in pairwise(points):
        level = hypot(b[0] - a[0], b[1] - a[1])
        assert degrees(atan2(abs(b[2] - a[2]), level)) <= pitch + 1e-6
    assert sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)) == pytest.approx(87.0)
    assert (60.0, 0.0) in [tuple(round(each, 6) for each in point[:2]) for point in points]


def test_it_may_be_split_where_it_is_up(robot, scene, task):
    (stroke,) = yo_yo_work(yo_yo(task, pitch=45.0), robot(), scene()).strokes
    travelled, heights = 0.0, {}
    for a, b in pairwise(stroke.points):
        travelled += dist(a, b)
        heights[round(travelled, 6)] = b[2]
    assert len(stroke.cuts) == 6
    assert [heights[round(cut, 6)] for cut in stroke.cuts] == pytest.approx([-5.0] * 6)


def test_a_line_that_is_too_short_is_refused_with_what_it_takes(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"line of 87\.0 m is too short to go down and up, 137\.2 m"):
        yo_yo_work(yo_yo(task, pitch=5.0), robot(), scene())


def test_depths_that_are_exchanged_are_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="no profile from 8 to 2 m of depth"):
        yo_yo_work(yo_yo(task, minDepth=8.0, maxDepth=2.0), robot(), scene())


def test_turning_points_below_what_the_vehicle_bears_are_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="below the floor"):
        yo_yo_work(yo_yo(task, minDepth=45.0, maxDepth=51.0), robot(), scene())


def test_a_line_that_touches_an_obstacle_is_followed_on_both_sides_of_it(robot, scene, task):
    place = scene((30.0, 0.0, 1.0))
    work = yo_yo_work(yo_yo(task, pitch=60.0), robot(), place)
    (gap,) = work.gaps
    one, two = work.strokes
    assert one.points[0][:2] == BENT[0][:2]
    assert one.points[-1][0] == pytest.approx(10.0 + gap.begin)
    assert two.points[0][0] == pytest.approx(10.0 + gap.begin + gap.length)
    assert two.points[-1][:2] == pytest.approx(BENT[-1][:2])
    assert gap.at == (pytest.approx(30.0), 0.0, -5.0)
    assert [one.stretch, two.stretch] == [(0.0, gap.begin), (gap.begin + gap.length, 87.0)]
    for stroke in work.strokes:
        assert stroke.points[0][2] == stroke.points[-1][2] == -5.0
        refuse_blocked(robot(), place, stroke.points, "a part")


def test_a_part_too_short_to_go_down_and_up_is_left_out(robot, scene, task):
    work = yo_yo_work(yo_yo(task, pitch=30.0), robot(), scene((30.0, 0.0, 1.0)))
    (gap,) = work.gaps
    assert gap.begin == 0.0
    assert len(work.strokes) == 1


def test_waves_that_pass_over_an_obstacle_are_not_interrupted(robot, scene, task):
    place = scene((30.0, 0.0, 0.1))
    deep = replace(place, areas=tuple(replace(each, high=-12.0) for each in place.areas))
    asked = yo_yo(task, pitch=45.0)
    assert yo_yo_work(asked, robot(), deep).gaps == ()
    assert yo_yo_work(asked, robot(), place).gaps
