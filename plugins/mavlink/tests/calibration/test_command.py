"""`mmrs calibrate` as it is typed."""

from __future__ import annotations

import json

import pytest
from flight_logs import dataflash
from flown_curves import Curve, flown

from mmrs_core.cli import run

PLACES = [(0.0, 0.0, 20.0), (80.0, 0.0, 20.0), (0.0, 0.0, 20.0), (0.0, 60.0, 20.0)]


@pytest.fixture
def log(tmp_path):
    path = tmp_path / "00000001.BIN"
    path.write_bytes(dataflash(flown(PLACES, Curve()), watts=444.0))
    return path


def test_figures_are_printed_with_number_and_spread_and_as_attributes(log, capsys):
    assert run(["calibrate", str(log)]) == 0
    printed = capsys.readouterr().out
    assert "ArduCopter V4.7.0: 4" in printed
    assert "  STEP      maxAcceleration  m/s²  3  2.5" in printed
    assert "not in this log: maxClimbRate, maxDescentRate, maxVerticalAcceleration: no upright leg" in printed
    assert '<legTimings flownAs="STEP" maxAcceleration="2.5' in printed
    assert '<movementCapabilities lifetime="2880"' in printed


def test_json_holds_every_figure_or_why_not(log, capsys):
    assert run(["calibrate", str(log), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["vehicle"] == "ArduCopter V4.7.0"
    figures = {(each["flown_as"], each["name"]): each for each in found["figures"]}
    assert figures["STEP", "maxAcceleration"]["n"] == 3
    assert figures["STEP", "maxAcceleration"]["low"] <= figures["STEP", "maxAcceleration"]["median"]
    assert figures["MISSION", "maxJerk"] == {
        "name": "maxJerk",
        "unit": "m/s³",
        "flown_as": "MISSION",
        "n": 0,
        "missing": "not flown in auto",
    }


def test_damage_is_reported_and_the_rest_is_used(log, capsys):
    log.write_bytes(log.read_bytes()[:-7])
    assert run(["calibrate", str(log)]) == 0
    assert "ends within the message at byte" in capsys.readouterr().err


@pytest.mark.parametrize("data", [b"", b"no log", bytes(1000)])
def test_what_is_no_log_ends_with_code_3_and_its_name(data, log, capsys):
    log.write_bytes(data)
    assert run(["calibrate", str(log)]) == 3
    told = capsys.readouterr()
    assert told.out == ""
    assert str(log) in told.err
