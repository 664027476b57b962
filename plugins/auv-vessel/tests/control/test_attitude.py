import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from auv_vessel.control.attitude import AttitudeFilter, changes_of
from auv_vessel.instruments import Instruments
from auv_vessel.movement.loops import rotation

TILTS, RATES = st.floats(-70.0, 70.0), st.floats(-60.0, 60.0)


@given(TILTS, TILTS, st.floats(0.0, 360.0), st.tuples(RATES, RATES, RATES))
def test_angles_change_as_the_body_turns(
    roll: float, pitch: float, heading: float, rates: tuple[float, float, float]
) -> None:
    """A small turn about the body's axes leads to the same axes as the change of the three angles."""
    angles, step = np.array((roll, pitch, heading)), 1e-4
    later = angles + changes_of(angles, np.array(rates)) * step
    p, q, r = np.radians(rates)
    small = np.eye(3) + step * np.array(((0.0, -r, q), (r, 0.0, -p), (-q, p, 0.0)))
    assert rotation(*later) == pytest.approx(rotation(*angles) @ small, abs=1e-6)


def followed(
    seconds: float, rates: tuple[float, float, float], *, compass: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Return the attitude told, and the true one, after a turn with noise of instruments."""
    random, kinds = np.random.default_rng(2), Instruments()
    told, truth = AttitudeFilter(0.0, kinds), np.zeros(3)
    for step in range(round(seconds / 0.05)):
        now = 0.05 * step
        for _ in range(10):
            truth = truth + changes_of(truth, np.array(rates)) * 0.005
        truth[2] %= 360.0
        told.advance(0.05)
        told.take_rates(np.array(rates) + random.normal(0.0, kinds.rates_noise, 3), now)
        if compass:
            noise = random.normal(0.0, (kinds.attitude_noise, kinds.attitude_noise, kinds.heading_noise))
            told.take_angles((truth + noise + (0.0, 0.0, 360.0)) % (720.0, 720.0, 360.0), now)
    return told.angles, truth


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs((one - other + 180.0) % 360.0 - 180.0).max())


def test_a_turn_over_north_is_followed() -> None:
    assert apart(*followed(30.0, (0.0, 0.0, -25.0), compass=True)) < 1.0


def test_without_a_compass_gyroscopes_go_on() -> None:
    assert apart(*followed(10.0, (0.0, 0.0, 20.0), compass=False)) < 2.0
