"""Figures of recorded flights of real firmware, whose parameters are known.

MMRS_RECORDED_FLIGHTS names a folder of flights, each with a ROBOT.track.csv.gz: the vehicle's own estimate.
"""

from __future__ import annotations

import csv
import gzip
import os
from pathlib import Path
from shutil import copytree

import pytest
from flight_logs import Sample, telemetry
from flown_times.comparison import compared

from mmrs_mavlink.calibration.figures import figures_of
from mmrs_mavlink.calibration.judging import judged
from mmrs_mavlink.calibration.reading import flight_in
from mmrs_mavlink.calibration.type_file import type_in

FLIGHTS = os.environ.get("MMRS_RECORDED_FLIGHTS", "")
pytestmark = pytest.mark.skipif(
    not FLIGHTS, reason="MMRS_RECORDED_FLIGHTS names no folder of recorded flights"
)
TYPES = {"rover": 10, "sub": 12}


def samples_of(track: Path):
    """Yield the samples of a track, east and north of its first position."""
    with gzip.open(track, "rt", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if float(row["lat"])]
    latitude, longitude = float(rows[0]["lat"]), float(rows[0]["lon"])
    for row in rows:
        value = {name: float(text) for name, text in row.items()}
        place = ((value["lon"] - longitude) * 82_379.0, (value["lat"] - latitude) * 111_081.0, value["rel"])
        velocity = (value["vy"], value["vx"], -value["vz"])
        armed, item = bool(value["armed"]), int(value["seq"])
        yield Sample(value["t"], place, velocity, value["hdg"], int(value["mode"]), armed, item)


def figures(name, tmp_path):
    kind = TYPES.get(name.partition("-")[0], 2)
    (track,) = (Path(FLIGHTS) / name).glob("*.track.csv.gz") if "/" not in name else [Path(FLIGHTS) / name]
    (tmp_path / "flight.tlog").write_bytes(telemetry(samples_of(track), mav_type=kind))
    found = figures_of(flight_in(tmp_path / "flight.tlog"))
    return {(each.flown_as, each.name): each for each in found}


def test_a_copter_in_guided_has_the_figures_of_its_parameters(tmp_path):
    """WPNAV_ACCEL 2.5, PSC_JERK_XY 5, WPNAV_SPEED_UP 2.5, _DN 1.5, LAND_SPEED 0.5, ATC_SLEW_YAW 60."""
    found = figures("carbon-dioxide-guided/Alba.track.csv.gz", tmp_path)
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
    found = figures("carbon-dioxide-auto", tmp_path)
    assert found["MISSION", "maxJerk"].median == pytest.approx(1.0, rel=0.15)
    assert found["MISSION", "maxClimbRate"].median == pytest.approx(2.5, rel=0.05)


def test_wind_changes_the_figures_little(tmp_path):
    calm = figures("lawn-auto/Uno.track.csv.gz", tmp_path)["MISSION", "maxJerk"].median
    windy = figures("lawn-auto-wind/Uno.track.csv.gz", tmp_path)["MISSION", "maxJerk"].median
    assert windy == pytest.approx(calm, rel=0.2)


@pytest.mark.parametrize(
    ("name", "flown_as", "acceleration"),
    [
        ("rover-long-legs-guided", "STEP", 1.0),
        ("sub-auto", "MISSION", 0.7),
    ],
)
def test_rovers_and_submarines_have_figures_too(name, flown_as, acceleration, tmp_path):
    found = figures(name, tmp_path)
    assert found[flown_as, "maxAcceleration"].median == pytest.approx(acceleration, rel=0.15)


FLOWN = sorted(each.parent for each in Path(FLIGHTS).glob("*/*.track.csv.gz")) if FLIGHTS else []
AS_IT_IS = ("px4", "rover-arcs-stuck", "sub-")
"""Flights without tracks, by an earlier driver, and of a type of an earlier metamodel."""


@pytest.mark.parametrize(
    "folder",
    [each for each in dict.fromkeys(FLOWN) if not each.name.startswith(AS_IT_IS)],
    ids=lambda each: each.name,
)
def test_a_plan_is_no_worse_by_the_figures_of_its_own_flight(folder, contributions, tmp_path):
    copied = tmp_path / folder.name
    copytree(folder, copied)
    for track in folder.glob("*.track.csv.gz"):
        kind = TYPES.get(folder.name.partition("-")[0], 2)
        (tmp_path / "flight.tlog").write_bytes(telemetry(samples_of(track), mav_type=kind))
        flight = flight_in(tmp_path / "flight.tlog")
        (file,) = (copied / "robots").iterdir()
        payload = 20.0 if kind == TYPES["rover"] else 0.0
        type = type_in(file, contributions.languages, payload)
        type.write(judged(flight, figures_of(flight, type.capacity), type.current))
    for before, after in zip(compared(folder), compared(copied), strict=True):
        assert abs(after.ratio - 1.0) <= abs(before.ratio - 1.0) + 0.002, after.line()
