"""Thrust in the water follows the drives; power is by the type's two points."""

from dataclasses import replace
from math import exp

import pytest
from sample_vessels import pool_sheet

from auv_vessel.body.thrust import Propulsion, watts_of

THRUSTER = pool_sheet().thrusters[0]


@pytest.mark.parametrize(("thrust", "watts"), [(0.0, 0.0), (18.0, 90.0), (-18.0, 90.0), (35.0, 230.0)])
def test_power_goes_through_what_the_type_says(thrust, watts):
    assert watts_of(THRUSTER, thrust) == pytest.approx(watts)


@pytest.mark.parametrize("changes", [{"max_thrust": 18.0}, {"max_power": 90.0}, {"max_power": 0.0}], ids=str)
def test_without_a_second_point_power_is_that_of_an_ideal_propeller(changes):
    assert watts_of(replace(THRUSTER, **changes), 9.0) == pytest.approx(90.0 * 0.5**1.5)


def test_without_operating_power_there_is_only_the_peak():
    assert watts_of(replace(THRUSTER, operating_power=0.0), 35.0 / 4.0) == pytest.approx(230.0 / 8.0)
    assert watts_of(replace(THRUSTER, operating_power=0.0, max_thrust=0.0), 1.0) == 0.0


@pytest.mark.parametrize("lag", [0.05, 0.15, 1.0])
def test_thrust_follows_its_set_point_exponentially(lag):
    propulsion = Propulsion(pool_sheet(**{"thruster.lag": lag}), 0.01)
    for _ in range(20):
        _, middle, end = propulsion.step([10.0] * 6)

    assert end == pytest.approx([10.0 * (1.0 - exp(-0.2 / lag))] * 6)
    assert middle == pytest.approx([10.0 * (1.0 - exp(-0.195 / lag))] * 6)


def test_without_lag_thrust_is_its_set_point():
    assert Propulsion(pool_sheet(**{"thruster.lag": 0.0}), 0.01).step([3.0] * 6)[1:] == ([3.0] * 6, [3.0] * 6)


def test_a_negative_lag_is_refused():
    with pytest.raises(ValueError, match=r"pool-auv: thruster\.lag is -1"):
        Propulsion(pool_sheet(**{"thruster.lag": -1.0}), 0.01)
