"""What a vehicle takes for its place: jumps are noticed, and nothing that it can fly is one."""

from math import cos, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.vehicles.position_jumps import LEAP_METRES, PositionJumps

COMPONENT = 1
LOCAL = "LOCAL_POSITION_NED"
GLOBAL = "GLOBAL_POSITION_INT"
METRES_PER_DEGREE = 111_132.0


def sent(message, component: int = COMPONENT):
    message._header.srcComponent = component
    return message


def local(seconds: float, north: float, east: float = 0.0, up: float = 10.0, speed: float = 0.0):
    told = mavlink.MAVLink_local_position_ned_message(
        round(seconds * 1000), north, east, -up, speed, 0.0, 0.0
    )
    return sent(told)


def on_earth(seconds: float, latitude: float, longitude: float):
    return sent(
        mavlink.MAVLink_global_position_int_message(
            round(seconds * 1000), round(latitude * 1e7), round(longitude * 1e7), 0, 10_000, 0, 0, 0, 0
        )
    )


def heard(*messages, kind: str = LOCAL, armed: bool = True) -> PositionJumps:
    jumps = PositionJumps(kind, lambda: COMPONENT, lambda: armed)
    for message in messages:
        jumps(message, False)
    return jumps


def test_a_place_where_the_vehicle_cannot_be_by_now_is_a_leap():
    jumps = heard(local(10.0, 0.0), local(10.25, 40.0), local(10.5, 40.0))
    assert (jumps.count, jumps.last) == (1, "its position has leapt by 40 m in 0.25 s")


def test_a_leap_there_and_back_are_two():
    assert heard(local(10.0, 0.0), local(10.25, 40.0), local(10.5, 0.0)).count == 2


@pytest.mark.parametrize(
    "messages",
    [
        pytest.param((local(10.0, 0.0), local(14.0, 19.0, speed=5.0)), id="four seconds were lost"),
        pytest.param((local(10.0, 0.0), local(10.25, LEAP_METRES)), id="a correction"),
        pytest.param((local(10.0, 0.0), local(10.25, 0.0, up=60.0)), id="heights count from elsewhere"),
        pytest.param((local(900.0, 0.0), local(2.0, 500.0)), id="it has started anew elsewhere"),
        pytest.param(
            (local(10.0, 40.0, speed=20.0), local(8.0, 0.0, speed=20.0), local(10.2, 44.0, speed=20.0)),
            id="one comes late",
        ),
        pytest.param((local(10.0, 0.0), local(10.0, 40.0)), id="at the same instant: by no clock"),
        pytest.param(
            (local(10.0, 0.0), sent(local(10.25, 40.0), component=100)), id="another component's word"
        ),
    ],
)
def test_what_may_well_be_is_no_leap(messages):
    assert heard(*messages).count == 0


def test_people_may_carry_a_vehicle_whose_motors_are_off():
    assert heard(local(10.0, 0.0), local(10.25, 40.0), armed=False).count == 0


def test_what_is_sent_counts_for_nothing():
    jumps = heard(local(10.0, 0.0))
    jumps(local(10.25, 40.0), True)
    assert jumps.count == 0


def test_a_place_on_the_earth_leaps_too_and_none_at_all_is_no_leap():
    east = 40.0 / (METRES_PER_DEGREE * cos(radians(42.0)))
    assert heard(on_earth(1.0, 42.0, 13.0), on_earth(1.2, 42.0, 13.0 + east), kind=GLOBAL).count == 1
    assert heard(on_earth(1.0, 42.0, 13.0), on_earth(1.2, 0.0, 0.0), kind=GLOBAL).count == 0
    assert heard(on_earth(1.0, 0.0, 180.0), on_earth(1.2, 0.0, -180.0), kind=GLOBAL).count == 0


@given(
    st.lists(st.tuples(st.floats(0.0, 360.0), st.floats(0.0, 25.0)), min_size=2, max_size=40),
    st.lists(st.booleans(), min_size=40, max_size=40),
    st.randoms(use_true_random=False),
)
def test_no_flight_is_a_leap_whatever_is_lost_and_late(flown, lost, chance):
    """Headings in degrees and speeds in metres per second, four a second, changed at 6 m/s² at most."""
    north = east = speed = 0.0
    told = []
    for number, (heading, wanted) in enumerate(flown):
        speed += max(-1.5, min(1.5, wanted - speed))
        north += speed * 0.25 * cos(radians(heading))
        east += speed * 0.25 * sin(radians(heading))
        if not lost[number]:
            told.append((number + chance.uniform(0.0, 2.0), local(number * 0.25, north, east, speed=speed)))
    assert heard(*(message for _, message in sorted(told, key=lambda each: each[0]))).count == 0
