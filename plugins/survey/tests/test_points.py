from math import dist, inf

import pytest
from mmrs_survey.points import approach_moves, approach_work, go_to_work, observe_work, relay_work

from mmrs_core.errors import InfeasibleError

POINT = (50.0, 30.0, 20.0)


@pytest.mark.parametrize(
    ("how", "slow_down", "speed"), [("NORMAL", None, None), ("SLOW", 0.5, None), ("QUICK", None, inf)]
)
def test_a_go_to_task_leads_to_its_point_at_its_speed(robot, scene, task, how, slow_down, speed):
    (stroke,) = go_to_work(task("GoToTask", point=POINT, type=how), robot(), scene()).strokes
    assert (stroke.points, stroke.slow_down, stroke.speed) == ((POINT,), slow_down, speed)


def test_a_point_above_the_ceiling_is_refused_with_what_is_short(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"120\.00 m is 20\.00 m above the ceiling 100\.00 m"):
        go_to_work(task("GoToTask", point=(0.0, 0.0, 120.0)), robot(), scene())


def test_a_point_below_the_floor_is_refused_with_what_is_short(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"0\.00 m is 1\.00 m below the floor 1\.00 m"):
        go_to_work(task("GoToTask", point=(0.0, 0.0, 0.0)), robot(), scene())


def test_a_point_too_near_to_an_obstacle_is_refused_with_its_name(robot, scene, task):
    place = scene((50.0, 20.0, 9.0, 90.0))
    with pytest.raises(InfeasibleError, match=r"the point comes 0\.50 m too near to 'block 0'"):
        go_to_work(task("GoToTask", point=POINT), robot(), place)


def test_a_point_over_an_obstacle_is_fine(robot, scene, task):
    assert go_to_work(task("GoToTask", point=POINT), robot(), scene((50.0, 30.0, 9.0, 18.0))).strokes


def observe(task, **more):
    return task("ObserveTask", **{"point": POINT, "duration": 60.0, **more})


def test_observing_holds_at_its_distance_and_altitude_and_looks_at_the_point(robot, scene, task):
    asked = observe(task, distance=10.0, altitude=25.0, deviceId="camera")
    (stroke,) = observe_work(asked, robot(), scene()).strokes
    (place,) = stroke.points
    assert place[2] == 25.0
    assert dist(place[:2], POINT[:2]) == pytest.approx(10.0)
    assert (stroke.hold, stroke.look.at, stroke.look.device) == (60.0, POINT, "camera")


def test_observing_is_done_from_the_side_of_the_homes(robot, scene, task):
    asked = observe(task, point=(100.0, 0.0, 20.0), distance=10.0)
    assert observe_work(asked, robot(), scene()).strokes[0].points[0] == pytest.approx((90.0, 0.0, 20.0))


def test_observing_takes_another_side_where_one_is_blocked(robot, scene, task):
    asked = observe(task, point=(100.0, 0.0, 20.0), distance=10.0)
    place = scene((90.0, 0.0, 2.0, 90.0))
    east, north, _ = observe_work(asked, robot(), place).strokes[0].points[0]
    assert max(abs(east - 90.0), abs(north)) >= 2.0 + 1.5


def test_observing_is_refused_where_every_side_is_blocked(robot, scene, task):
    with pytest.raises(InfeasibleError, match="no clear place"):
        observe_work(observe(task, distance=10.0), robot(), scene((50.0, 30.0, 30.0, 90.0)))


def test_the_action_of_an_observation_comes_before_the_hold(robot, scene, task):
    asked = observe(task, distance=10.0, deviceId="camera", actionName="TakePicture")
    first, second = observe_work(asked, robot(), scene()).strokes
    assert [(each.action, each.device) for each in first.actions] == [("TakePicture", "camera")]
    assert (first.hold, second.hold, second.actions) == (0.0, 60.0, ())


def test_observing_from_the_point_itself_looks_nowhere(robot, scene, task):
    (stroke,) = observe_work(observe(task), robot(), scene()).strokes
    assert (stroke.points, stroke.look) == ((POINT,), None)


def test_a_robot_that_cannot_stand_still_does_not_observe(robot, scene, task):
    with pytest.raises(InfeasibleError, match="smallest speed is 3 m/s"):
        observe_work(observe(task), robot(slowest=3.0), scene())


def test_observing_with_a_device_that_is_not_carried_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="has no device 'telescope'"):
        observe_work(observe(task, distance=5.0, deviceId="telescope"), robot(), scene())


def approach(task, **more):
    return task(
        "ApproachTask", **{"point": POINT, "object": "buoy", "distance": 2.0, "tolerance": 3.0, **more}
    )


def test_an_approach_begins_outside_of_where_the_object_may_be(robot, scene, task):
    there, back = approach_work(approach(task), robot(), scene()).strokes
    assert dist(there.points[0], POINT) == pytest.approx(2.0 + 3.0 + 0.5)
    assert dist(there.points[1], POINT) == pytest.approx(2.0)
    assert back.points == there.points[:1]


def test_an_approach_is_one_move_to_the_object_then_its_action(robot, scene, task):
    asked = approach(task, deviceId="camera", actionName="TakePicture")
    there, back = approach_work(asked, robot(), scene()).strokes
    (spec,) = approach_moves(there, asked, robot(), scene())
    assert (spec.object, spec.target, spec.distance, spec.object_tolerance) == ("buoy", POINT, 2.0, 3.0)
    assert (spec.look.at, spec.look.device) == (POINT, "camera")
    assert [(each.action, each.device) for each in spec.after] == [("TakePicture", "camera")]
    assert [each.metaclass[1] for each in approach_moves(back, asked, robot(), scene())] == ["HoldPosition"]


def test_an_object_that_may_be_anywhere_stays_unknown(robot, scene, task):
    there, _ = approach_work(approach(task, tolerance=None), robot(), scene()).strokes
    (spec,) = approach_moves(there, approach(task), robot(), scene())
    assert spec.object_tolerance is None
    assert spec.look is None


def test_a_relay_stays_at_its_point(robot, scene, task):
    work = relay_work(task("RelayTask", point=POINT), robot(), scene())
    assert (work.relays, work.divisible, work.strokes[0].points) == (True, False, (POINT,))


def test_a_relay_too_near_to_an_obstacle_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"the point comes 0\.50 m too near to 'block 0'"):
        relay_work(task("RelayTask", point=POINT), robot(), scene((50.0, 20.0, 9.0, 90.0)))
