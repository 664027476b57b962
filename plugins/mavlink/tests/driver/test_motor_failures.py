"""What a failed motor looks like, and when a copter no longer flies: figures of ArduCopter's simulation."""

from math import radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.vehicles.motor_failures import MotorFailures

KIND = "GLOBAL_POSITION_INT"

FALL = (
    (20.0, 0.0, 24),
    (19.9, 0.9, 45),
    (19.3, 3.3, 98),
    (18.5, 5.2, 105),
    (16.6, 7.1, 73),
    (14.3, 8.5, 60),
    (12.5, 9.3, 59),
    (9.5, 10.2, 57),
    (7.4, 10.7, 61),
    (5.2, 11.2, 65),
    (1.6, 12.2, 60),
)
"""Height, descent and lean every 0.25 s, after one of four motors of an ArduCopter 4.7-dev has been off."""

LIES = ((-0.6, -2.8, 9), (0.0, -2.0, 1), (0.0, 0.0, 0), *[(0.1, -0.1, 0)] * 12)
"""The same afterwards: it has hit the ground at 12.7 m/s."""


def sent(message):
    message._header.srcComponent = 1
    return message


def seen(*fixes, armed=True, lands=False, gap=0.25, beats="armed") -> MotorFailures:
    """Return what is noticed of heights, descents and leans, and of a heartbeat after them."""
    found = MotorFailures(KIND, lambda: 1, lambda: armed, lambda: lands)
    for index, (height, sink, lean) in enumerate(fixes):
        now = round(1000 * (10.0 + index * gap))
        found(sent(mavlink.MAVLink_attitude_message(now, radians(lean), 0, 0, 0, 0, 0)), False)
        place = (now, 423_700_000, 133_500_000, 0, round(height * 1000), 0, 0, round(sink * 100), 0)
        found(sent(mavlink.MAVLink_global_position_int_message(*place)), False)
    if beats:
        found(sent(mavlink.MAVLink_heartbeat_message(2, 3, 128 if beats == "armed" else 0, 4, 4, 3)), False)
    return found


def test_a_copter_that_falls_is_noticed_by_its_lean_within_a_second():
    assert not seen(*FALL[:3]).failure
    assert seen(*FALL[:4]).failure == "it tilts by 105 degrees"


def test_a_fall_counts_only_when_a_heartbeat_says_that_the_motors_run_still():
    assert seen(*FALL).failure
    assert not seen(*FALL, beats="").failure
    assert not seen(*FALL, beats="disarmed").failure


def test_one_that_falls_upright_is_noticed_by_its_descent():
    upright = [(height, sink, 5) for height, sink, _ in FALL]
    assert not seen(*upright[:5]).failure
    assert seen(*upright[:6]).failure == "it falls at 8 m/s"


def test_its_motors_stop_when_it_has_lain_on_the_ground_for_two_seconds():
    assert not seen(*FALL, *LIES[:9]).fallen(in_air=True)
    assert "it lies where it has fallen" in seen(*FALL, *LIES).fallen(in_air=False)


def test_one_that_has_fallen_on_its_side_lies_there_although_no_blow_was_seen():
    assert "it lies where" in seen(*[(0.3, 0.0, 45)] * 11).fallen(in_air=False)


def test_a_fall_that_nothing_stops_ends_with_stopped_motors():
    high = [(200.0 - 2.5 * n, 10.0, 60) for n in range(14)]
    assert "falling, tilted, for 3 s" in seen(*high).fallen(in_air=True)
    assert not seen(*high).fallen(in_air=False)


def test_one_that_catches_itself_keeps_its_motors():
    caught = [(max(8.0, 20.0 - 2.0 * n), max(0.0, 8.0 - n), max(0, 60 - 8 * n)) for n in range(40)]
    found = seen(*caught)
    assert found.failure
    assert not found.fallen(in_air=True)


def test_one_that_is_to_land_and_does_not_descend_is_down():
    waits = [(0.1, 0.0, 2)] * 42
    assert "has not descended for 10 s" in seen(*waits, lands=True).fallen(in_air=True)
    assert not seen(*waits).fallen(in_air=True)


@pytest.mark.parametrize("lands", [False, True])
@pytest.mark.parametrize("lean", [2, 31])
def test_one_that_has_caught_itself_and_hovers_keeps_its_motors(lands, lean):
    falls = [(34.0 - 1.8 * n, 7.0, 5) for n in range(3)]
    assert seen(*falls).failure
    assert not seen(*falls, *[(30.0, 0.0, lean)] * 60, lands=lands).fallen(in_air=True)


def test_a_lean_that_is_not_reported_again_counts_for_nothing():
    found = seen((0.3, 0.0, 55))
    for now in range(10_250, 16_000, 250):
        place = (now, 423_700_000, 133_500_000, 0, 300, 0, 0, 0, 0)
        found(sent(mavlink.MAVLink_global_position_int_message(*place)), False)
    assert not found.fallen(in_air=True)


def test_one_that_is_disarmed_is_carried_as_people_like():
    found = seen(*FALL, *LIES, armed=False)
    assert not found.failure
    assert not found.fallen(in_air=True)


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(2.0, 120.0), st.floats(-5.0, 5.0), st.floats(0.0, 45.0)), min_size=1, max_size=60
    ),
    st.sampled_from([0.1, 0.2, 0.5, 1.0]),
)
def test_nothing_that_is_flown_by_command_is_a_failure(fixes, gap):
    assert not seen(*fixes, gap=gap).failure


@pytest.mark.parametrize("lands", [False, True])
@settings(deadline=None)
@given(pace=st.floats(0.3, 3.0), lean=st.floats(0.0, 29.0))
def test_a_copter_that_lands_with_a_motor_less_is_never_taken_for_a_fallen_one(lands, pace, lean):
    recovers = [(60.0 - n, 4.0, 55) for n in range(6)]
    lands_slowly = [(54.0 - 0.25 * pace * n, pace, lean) for n in range(64)]
    found = seen(*recovers, *lands_slowly, lands=lands)
    assert found.failure
    assert not found.fallen(in_air=True)
