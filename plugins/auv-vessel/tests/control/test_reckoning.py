from math import cos, hypot, radians, sin
from random import Random

import numpy as np
import pytest
from sample_vessels import pool_sheet, torpedo_sheet
from vessel_rig import Rig

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.control.reckoning import LOG_PERIOD, Reckoning
from auv_vessel.instruments import Instruments

PERIOD = 0.1
KINDS = Instruments()


def journey(seed: int, *, log: bool, seconds: float = 60.0) -> tuple[Reckoning, np.ndarray]:
    """Return a reckoning, and the true place, after a way with turns, by instruments with noise and bias."""
    random = Random(seed)
    flow = np.array((random.gauss(0.0, 0.2), random.gauss(0.0, 0.2)))
    log_bias = np.array([random.gauss(0.0, KINDS.log_bias) for _ in range(2)])
    compass_bias = radians(random.gauss(0.0, KINDS.heading_bias))
    place = np.array([random.gauss(0.0, KINDS.start_noise) for _ in range(2)])
    reckoning, heading, said = Reckoning(0.0, 0.0, KINDS), 0.0, np.zeros(2)
    for step in range(round(seconds / PERIOD)):
        heading += radians(3.0) * sin(0.05 * step) * PERIOD * 5.0
        turn = np.array(((cos(heading), -sin(heading)), (sin(heading), cos(heading))))
        water = np.array((0.5, 0.02 * sin(0.1 * step)))
        ground = water + turn.T @ flow
        place = place + turn @ ground * PERIOD
        compass = heading + compass_bias
        if step % round(LOG_PERIOD / PERIOD) == 0:
            said = ground + log_bias + [random.gauss(0.0, KINDS.log_noise) for _ in range(2)]
            if log:
                reckoning.note_current(compass, said, water)
        if log:
            reckoning.advance_over_ground(compass, *said, PERIOD)
        else:
            reckoning.advance_through_water(compass, *water, PERIOD)
    return reckoning, place


def squared(reckoning: Reckoning, place: np.ndarray) -> float:
    """Return the squared error of the place by its covariance: 2 on average if that is right."""
    error = place - reckoning.state[:2]
    return float(error @ np.linalg.solve(reckoning.covariance[:2, :2], error))


@pytest.mark.parametrize("log", [True, False], ids=["log", "no log"])
def test_errors_are_as_large_as_they_are_said_to_be(log: bool) -> None:
    """The mean of 24 squares is within 1.0 and 3.4 in 99.9 % of cases if right; less is careful."""
    found = [squared(*journey(seed, log=log)) for seed in range(24)]
    assert 0.3 < float(np.mean(found)) < 3.4


def test_a_drag_that_is_not_what_the_sheet_says_is_allowed_for_while_there_is_no_log() -> None:
    """The current is known when the log falls silent; from then on speed is reckoned wrongly by a tenth."""
    found = []
    for ahead in (0.45, 0.55):
        reckoning = Reckoning(0.0, 0.0, KINDS)
        for _ in range(3000):
            reckoning.note_current(0.0, np.array((0.5, 0.0)), np.array((0.5, 0.0)))
        place = np.zeros(2)
        for _ in range(600):
            place = place + np.array((ahead, 0.0)) * PERIOD
            reckoning.advance_through_water(0.0, 0.5, 0.0, PERIOD)
        found.append(squared(reckoning, place))
    assert max(found) < 1.5


def test_uncertainty_grows_much_faster_without_a_log() -> None:
    with_log, without = journey(1, log=True)[0], journey(1, log=False)[0]
    assert with_log.uncertainty < 1.0
    assert without.uncertainty > 5.0 * with_log.uncertainty


def test_the_current_is_learnt_while_there_is_a_log() -> None:
    reckoning = Reckoning(0.0, 0.0, KINDS)
    for _ in range(300):
        reckoning.note_current(0.0, np.array((0.7, -0.1)), np.array((0.5, 0.0)))
    assert reckoning.current() == pytest.approx((0.2, -0.1), abs=0.03)


def test_a_fix_takes_errors_away() -> None:
    reckoning, place = journey(3, log=True, seconds=120.0)
    for _ in range(20):
        assert reckoning.fix(*place)
    assert hypot(*(reckoning.state[:2] - place)) < 0.15
    assert reckoning.uncertainty < 0.2


def test_a_fix_that_cannot_be_is_refused_until_others_agree() -> None:
    reckoning = Reckoning(0.0, 0.0, KINDS)
    assert not reckoning.fix(40.0, 0.0)
    assert not reckoning.fix(-25.0, 30.0)
    assert hypot(*reckoning.state[:2]) == 0.0
    for _ in range(2):
        assert not reckoning.fix(39.5, 0.5)
    assert reckoning.fix(40.2, 0.2)
    assert reckoning.state[:2] == pytest.approx((40.2, 0.2))


def test_covariance_stays_symmetric_and_positive() -> None:
    reckoning, place = journey(5, log=True)
    reckoning.fix(*place)
    assert reckoning.covariance == pytest.approx(reckoning.covariance.T)
    assert np.linalg.eigvalsh(reckoning.covariance).min() > 0.0


SEEDS = [0, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(1, 12))]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("sheet", [pool_sheet, torpedo_sheet])
@pytest.mark.parametrize(
    "bottom", [20.0, pytest.param(90.0, marks=pytest.mark.thorough)], ids=["log", "no log"]
)
def test_a_whole_vehicle_is_within_four_sigma_of_where_it_says(
    seed: int, sheet: object, bottom: float
) -> None:
    random = Random(seed)
    current = (random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2))
    rig = Rig(sheet(), Surroundings(current=current, bottom=bottom), seed)
    rig.run(2.0)
    for _ in range(2):
        rig.craft.go_to(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(1.0, 4.0))
        rig.run(12.0)
        truth = rig.vehicle.truth
        error = hypot(truth.north - rig.state.north, truth.east - rig.state.east)
        assert error < 4.0 * rig.state.uncertainty
        assert abs(truth.depth - rig.state.depth) < 0.05
