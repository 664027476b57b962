"""A thruster's drive: what it obeys, and when it stops by itself."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import thruster

from auv_vessel.body.thrust import FAULT, OFF, RUNS, WATCHDOG, Drive

WATCH = 0.5


@pytest.fixture
def drive() -> Drive:
    return Drive(thruster("T1", (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), WATCH)


@pytest.fixture
def running(drive) -> Drive:
    drive.command(10.0, True, 4, 0.0)
    drive.command(10.0, True, 5, 0.1)
    return drive


def test_it_is_off_until_it_is_told_something(drive):
    drive.run(100.0)

    assert (drive.state, drive.thrust) == (OFF, 0.0)


def test_the_first_command_only_tells_where_the_counter_is(drive):
    assert not drive.command(10.0, True, 4, 0.0)
    assert (drive.state, drive.thrust) == (OFF, 0.0)
    assert drive.command(10.0, True, 5, 0.05)
    assert (drive.state, drive.thrust) == (RUNS, 10.0)


@pytest.mark.parametrize("ahead", [1, 2, 127])
def test_a_counter_that_went_on_is_obeyed(running, ahead):
    assert running.command(-3.0, True, 5 + ahead, 0.2)
    assert running.thrust == -3.0


@pytest.mark.parametrize("ahead", [0, -1, 128, 200])
def test_a_counter_that_did_not_is_not(running, ahead):
    assert not running.command(-3.0, True, (5 + ahead) % 256, 0.2)
    assert running.thrust == 10.0


def test_the_counter_goes_round(running):
    for counter in (130, 250):
        running.command(10.0, True, counter, 0.2)

    assert running.command(7.0, True, 3, 0.3)
    assert running.thrust == 7.0


def test_no_more_than_peak_thrust_is_put_out(running):
    running.command(500.0, True, 6, 0.2)
    assert running.thrust == 35.0
    running.command(-500.0, True, 7, 0.3)
    assert running.thrust == -35.0


def test_what_is_not_enabled_does_not_run(running):
    assert running.command(10.0, False, 6, 0.2)
    assert (running.state, running.thrust) == (OFF, 0.0)


def test_the_watchdog_stops_it_when_its_time_is_over_and_not_before(running):
    running.run(0.1 + WATCH - 0.001)
    assert (running.state, running.thrust) == (RUNS, 10.0)
    running.run(0.1 + WATCH)
    assert (running.state, running.thrust) == (WATCHDOG, 0.0)


def test_commands_that_are_not_valid_do_not_keep_the_watchdog_quiet(running):
    for number in range(1, 7):
        running.command(10.0, True, 5, 0.1 + 0.1 * number)

    assert (running.state, running.thrust) == (WATCHDOG, 0.0)


def test_a_sender_that_repeats_itself_for_ever_never_starts_it_again(running):
    for number in range(100):
        running.command(10.0, True, 5, 0.1 + 0.1 * number)
        assert number < 5 or running.thrust == 0.0


def test_after_the_watchdog_commands_are_obeyed_once_their_counter_goes_on(running):
    running.run(10.0)

    assert not running.command(10.0, True, 77, 10.0)
    assert running.state == WATCHDOG
    assert running.command(10.0, True, 78, 10.1)
    assert (running.state, running.thrust) == (RUNS, 10.0)


def test_an_emergency_is_for_good(running):
    running.stop()
    assert (running.state, running.thrust) == (OFF, 0.0)
    for number in range(6, 40):
        running.command(10.0, True, number, 0.1 * number)
        assert (running.state, running.thrust) == (OFF, 0.0)


def test_a_dead_motor_is_a_fault_and_goes_on_when_it_is_mended(running):
    running.dead = True
    running.run(0.2)
    assert (running.state, running.thrust) == (FAULT, 0.0)

    running.dead = False
    running.command(10.0, True, 6, 0.3)
    assert (running.state, running.thrust) == (RUNS, 10.0)


COMMANDS = st.lists(
    st.tuples(st.floats(0.0, 1.0), st.floats(-60.0, 60.0), st.booleans(), st.integers(0, 255)), max_size=30
)


@settings(deadline=None)
@given(COMMANDS, st.floats(0.0, 1.0))
def test_there_is_thrust_only_for_a_while_after_a_valid_command(commands, later):
    drive = Drive(thruster("T1", (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), WATCH)
    now, heard, wanted = 0.0, None, 0.0
    for pause, thrust, enable, counter in commands:
        now += pause
        if drive.command(thrust, enable, counter, now):
            heard, wanted = now, max(-35.0, min(35.0, thrust)) if enable else 0.0
    now += later
    drive.run(now)

    fresh = heard is not None and now - heard < WATCH - 1e-9
    assert drive.thrust == (wanted if fresh else 0.0)
    assert (drive.state == RUNS) <= fresh
