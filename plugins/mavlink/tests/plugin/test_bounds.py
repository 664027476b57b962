"""What vehicles take lies within the bounds of the check: legs of simulated ones, and what was measured."""

from __future__ import annotations

from dataclasses import replace
from math import dist

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off

from mmrs_core.analysis.durations import durations_of
from mmrs_core.analysis.motion import motions
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.scene.timing import Rates
from mmrs_core.testing.programs import installed, move, program
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUSUB, PX4_MULTICOPTER
from mmrs_mavlink.sitl.body import STEP, Body, Vector
from mmrs_mavlink.steps.energy import CHARGING_FACTOR

ACCEPTANCE, STILL = 1.0, 0.3
"""Metres from a target, and metres per second, at which the driver takes a vehicle to have arrived."""

HERE = (0.0, 0.0, 20.0)
level = st.floats(-80.0, 80.0)
places = st.tuples(level, level, st.floats(3.0, 40.0))


def flown(profile, to: Vector, speed: float) -> float:
    """Return the seconds in which a simulated vehicle comes to a place, as the driver judges it."""
    figures = profile.pacing.step
    body = Body(figures, HERE, speed=speed, climb=figures.climb, descent=figures.descent)
    body.target, steps = to, 0
    while not (dist(body.position, to) <= ACCEPTANCE and body.pace <= STILL):
        body.advance(STEP)
        steps += 1
        assert steps < 20_000
    return steps * STEP


@pytest.mark.parametrize("profile", [ARDUCOPTER], ids=lambda each: each.name)
@given(places, st.floats(1.0, 10.0))
@example(HERE, 5.0)
@example((0.0, 0.5, 20.0), 5.0)
@example((0.0, 12.0, 20.0), 8.5)
@example((0.0, 0.0, 40.0), 5.0)
@settings(max_examples=60, deadline=None)
def test_a_leg_of_a_simulated_vehicle_keeps_to_its_bounds(profile, to, speed):
    figures = profile.pacing.step
    rates = Rates(speed, figures.climb, figures.descent, figures)
    least, most = (each.from_stop_to_stop(HERE, to) for each in (rates.soonest(), rates.latest()))
    assert least <= flown(profile, to, speed) <= most


def bounds(*moves, **movement):
    """Return the bounds of the moves of a robot between take-off and landing, by the check."""
    contributions = installed()
    robot = robot_program("alpha", [take_off("up", 20.0), *moves, LAND])
    kind = quad()
    kind = replace(
        kind,
        part=replace(kind.part, attributes={"maxAltitude": 120.0}),
        capabilities=tuple(replace(each, **movement) for each in kind.capabilities),
    )
    given = CheckInput(
        program(robot), {kind.name: kind}, contributions.robot_kinds, contributions.move_kinds, ()
    )
    found = durations_of(given, robot, motions(given)["alpha"]).of
    return {robot.moves[index].id: each for index, each in found.items()}


def on_the_spot(name, **attributes):
    return move(name, name, **attributes)


def test_a_turn_takes_as_long_as_the_autopilot_that_is_slower_than_the_type():
    """52 degrees per second were measured with ArduCopter where types stated 90."""
    turn = bounds(on_the_spot("HeadTo"), turn_rate=90.0)["HeadTo"].moved
    assert turn.low == 0.0
    assert 180.0 / 52.0 < turn.high < 180.0 / 40.0


def test_a_slow_type_turns_at_its_own_rate():
    assert bounds(on_the_spot("HeadTo"), turn_rate=20.0)["HeadTo"].moved.high > 9.0


def test_a_leg_of_no_length_takes_some_time_at_most():
    """Measured: 0.0 to 0.5 s one by one."""
    zero = bounds(go_to("there", (0.0, 10.0, 20.0)), go_to("again", (0.0, 10.0, 20.0)))["again"].moved
    assert zero.low == 0.0
    assert zero.high >= 0.5


def test_a_stop_takes_until_the_next_heartbeat():
    """Measured: up to 1.7 s."""
    found = bounds()
    assert found["stop"].moved.high >= 1.7
    assert found["start"].moved.high >= 0.3


def test_a_stay_is_noticed_a_little_later():
    """Measured: 10.00 to 10.19 s, and none at all where nothing is to be waited for."""
    assert bounds(on_the_spot("HoldPosition", duration=10.0))["HoldPosition"].moved.high >= 10.19
    assert bounds(on_the_spot("HoldPosition", duration=0.0))["HoldPosition"].moved.high > 0.0


def test_charging_may_take_as_long_as_the_driver_does_not_complain():
    charging = bounds(on_the_spot("Recharge", duration=600.0))["Recharge"].moved
    assert charging.low == 600.0
    assert charging.high >= CHARGING_FACTOR * 600.0


@pytest.mark.parametrize("profile", [ARDUCOPTER, ARDUSUB, PX4_MULTICOPTER], ids=lambda each: each.name)
def test_every_autopilot_that_turns_says_how_fast_and_reports_at_last(profile):
    assert profile.pacing.turn_rate <= 60.0
    assert profile.pacing.step.reporting >= 2.0
