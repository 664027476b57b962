"""Where a vehicle may go through a place without a stop."""

from dataclasses import replace

import pytest

from mmrs_mavlink import GoTo, Hold, Local, Notify, Object, Operate, Step, Then
from mmrs_mavlink.vehicles.corners import goes_through, turn

HERE = Local(0.0, 0.0, 10.0)
FAR = Local(100.0, 0.0, 10.0)


def step(at=FAR, *, fluid: bool = True, **more) -> Step:
    return Step("a", GoTo(at, 5.0, **more), then=Then("b", fluid=fluid))


def next_to(north: float, east: float, up: float = 10.0, **more) -> Step:
    return Step("b", GoTo(Local(north, east, up), 5.0, **more))


@pytest.mark.parametrize(
    ("east", "through"), [(0.0, True), (17.0, True), (17.72, True), (18.0, False), (-100.0, False)]
)
def test_up_to_ten_degrees_the_way_goes_straight_on(east, through):
    assert goes_through(step(), next_to(200.0, east), HERE) is through


def test_going_back_is_no_going_straight_on():
    assert not goes_through(step(), next_to(0.0, 0.0), HERE)


def test_a_climb_is_a_corner_too():
    assert not goes_through(step(), next_to(110.0, 0.0, 30.0), HERE)


def test_a_transition_that_is_not_fluid_is_a_stop():
    assert not goes_through(step(fluid=False), next_to(200.0, 0.0), HERE)


def test_an_action_at_the_end_of_a_move_is_a_stop():
    photo = Operate("camera", "takePhoto", 2000, (0.0, 0.0, 1.0), 1.0)
    assert not goes_through(replace(step(), after=(photo,)), next_to(200.0, 0.0), HERE)
    assert not goes_through(step(), replace(next_to(200.0, 0.0), before=(photo,)), HERE)


def test_robots_are_notified_on_the_way():
    notify = Notify((("beta", "go"),))
    assert goes_through(replace(step(), after=(notify,)), next_to(200.0, 0.0), HERE)


def test_legs_that_begin_upwards_begin_with_a_corner():
    assert not goes_through(step(), next_to(200.0, 0.0, 30.0, legs="climb first"), HERE)
    assert goes_through(step(), next_to(200.0, 0.0, 30.0, legs="level first"), HERE)


def test_only_from_place_to_place_is_gone_through():
    assert not goes_through(step(), Step("b", Hold(3.0)), HERE)
    assert not goes_through(step(), None, HERE)
    assert not goes_through(step(Object("a mast")), next_to(200.0, 0.0), HERE)


def test_a_leg_of_no_length_is_a_stop():
    assert not goes_through(step(HERE), next_to(200.0, 0.0), HERE)


def test_turns_are_measured_in_space():
    assert turn(HERE, FAR, Local(100.0, 50.0, 10.0)) == pytest.approx(90.0)
    assert turn(HERE, FAR, Local(200.0, 0.0, 10.0)) == pytest.approx(0.0, abs=1e-5)
    assert turn(HERE, FAR, Local(200.0, 0.0, 110.0)) == pytest.approx(45.0)
