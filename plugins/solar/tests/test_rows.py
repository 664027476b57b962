from itertools import pairwise
from math import ceil, cos, dist, radians, sin

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from mmrs_solar.names import THERMAL_ROW_TASK
from mmrs_solar.row_inspection import passes_over, row_inspection_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.positions import refuse_blocked
from mmrs_core.testing.scenes import sample_task, square

TILT = radians(30.0)
RECORDED = (("minimumIrradiance", "600"),)


def rows(**more):
    given = {
        "group": "south",
        "minimumIrradiance": 600.0,
        "pixelSize": 0.03,
        "firstRow": 1,
        "frontOverlap": 0.8,
        "sideOverlap": 0.6,
        "blur": 0.5,
        "speed": 2.0,
        "startAction": "StartCapture",
        "stopAction": "StopCapture",
    }
    return sample_task(THERMAL_ROW_TASK, **{**given, **more})


def test_a_row_that_is_seen_at_once_takes_one_stroke(robot, scene):
    work = row_inspection_work(rows(), robot(), scene())
    assert len(work.strokes) == 4
    assert (work.divisible, work.ordered) == (True, False)


def test_the_camera_is_as_far_away_as_it_resolves_the_pixels(robot, scene):
    first = row_inspection_work(rows(), robot(), scene()).strokes[0]
    middle = (0.0, 0.0, 1.5)
    assert dist(first.points[1], middle) == pytest.approx(30.0)
    assert first.points[1] == pytest.approx((0.0, -30.0 * sin(TILT), 1.5 + 30.0 * cos(TILT)))


def test_a_distance_goes_before_the_size_of_pixels(robot, scene):
    stroke = row_inspection_work(rows(distance=12.0), robot(), scene()).strokes[0]
    assert stroke.points[1][2] == pytest.approx(1.5 + 12.0 * cos(TILT))


def test_a_camera_that_is_too_coarse_is_refused_with_how_near_it_must_go(robot, scene):
    with pytest.raises(InfeasibleError, match=r"pixels of 0\.04 m from 40 m, .* go as near as 30\.0 m"):
        row_inspection_work(rows(distance=40.0), robot(), scene())


def test_pixels_are_larger_on_panels_that_are_seen_off_their_normal(robot, scene):
    down = robot(gimbal_pitch_max="-90")
    stroke = row_inspection_work(rows(), down, scene()).strokes[0]
    assert stroke.points[1] == pytest.approx((0.0, 0.0, 1.5 + 30.0 * cos(TILT)))


def test_rows_are_followed_to_and_fro(robot, scene):
    ways = [
        stroke.points[2][0] - stroke.points[1][0]
        for stroke in row_inspection_work(rows(), robot(), scene()).strokes
    ]
    assert ways == pytest.approx([100.0, -100.0, 100.0, -100.0])


def test_the_camera_records_from_one_end_of_a_row_to_the_other(robot, scene):
    strokes = row_inspection_work(rows(), robot(), scene()).strokes
    assert len(strokes) == 4
    for stroke in strokes:
        lead_in, begin, end = stroke.points
        start, stop = stroke.actions
        assert (start.action, start.device, start.parameters) == ("StartCapture", "thermal", RECORDED)
        assert (stop.action, stop.device, stop.parameters) == ("StopCapture", "thermal", RECORDED)
        assert start.at == pytest.approx(dist(lead_in, begin))
        assert stop.at == pytest.approx(dist(lead_in, begin) + dist(begin, end))


def test_the_robot_can_turn_round_before_it_records(robot, scene):
    stroke = row_inspection_work(rows(), robot(), scene()).strokes[0]
    seconds = dist(*stroke.points[:2]) / stroke.speed
    assert seconds >= 180.0 / robot().kinematics.turn_rate - 1e-9


def test_all_passes_look_the_same_way(robot, scene):
    strokes = row_inspection_work(rows(), robot(), scene()).strokes
    assert len(strokes) == 4
    for stroke in strokes:
        assert stroke.look.device == "thermal"
        for point in stroke.points[1:]:
            east, north, up = (a - b for a, b in zip(stroke.look.at, point, strict=True))
            assert north > 0 > up
            assert abs(east) <= 0.02 * dist(stroke.look.at, point)


@pytest.mark.parametrize(
    ("more", "speed"),
    [
        ({}, 1.5),
        ({"blur": 0.2}, 0.6),
        ({"speed": 1.0}, 1.0),
        ({"frontOverlap": 0.98}, 24.0 * 0.02 / 0.5),
        ({"distance": 15.0}, 0.75),
    ],
)
def test_the_speed_is_limited_by_exposure_overlap_and_the_task(robot, scene, more, speed):
    stroke = row_inspection_work(rows(**more), robot(), scene()).strokes[0]
    assert stroke.speed == pytest.approx(speed)


def test_a_robot_that_cannot_go_so_slowly_is_refused(robot, scene):
    with pytest.raises(InfeasibleError, match=r"up to 1\.50 m/s, the robot's smallest speed is 3\.00 m/s"):
        row_inspection_work(rows(), robot(slowest=3.0), scene())


def test_only_the_rows_that_are_asked_for_are_followed(robot, scene):
    strokes = row_inspection_work(rows(firstRow=2, lastRow=3), robot(), scene()).strokes
    north = [stroke.points[1][1] + 30.0 * sin(TILT) for stroke in strokes]
    assert north == pytest.approx([8.0, 16.0])


@pytest.mark.parametrize(("first", "last"), [(0, 2), (3, 2), (1, 5)])
def test_rows_that_are_not_there_are_refused(robot, scene, first, last):
    with pytest.raises(InfeasibleError, match="the group has 4"):
        row_inspection_work(rows(firstRow=first, lastRow=last), robot(), scene())


def test_a_row_wider_than_an_image_takes_passes_uphill(robot, scene, group):
    wide = group(rowWidth=30.0, rows=1)
    strokes = row_inspection_work(rows(), robot(), scene(groups=(wide,))).strokes
    ups = [stroke.points[1][2] for stroke in strokes]
    assert len(strokes) == 3
    assert ups == sorted(ups)


def test_long_rows_are_recorded_in_parts_that_meet(robot, scene, group):
    long = group(points=((0.0, 0.0, 0.0), (400.0, 0.0, 0.0)), rows=1)
    strokes = row_inspection_work(rows(), robot(), scene(groups=(long,))).strokes
    spans = sorted(sorted((s.points[1][0], s.points[2][0])) for s in strokes)
    assert len(strokes) == 3
    assert [spans[0][0], spans[-1][1]] == pytest.approx([0.0, 400.0])
    assert all(one[1] == pytest.approx(two[0]) for one, two in pairwise(spans))


def test_a_row_that_touches_an_obstacle_is_recorded_as_far_as_it_is_clear(robot, scene):
    whole = row_inspection_work(rows(firstRow=3), robot(), scene())
    mast = scene(square("mast", 50.0, 1.0, 2.0))
    work = row_inspection_work(rows(firstRow=3), robot(), mast)
    assert len(work.strokes) > len(whole.strokes)
    for stroke in work.strokes:
        refuse_blocked(robot(), mast, stroke.points, "a part")
        assert dist(*stroke.points[:2]) == pytest.approx(stroke.actions[0].at)
    assert all(gap.area == "'mast'" for gap in work.gaps)
    assert "the way along row 3" in {gap.line for gap in work.gaps}
    done = sum(dist(stroke.points[0], stroke.points[-1]) for stroke in work.strokes)
    asked = sum(dist(stroke.points[0], stroke.points[-1]) for stroke in whole.strokes)
    assert done + sum(gap.length for gap in work.gaps) == pytest.approx(asked)


def test_rows_of_which_nothing_is_left_are_refused_with_the_obstacle(robot, scene):
    hall = square("hall", 50.0, 1.0, 200.0)
    with pytest.raises(InfeasibleError, match=r"nothing is left of the way along row 3: .* 'hall'"):
        row_inspection_work(rows(firstRow=3), robot(), scene(hall))


def test_a_way_above_the_ceiling_is_refused(robot, scene):
    with pytest.raises(InfeasibleError, match="above the ceiling"):
        row_inspection_work(rows(pixelSize=0.2), robot(), scene())


@pytest.mark.parametrize("key", ["exposure_time", "capture_interval", "focal_length", "image_width"])
def test_a_camera_that_does_not_say_what_the_speed_follows_from_is_refused(robot, scene, key):
    with pytest.raises(InfeasibleError, match=f"does not state {key.replace('_', '.')}"):
        row_inspection_work(rows(), robot(**{key: None}), scene())


def test_a_camera_that_does_not_record_the_irradiance_is_refused(robot, scene):
    with pytest.raises(InfeasibleError, match="takes no parameter 'minimumIrradiance'"):
        row_inspection_work(rows(), robot(parameter="zoom"), scene())


@pytest.mark.parametrize("action", ["startAction", "stopAction"])
def test_a_camera_that_cannot_record_is_refused(robot, scene, action):
    with pytest.raises(InfeasibleError, match="'Film'"):
        row_inspection_work(rows(**{action: "Film"}), robot(), scene())


def test_panels_are_not_touched(robot, scene, group):
    near, high = rows(distance=0.4), group(height=5.0)
    with pytest.raises(InfeasibleError, match=r"along row 1 comes .* too near to the panels of row 1"):
        row_inspection_work(near, robot(), scene(groups=(high,)))


@example(0.5000000000000001, 0.5, 0.0)
@given(st.floats(0.5, 60.0), st.floats(0.5, 30.0), st.floats(0.0, 0.95))
def test_passes_see_all_of_a_row_and_overlap_by_what_is_asked(width, strip, overlap):
    offsets = passes_over(width, strip, overlap)
    if strip >= width:
        assert offsets == (0.0,)
        return
    assert offsets[0] - strip / 2 == pytest.approx(-width / 2, abs=1e-6)
    assert offsets[-1] + strip / 2 == pytest.approx(width / 2, abs=1e-6)
    assert all(b - a <= strip * (1.0 - overlap) * (1 + 1e-6) for a, b in pairwise(offsets))
    assert len(offsets) <= 1 + ceil((width - strip) / (strip * (1.0 - overlap)))


@pytest.mark.parametrize(
    ("of_group", "of_task", "reason"),
    [
        ({"rows": 2_000_000_000}, {}, "takes 2,000,000,000 ways along rows, of which 20,000 .* by firstRow"),
        ({"rowWidth": 1e6}, {}, "a row takes about .* passes, of which 1,000"),
        ({"rowWidth": 1e300}, {"sideOverlap": 0.999}, "a row takes about .* passes, of which 1,000"),
    ],
)
def test_more_than_can_be_planned_is_refused_at_once(robot, scene, group, of_group, of_task, reason):
    with pytest.raises(InfeasibleError, match=reason):
        row_inspection_work(rows(**of_task), robot(), scene(groups=(group(**of_group),)))
