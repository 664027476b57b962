"""Figures of recorded flights of real firmware, whose parameters are known.

MMRS_RECORDED_FLIGHTS names a folder of flights, each with a ROBOT.track.csv.gz: the vehicle's own estimate.
"""

import os
from pathlib import Path

import pytest
from flown_times.calibrated import calibrate, copied, flights_of, log_of
from flown_times.comparison import RECORDED, compared

from mmrs_mavlink.calibration.figures import figures_of
from mmrs_mavlink.calibration.reading import flight_in

FLIGHTS = os.environ.get("MMRS_RECORDED_FLIGHTS", "")
pytestmark = pytest.mark.skipif(
    not FLIGHTS, reason="MMRS_RECORDED_FLIGHTS names no folder of recorded flights"
)


def figures(name, robot, tmp_path):
    (tmp_path / "flight.tlog").write_bytes(log_of(Path(FLIGHTS) / name, robot))
    found = figures_of([flight_in(tmp_path / "flight.tlog")])
    return {(each.flown_as, each.name): each for each in found}


def test_a_copter_in_guided_has_the_figures_of_its_parameters(tmp_path):
    """WPNAV_ACCEL 2.5, PSC_JERK_XY 5, WPNAV_SPEED_UP 2.5, _DN 1.5, LAND_SPEED 0.5, ATC_SLEW_YAW 60."""
    found = figures("carbon-dioxide-guided", "Alba", tmp_path)
    assert found["STEP", "maxAcceleration"].median == pytest.approx(2.5, rel=0.1)
    assert found["STEP", "maxJerk"].median == pytest.approx(5.0, rel=0.25)
    assert found["STEP", "maxClimbRate"].median == pytest.approx(2.5, rel=0.03)
    assert found["STEP", "maxDescentRate"].median == pytest.approx(1.5, rel=0.05)
    assert found["", "maxTurnRate"].median == pytest.approx(60.0, rel=0.2)
    assert found["", "landingRate"].median == pytest.approx(0.5, rel=0.05)
    assert found["", "landingHeight"].median == pytest.approx(10.0, rel=0.1)
    assert len(found["STEP", "maxAcceleration"].values) > 100


def test_a_copter_in_auto_has_the_jerk_of_its_parameter(tmp_path):
    """WPNAV_JERK 1: legs of 12 m, of which most do not reach the acceleration of 2.5."""
    found = figures("carbon-dioxide-auto", "Alba", tmp_path)
    assert found["MISSION", "maxJerk"].median == pytest.approx(1.0, rel=0.15)
    assert found["MISSION", "maxClimbRate"].median == pytest.approx(2.5, rel=0.05)


def test_wind_changes_the_figures_little(tmp_path):
    calm = figures("lawn-auto", "Uno", tmp_path)["MISSION", "maxJerk"].median
    windy = figures("lawn-auto-wind", "Uno", tmp_path)["MISSION", "maxJerk"].median
    assert windy == pytest.approx(calm, rel=0.2)


@pytest.mark.parametrize(
    ("name", "robot", "flown_as", "acceleration"),
    [("rover-long-legs-guided", "Badger", "STEP", 1.0), ("sub-auto", "Nereid", "MISSION", 0.7)],
)
def test_rovers_and_submarines_have_figures_too(name, robot, flown_as, acceleration, tmp_path):
    found = figures(name, robot, tmp_path)
    assert found[flown_as, "maxAcceleration"].median == pytest.approx(acceleration, rel=0.15)


FLOWN = sorted(each.parent for each in Path(FLIGHTS).glob("*/*.track.csv.gz")) if FLIGHTS else []
AS_IT_IS = ("px4", "rover-arcs-stuck", "sub-")
"""Flights without tracks, by an earlier driver, and of a type of an earlier metamodel."""


@pytest.mark.parametrize(
    "folder",
    [each for each in dict.fromkeys(FLOWN) if not each.name.startswith(AS_IT_IS)],
    ids=lambda each: each.name,
)
def test_a_plan_is_no_worse_by_the_figures_of_its_own_flight(folder, tmp_path):
    flights = flights_of(folder, tmp_path / "flight.tlog")
    for before, flight in zip(sorted(compared(folder), key=lambda each: each.robot), flights, strict=True):
        copy = copied(folder, tmp_path / before.robot)
        calibrate([copy], [flight])
        after = next(each for each in compared(copy) if each.robot == before.robot)
        assert list(after.faults()) == []
        assert off(after) <= off(before) + RECORDED * len(before.legs), after.line()


def off(comparison):
    """Return the seconds by which legs took longer or shorter than planned, all together."""
    return sum(abs(planned - flown) for planned, flown in comparison.legs.values())
