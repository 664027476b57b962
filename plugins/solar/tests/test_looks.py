from math import cos, dist, radians, sin

import pytest
from mmrs_solar.names import PANEL_LOOK_TASK, SOLAR
from mmrs_solar.panel_looks import panel_look_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part
from mmrs_core.testing.scenes import sample_task, square


def panel(row, column, tier=1):
    return Part(((SOLAR, "SuspectedPanel"),), {"row": row, "column": column, "tier": tier})


def look(*panels, **more):
    given = {
        "group": "south",
        "minimumIrradiance": 600.0,
        "pixelSize": 0.01,
        "actionName": "TakePicture",
        "panels": panels or (panel(2, 10), panel(4, 50, 2)),
    }
    return sample_task(PANEL_LOOK_TASK, **{**given, **more})


def test_each_panel_is_looked_at_from_a_place_of_its_own(robot, scene):
    work = panel_look_work(look(), robot(), scene())
    assert [len(stroke.points) for stroke in work.strokes] == [1, 1]
    assert (work.divisible, work.ordered) == (True, False)


def test_the_camera_stands_on_the_normal_of_the_panel_and_looks_at_its_middle(robot, scene):
    (stroke,) = panel_look_work(look(panel(2, 10)), robot(), scene()).strokes
    (place,), middle = stroke.points, stroke.look.at
    assert dist(place, middle) == pytest.approx(10.0)
    slope = radians(30.0)
    assert place[1] - middle[1] == pytest.approx(-10.0 * sin(slope))
    assert place[2] - middle[2] == pytest.approx(10.0 * cos(slope))
    assert stroke.look.device == "thermal"


def test_an_image_is_taken_that_records_the_irradiance(robot, scene):
    (stroke,) = panel_look_work(look(panel(1, 1)), robot(), scene()).strokes
    (action,) = stroke.actions
    assert (action.action, action.parameters) == ("TakePicture", (("minimumIrradiance", "600"),))


def test_a_panel_that_is_listed_twice_is_looked_at_once(robot, scene):
    work = panel_look_work(look(panel(1, 1), panel(1, 1)), robot(), scene())
    assert len(work.strokes) == 1


def test_a_panel_that_is_not_there_is_refused(robot, scene):
    with pytest.raises(InfeasibleError, match="row 9, column 1, tier 1 is not a panel"):
        panel_look_work(look(panel(9, 1)), robot(), scene())


def test_no_panels_are_refused(robot, scene):
    with pytest.raises(InfeasibleError, match="panels are missing"):
        panel_look_work(look(panels=()), robot(), scene())


def test_a_robot_that_cannot_stand_still_is_refused(robot, scene):
    with pytest.raises(InfeasibleError, match="smallest speed is 3 m/s"):
        panel_look_work(look(), robot(slowest=3.0), scene())


def test_a_place_too_near_to_an_obstacle_is_refused_with_the_panel(robot, scene):
    with pytest.raises(InfeasibleError, match="the position before row 1, column 1, tier 1 comes"):
        panel_look_work(look(panel(1, 1)), robot(), scene(square("shed", 1.0, -6.0, 1.0)))


def test_a_camera_that_takes_single_images_needs_no_interval(robot, scene):
    camera = robot(exposure_time=None, capture_interval=None)
    assert panel_look_work(look(), camera, scene()).strokes
