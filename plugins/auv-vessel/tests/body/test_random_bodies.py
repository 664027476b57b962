"""Whatever a vehicle is made of, its motion is finite, and nothing comes from nothing."""

from math import isfinite

import pytest
from counts import many
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import thruster

from auv_vessel.body.dynamics import body_of, energy, step
from auv_vessel.body.rotation import of_angles
from auv_vessel.sheet import Sheet

SIZES = st.floats(0.1, 6.0)
SPEEDS = st.floats(-3.0, 3.0)


@st.composite
def sheets(draw: st.DrawFn) -> Sheet:
    """Draw a vehicle, light or heavy for its size, with thrusters anywhere on it."""
    length, width, height = draw(SIZES), draw(SIZES), draw(SIZES)
    mass = 1025.0 * length * width * height * draw(st.floats(0.05, 2.0))
    places = st.tuples(*[st.floats(-size / 2.0, size / 2.0) for size in (length, width, height)])
    axes = st.sampled_from([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (0.6, 0.8, 0.0)])
    thrusters = draw(
        st.lists(st.builds(lambda place, axis: thruster("T", place, axis), places, axes), max_size=8)
    )
    return Sheet(
        robot="any",
        thrusters=tuple(thrusters),
        length=length,
        width=width,
        height=height,
        mass=mass,
        weight_in_water=mass * draw(st.floats(-0.5, 0.2)),
        speed=draw(st.floats(0.0, 4.0)),
        max_depth=100.0,
        battery=1e6,
        home=(0.0, 0.0, 0.0),
        extra={"munk": draw(st.sampled_from([0.0, 0.5, 1.0]))},
    )


STATES = st.builds(
    lambda depth, angles, speeds: (0.0, 0.0, depth, *of_angles(*angles), *speeds),
    st.floats(-3.0, 9.0),
    st.tuples(*[st.floats(-180.0, 180.0)] * 3),
    st.tuples(*[SPEEDS] * 6),
)


ROUNDS = settings(max_examples=many(600, fast=20), deadline=None)


@ROUNDS
@given(sheets(), STATES)
def test_energy_never_grows_without_thrust(sheet, state):
    body = body_of(sheet, (0.0, 0.0), 12.0)
    still = [0.0] * len(body.jets)
    last = energy(body, state)
    scale = body.weight + abs(last)
    for _ in range(300):
        state = step(body, state, (still, still, still), 0.01)
        now = energy(body, state)
        assert now <= last + 1e-5 * scale
        last = now


@ROUNDS
@given(sheets(), STATES, st.tuples(SPEEDS, SPEEDS), st.floats(-35.0, 35.0))
def test_all_numbers_stay_finite_under_thrust_in_a_current_on_the_bottom(sheet, state, current, force):
    body = body_of(sheet, current, 12.0)
    thrusts = [force] * len(body.jets)
    for _ in range(300):
        state = step(body, state, (thrusts, thrusts, thrusts), 0.01)
    assert all(isfinite(number) for number in state)
    assert max(abs(speed) for speed in state[7:]) < 50.0
    assert sum(part * part for part in state[3:7]) == pytest.approx(1.0)
