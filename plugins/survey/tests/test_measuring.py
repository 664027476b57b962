import pytest
from mmrs_survey.measuring import measure_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part

POINTS = ((0.0, 0.0, 20.0), (30.0, 0.0, 20.0), (30.0, 40.0, 25.0))
SECONDS = Part((), {"key": "seconds", "value": "5"})


def measure(task, **more):
    return task("MeasureTask", **{"actionName": "Sample", "points": POINTS, **more})


def test_points_without_a_spacing_are_measured_one_by_one(robot, scene, task):
    work = measure_work(measure(task), robot(), scene())
    assert [stroke.points for stroke in work.strokes] == [(point,) for point in POINTS]
    assert {(action.action, action.device) for stroke in work.strokes for action in stroke.actions} == {
        ("Sample", "probe")
    }


def test_single_points_may_be_shared_and_come_in_any_order(robot, scene, task):
    work = measure_work(measure(task), robot(), scene())
    assert (work.divisible, work.ordered) == (True, False)


def test_a_spacing_measures_along_the_line(robot, scene, task):
    (stroke,) = measure_work(measure(task, spacing=20.0, altitude=20.0), robot(), scene()).strokes
    assert [action.at for action in stroke.actions] == [0.0, 20.0, 40.0, 60.0, 70.0]


def test_parameters_go_with_every_measurement(robot, scene, task):
    work = measure_work(measure(task, parameters=(SECONDS,)), robot(), scene())
    assert {action.parameters for stroke in work.strokes for action in stroke.actions} == {
        (("seconds", "5"),)
    }


def test_a_depth_counts_down_from_the_surface(robot, scene, task):
    work = measure_work(measure(task, depth=4.0), robot(), scene(surface=30.0))
    assert {stroke.points[0][2] for stroke in work.strokes} == {26.0}


def test_an_altitude_and_a_depth_together_are_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="both an altitude and a depth"):
        measure_work(measure(task, depth=4.0, altitude=5.0), robot(), scene())


def test_a_task_that_does_not_say_where_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="neither points nor a shell"):
        measure_work(measure(task, points=()), robot(), scene())


def test_a_shell_is_measured_on_a_grid_no_wider_than_its_spacing(robot, scene, task):
    shell = ((0.0, 0.0, 0.0), (50.0, 0.0, 0.0), (50.0, 30.0, 0.0), (0.0, 30.0, 0.0))
    work = measure_work(measure(task, points=(), shell=shell, spacing=10.0, altitude=20.0), robot(), scene())
    assert sum(len(stroke.actions) for stroke in work.strokes) == 15
    assert (work.coverage.width, work.coverage.length) == (10.0, 10.0)


def test_a_shell_whose_points_differ_in_height_needs_an_altitude(robot, scene, task):
    shell = ((0.0, 0.0, 10.0), (50.0, 0.0, 10.0), (50.0, 30.0, 20.0))
    with pytest.raises(InfeasibleError, match="differ in height"):
        measure_work(measure(task, points=(), shell=shell, spacing=10.0), robot(), scene())


def test_a_blocked_point_is_refused_with_its_number(robot, scene, task):
    with pytest.raises(InfeasibleError, match="point 2 comes"):
        measure_work(measure(task), robot(), scene((30.0, 0.0, 3.0, 90.0)))


def test_several_devices_for_the_action_are_refused_with_their_names(robot, scene, task):
    from mmrs_core.scene import Device, DeviceAction

    twin = Device("twin", {"Sample": DeviceAction("Sample", 2.0)}, {})
    with pytest.raises(InfeasibleError, match="'probe' and 'twin' both support action 'Sample'"):
        measure_work(measure(task), robot({"twin": twin}), scene())


@pytest.mark.parametrize(
    ("device", "message"), [("gone", "has no device 'gone'"), ("camera", "does not support")]
)
def test_a_named_device_that_cannot_do_it_is_refused(robot, scene, task, device, message):
    with pytest.raises(InfeasibleError, match=message):
        measure_work(measure(task, deviceId=device), robot(), scene())
