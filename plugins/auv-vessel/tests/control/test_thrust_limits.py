from dataclasses import replace

import numpy as np
import pytest
from sample_vessels import pool_sheet

from auv_vessel.control.actuators import PEAK_TIME, RISE_TIME, ThrustLimits

ALL = np.ones(6)


def hold(limits: ThrustLimits, thrust: float, seconds: float) -> float:
    """Ask for so much for so long; return the seconds for which more than operating thrust was allowed."""
    above, given = 0.0, np.zeros(6)
    for _ in range(round(seconds / 0.05)):
        low, high = limits.bounds(given, ALL, 0.05)
        given = np.clip(np.full(6, thrust), low, high)
        limits.used(given, 0.05)
        above += 0.05 * (given[0] > 18.0)
    return above


def test_peak_thrust_lasts_as_long_as_declared_and_no_longer() -> None:
    assert hold(ThrustLimits(pool_sheet()), 35.0, 30.0) == pytest.approx(PEAK_TIME + RISE_TIME / 2.0, abs=0.3)


def test_operating_thrust_lasts_for_ever() -> None:
    limits = ThrustLimits(pool_sheet())
    hold(limits, 18.0, 600.0)
    assert limits.bounds(np.full(6, 18.0), ALL, 0.05)[1][0] > 18.0


def test_peak_thrust_comes_back_after_rest() -> None:
    limits = ThrustLimits(pool_sheet())
    hold(limits, 35.0, 15.0)
    assert limits.bounds(np.zeros(6), ALL, 1.0)[1][0] == pytest.approx(18.0)
    hold(limits, 0.0, 0.3 * PEAK_TIME)
    assert limits.bounds(np.zeros(6), ALL, 1.0)[1][0] == pytest.approx(18.0)
    hold(limits, 0.0, 0.7 * PEAK_TIME)
    assert limits.bounds(np.zeros(6), ALL, 1.0)[1][0] == pytest.approx(35.0)


def test_thrust_changes_no_faster_than_drives_follow() -> None:
    low, high = ThrustLimits(pool_sheet()).bounds(np.zeros(6), ALL, 0.05)
    assert high == pytest.approx(np.full(6, 35.0 * 0.05 / RISE_TIME))
    assert low == pytest.approx(-high)


def test_a_thruster_that_does_not_work_gives_nothing() -> None:
    working = np.array((1.0, 0.0, 1.0, 1.0, 1.0, 1.0))
    low, high = ThrustLimits(pool_sheet()).bounds(np.full(6, 20.0), working, 0.05)
    assert low[1] == high[1] == 0.0


def test_power_is_that_of_the_robot_type_at_operating_and_at_peak_thrust() -> None:
    limits = ThrustLimits(pool_sheet())
    assert limits.power(np.array((18.0, 0, 0, 0, 0, 0))) == pytest.approx(90.0)
    assert limits.power(np.array((0, -35.0, 0, 0, 0, 0))) == pytest.approx(230.0)


def test_power_follows_from_peak_power_where_operating_power_is_none() -> None:
    sheet = pool_sheet()
    thrusters = tuple(replace(each, operating_power=0.0) for each in sheet.thrusters)
    limits = ThrustLimits(replace(sheet, thrusters=thrusters))
    assert limits.power(np.array((35.0, 0, 0, 0, 0, 0))) == pytest.approx(230.0)


@pytest.mark.parametrize("name", ["peak.time", "rise.time", "power.limit"])
def test_a_limit_has_to_be_positive(name: str) -> None:
    with pytest.raises(ValueError, match=f"{name} is 0"):
        ThrustLimits(pool_sheet(**{name: 0.0}))
