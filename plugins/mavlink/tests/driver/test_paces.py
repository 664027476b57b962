"""How fast vehicles go where they are told to, and how near: ArduPilot's forget speeds, and stop early."""

from itertools import pairwise
from math import hypot

import pytest
from flight_crew import manned, robot_of

from mmrs_mavlink.program import Geographic
from mmrs_mavlink.services.uploads import Uploads

LEVEL = Geographic(42.3704, 13.35, 0.0)


@pytest.fixture
def rover():
    """Give a rover that stands ready at home, in GUIDED."""
    with manned(robot_of(vehicle="rover"), kind="rover") as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        yield made


def fastest(track) -> float:
    """Return the greatest level speed on a track, metres per second."""
    return max(
        hypot(b[1] - a[1], b[2] - a[2]) / (b[0] - a[0]) for a, b in pairwise(track) if b[0] - a[0] > 0.05
    )


def test_a_copter_goes_as_fast_as_it_is_told_right_after_its_take_off(in_the_air):
    made = in_the_air()
    made.vehicle.go_to(Geographic(42.3703, 13.35, 10.0), 2.0, None, False)
    assert 1.8 < fastest(made.simulated.autopilot.track) < 2.2


def test_a_copter_whose_first_target_is_lost_goes_as_fast_as_it_is_told_all_the_same(in_the_air):
    made = in_the_air()
    simulated, lost = made.simulated, []
    hear = simulated._take

    def lose_the_first(message):
        if message.get_type() == "SET_POSITION_TARGET_GLOBAL_INT" and not lost:
            lost.append(message)
        else:
            hear(message)

    simulated._take = lose_the_first
    made.vehicle.go_to(Geographic(42.3704, 13.35, 10.0), 2.0, None, False)
    assert lost
    assert fastest(simulated.autopilot.track) < 2.2


def test_a_rover_goes_as_fast_as_it_is_told_although_it_heeds_no_speed_before_a_target(rover):
    rover.vehicle.go_to(LEVEL, 1.0, None, False)
    assert 0.8 < fastest(rover.simulated.autopilot.track) < 1.2


def test_a_rover_comes_as_near_as_its_places_are_accepted(rover):
    assert rover.simulated.autopilot.parameters["WP_RADIUS"] <= 0.5
    rover.vehicle.go_to(LEVEL, 2.0, None, False)
    assert rover.away(LEVEL) <= 0.5
