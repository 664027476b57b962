from itertools import pairwise
from math import dist, hypot

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from mmrs_auv.tasks.surveys import survey_work, swath_at

from mmrs_core.errors import InfeasibleError

SHELL = ((10.0, 10.0, 0.0), (60.0, 10.0, 0.0), (60.0, 40.0, 0.0), (35.0, 30.0, 0.0), (10.0, 40.0, 0.0))


def survey(task, **more):
    given_ = {"initialPosition": (5.0, 5.0, 0.0), "shell": SHELL, "depth": 6.0, "overlap": 0.0}
    return task("DepthHoldSurveyTask", **{**given_, **more})


@pytest.mark.parametrize("obstacles", [(), ((35.0, 15.0, 3.0),)])
def test_swaths_cover_all_of_the_area_that_can_be_covered(robot, scene, task, obstacles):
    work = survey_work(survey(task, overlap=0.25), robot(), scene(*obstacles))
    target = shapely.union_all([shapely.Polygon(*piece) for piece in work.coverage.target])
    lines = [shapely.LineString([point[:2] for point in stroke.points]) for stroke in work.strokes]
    seen = shapely.union_all([line.buffer(8.0 / 2, cap_style="square") for line in lines])
    assert work.coverage.width == 8.0 * 0.75
    assert seen.intersection(target).area >= 0.999 * target.area


def test_lines_are_followed_at_the_depth_below_the_surface(robot, scene, task):
    work = survey_work(survey(task), robot(), scene())
    assert {point[2] for stroke in work.strokes for point in stroke.points} == {-9.0}
    assert work.entry == (5.0, 5.0, -9.0)


def test_a_swath_of_the_task_goes_before_that_of_the_device(robot, scene, task):
    assert survey_work(survey(task, swath=5.0), robot(), scene()).coverage.width == 5.0


def test_what_records_is_begun_and_ended_on_every_line(robot, scene, task):
    asked = survey(task, startAction="Record", stopAction="Record", deviceId="sonar", speed=0.5)
    for stroke in survey_work(asked, robot(), scene()).strokes:
        length = sum(dist(a, b) for a, b in pairwise(stroke.points))
        assert [each.at for each in stroke.actions] == [0.0, pytest.approx(length)]
        assert (stroke.cuts, stroke.reversible, stroke.speed) == ((), False, 0.5)


def test_a_survey_by_a_sonar_of_which_nothing_is_known_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="'sonar' does not define the width of the strip"):
        survey_work(survey(task, deviceId="sonar"), robot(sonar="wide"), scene())
    with pytest.raises(InfeasibleError, match="no device whose properties describe a sonar"):
        survey_work(survey(task), robot({}), scene())


def test_an_area_deeper_than_the_vehicle_bears_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"-53\.50 m is 0\.50 m below the floor"):
        survey_work(survey(task, depth=50.5), robot(), scene())


@given(st.floats(1.0, 170.0), st.floats(0.1, 100.0), st.floats(0.1, 100.0))
def test_a_sonar_sees_no_further_than_its_range_and_its_aperture(aperture, reach, height):
    swath = swath_at({"sonar.aperture": str(aperture), "sonar.range": str(reach)}, height)
    if reach <= height:
        assert swath is None
    else:
        assert hypot(swath / 2.0, height) <= reach * (1 + 1e-6)
        assert swath <= swath_at({"sonar.aperture": str(aperture)}, height)


@pytest.mark.parametrize("height", [None, 0.0, -1.0])
def test_without_a_height_above_the_bottom_only_a_fixed_swath_is_known(height):
    assert swath_at({"sonar.aperture": "90"}, height) is None
    assert swath_at({"sonar.swath": "7.5"}, height) == 7.5
