"""Steering by sticks against a vehicle that answers them at once, in water that may move."""

from math import cos, hypot, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_mavlink.plugin.manual.autopilot import manual_control
from mmrs_mavlink.plugin.manual.steering import Goal, Sticks, StickSteering

pytestmark = pytest.mark.real_time("vessels")

FULL, CLIMB, TURN, STEP = 1.0, 0.5, 45.0, 0.1


class Boat:
    """A vehicle that goes as its sticks say; `truth` is where it really is."""

    def __init__(self, heading=0.0, depth=0.0, current=(0.0, 0.0)):
        self.steering = StickSteering(0.0, 0.0, FULL)
        self.heading, self.depth, self.current = heading, depth, current
        self.truth, self.time = [0.0, 0.0], 0.0
        self.sticks = []

    def run(self, seconds=600.0):
        """Go on until the goal is reached; return the seconds that it took."""
        begun = self.time
        while not self.steering.reached:
            assert self.time - begun < seconds
            sticks = self.steering.step(self.time, self.heading, self.depth)
            self.sticks.append(sticks)
            assert all(-1.0 <= each <= 1.0 for each in (sticks.forward, sticks.up, sticks.turn))
            turned = self.heading + TURN * sticks.turn * STEP
            middle = radians((self.heading + turned) / 2.0)
            way = FULL * sticks.forward * STEP
            self.truth[0] += way * sin(middle) + self.current[0] * STEP
            self.truth[1] += way * cos(middle) + self.current[1] * STEP
            self.heading, self.depth = turned % 360.0, max(0.0, self.depth - CLIMB * sticks.up * STEP)
            self.time += STEP
        return self.time - begun


@given(
    st.floats(-40.0, 40.0),
    st.floats(-40.0, 40.0),
    st.floats(0.0, 20.0),
    st.floats(0.0, 359.0),
    st.floats(0.2, 1.0),
)
def test_it_gets_to_a_place_at_its_depth(east, north, depth, heading, speed):
    boat = Boat(heading)
    boat.steering.aim(Goal(depth, east, north, speed=speed))
    boat.run()
    assert hypot(boat.truth[0] - east, boat.truth[1] - north) <= 0.5
    assert abs(boat.depth - depth) <= 0.2


def test_what_it_reckons_is_where_it_is_in_still_water():
    boat = Boat()
    for place in ((30.0, 0.0), (30.0, 30.0), (0.0, 0.0)):
        boat.steering.aim(Goal(3.0, *place, speed=0.7))
        boat.run()
        assert (boat.steering.east, boat.steering.north) == pytest.approx(tuple(boat.truth), abs=0.15)


def test_a_current_is_not_seen_and_carries_it_as_far_as_it_flows():
    boat = Boat(current=(0.1, 0.0))
    boat.steering.aim(Goal(3.0, 0.0, 30.0, speed=0.5))
    took = boat.run()
    assert boat.steering.east == pytest.approx(0.0, abs=0.5)
    assert boat.truth[0] == pytest.approx(0.1 * took, abs=0.7)


def test_it_goes_no_faster_than_it_is_told():
    boat = Boat()
    boat.steering.aim(Goal(0.0, 0.0, 30.0, speed=0.4))
    assert boat.run() >= 30.0 / 0.4 - 2.0
    assert max(sticks.forward for sticks in boat.sticks) == pytest.approx(0.4)


def test_it_turns_on_the_spot_before_it_goes():
    boat = Boat(heading=0.0)
    boat.steering.aim(Goal(0.0, 0.0, -20.0))
    boat.run()
    assert boat.sticks[0].forward == 0.0
    assert abs(boat.sticks[0].turn) == 1.0
    assert max(abs(east) for east in (boat.truth[0], boat.steering.east)) < 1.5


@pytest.mark.parametrize(("begin", "end"), [(10.0, 350.0), (350.0, 10.0), (0.0, 180.0), (90.0, 90.0)])
def test_it_turns_the_shorter_way(begin, end):
    boat = Boat(begin)
    boat.steering.aim(Goal(0.0, heading=end))
    assert boat.run() <= 10.0
    assert abs((boat.heading - end + 180.0) % 360.0 - 180.0) <= 4.0


def test_a_goal_that_is_held_counts_only_after_its_time():
    boat = Boat()
    boat.steering.aim(Goal(2.0, 0.0, 0.0, seconds=12.0))
    assert 12.0 <= boat.run() <= 20.0


def test_without_a_goal_the_sticks_are_let_go():
    steering = StickSteering(0.0, 0.0, FULL)
    assert steering.step(0.0, 90.0, 3.0) == Sticks()
    steering.aim(Goal(0.0, 9.0, 9.0))
    assert steering.step(0.1, 90.0, 3.0) != Sticks()
    assert steering.drift(0.2) == Sticks()


def test_a_vehicle_that_drifts_is_not_reckoned_to_go_on():
    steering = StickSteering(0.0, 0.0, FULL)
    steering.aim(Goal(0.0, 0.0, 9.0))
    steering.step(0.0, 0.0, 0.0)
    assert steering.speed > 0.0
    steering.drift(0.1)
    north = steering.north
    steering.drift(5.0)
    assert (steering.speed, steering.north) == (0.0, north)
    assert steering.step(5.1, 0.0, 0.0) != Sticks()


@pytest.mark.parametrize(
    ("sticks", "axes"),
    [
        (Sticks(), (0, 0, 500, 0)),
        (Sticks(1.0, 1.0, 1.0), (1000, 0, 1000, 1000)),
        (Sticks(-1.0, -1.0, -1.0), (-1000, 0, 0, -1000)),
    ],
)
def test_let_go_the_stick_for_up_and_down_is_in_the_middle(sticks, axes):
    message = manual_control(7, sticks)
    assert (message.x, message.y, message.z, message.r) == axes
    assert (message.target, message.buttons) == (7, 0)
