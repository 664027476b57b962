from random import Random

import pytest

from auv_vessel.control.failsafe import STALE
from auv_vessel.control.plausibility import FEWEST, Channel, Drift, Freeze


def frozen_after(freeze: Freeze, value: float, most: int = 2000) -> int:
    """Return how many repetitions of a value it takes until it counts as frozen."""
    for count in range(most):
        if freeze.take(value):
            return count
    return most


def noisy(seed: int, sigma: float, slope: float = 0.0, count: int = 400) -> list[float]:
    random = Random(seed)
    return [float(round(1000.0 + slope * step + random.gauss(0.0, sigma))) for step in range(count)]


@pytest.mark.parametrize("slope", [0.0, 126.0, -500.0])
@pytest.mark.parametrize("seed", range(5))
def test_noise_that_ends_is_a_frozen_instrument(seed: int, slope: float) -> None:
    freeze, values = Freeze(1.0), noisy(seed, 60.0, slope)
    assert not any(freeze.take(value) for value in values)
    assert frozen_after(freeze, values[-1]) <= 2 * FEWEST


@pytest.mark.parametrize("seed", range(20))
def test_noise_of_one_step_repeats_values_and_is_not_frozen(seed: int) -> None:
    freeze = Freeze(1.0)
    assert not any(freeze.take(value) for value in noisy(seed, 0.7, count=5000))


def test_what_never_had_noise_may_stand_still() -> None:
    freeze = Freeze(1.0)
    for step in range(200):
        freeze.take(float(round(5.0 * step**1.5)))
    assert frozen_after(freeze, 14000.0) == 2000


def test_a_value_beyond_what_an_instrument_can_say_is_not_believed() -> None:
    channel = Channel(0.0, 10.0, 1.0)
    assert channel.judge((5.0,), 0.0)
    assert not channel.judge((10.5,), 0.1)
    assert channel.why == "out of range"


def test_a_jump_is_not_believed_and_the_state_becomes_stale() -> None:
    channel = Channel(0.0, 10.0, 1.0)
    assert channel.judge((5.0,), 0.0, residual=0.5, allowed=1.0)
    assert not channel.judge((9.0,), 0.1, residual=4.0, allowed=1.0)
    assert channel.trusted(STALE)
    assert not channel.trusted(STALE + 0.01)


def test_two_instruments_that_agree_do_not_drift_apart() -> None:
    drift, random = Drift(), Random(3)
    for step in range(400):
        drift.advance(0.3, 0.05)
        drift.take(0.3 * 0.05 * step + random.gauss(0.0, 0.01))
        assert abs(drift.difference) < 0.08


def test_an_instrument_that_does_not_follow_drifts_away() -> None:
    drift = Drift()
    for _ in range(100):
        drift.advance(0.3, 0.05)
        drift.take(2.0)
    assert abs(drift.difference) > 0.8


def test_a_heading_goes_on_over_north() -> None:
    drift = Drift()
    for step in range(100):
        drift.advance(20.0, 0.05)
        drift.take((300.0 + step) % 360.0, circle=360.0)
        assert abs(drift.difference) < 1e-6
