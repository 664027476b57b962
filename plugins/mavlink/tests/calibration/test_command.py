"""`mmrs calibrate` as it is typed."""

import json

import pytest
from flight_logs import dataflash
from flown_curves import Curve, flown

from mmrs_core.cli import run
from mmrs_core.resources import shipped

AWAY = [(80.0, 0.0, 20.0), (0.0, 0.0, 20.0), (0.0, 60.0, 20.0), (0.0, 0.0, 20.0)]
PLACES = [(0.0, 0.0, 20.0), *AWAY, *AWAY, (80.0, 0.0, 20.0)]


@pytest.fixture
def log(tmp_path):
    path = tmp_path / "00000001.BIN"
    path.write_bytes(dataflash(flown(PLACES, Curve()), watts=444.0))
    return path


def test_figures_are_printed_with_number_and_spread_and_as_attributes(log, capsys):
    assert run(["calibrate", str(log)]) == 0
    printed = capsys.readouterr().out
    assert "ArduCopter V4.7.0: 128 s" in printed
    assert "  STEP      maxAcceleration  m/s²  9   2.5" in printed
    assert "not in this log: maxClimbRate, maxDescentRate, maxVerticalAcceleration: no upright leg" in printed
    assert '<legTimings flownAs="STEP" maxAcceleration="2.5' in printed
    assert '<movementCapabilities lifetime="2880"' in printed


def test_json_holds_every_figure_or_why_not(log, capsys):
    assert run(["calibrate", str(log), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [each["vehicle"] for each in found["logs"]] == ["ArduCopter V4.7.0"]
    figures = {(each["flown_as"], each["name"]): each for each in found["figures"]}
    assert figures["STEP", "maxAcceleration"]["n"] == 9
    assert figures["STEP", "maxAcceleration"]["low"] <= figures["STEP", "maxAcceleration"]["median"]
    assert figures["MISSION", "maxJerk"] == {
        "name": "maxJerk",
        "unit": "m/s³",
        "flown_as": "MISSION",
        "n": 0,
        "missing": "not flown in auto",
    }


def test_several_logs_count_together(log, capsys):
    assert run(["calibrate", str(log), str(log)]) == 0
    printed = capsys.readouterr().out
    assert printed.count("ArduCopter V4.7.0: 128 s") == 2
    assert ["STEP", "maxAcceleration", "m/s²", "18"] in [line.split()[:4] for line in printed.splitlines()]


def test_logs_of_different_vehicles_are_refused(log, tmp_path, capsys):
    rover = tmp_path / "rover.BIN"
    rover.write_bytes(dataflash(flown(PLACES, Curve()), firmware="ArduRover V4.7.0"))
    assert run(["calibrate", str(log), str(rover)]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert f"{rover}: ArduRover V4.7.0" in told.err


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


def test_figures_are_compared_with_a_type_and_written_into_it(log, tmp_path, capsys):
    file = tmp_path / "quad.xmi"
    file.write_bytes((shipped("examples") / "carbon-dioxide" / "robots" / "quad-650.xmi").read_bytes())
    before = file.read_bytes()
    assert run(["calibrate", str(log), "--robot-type", str(file)]) == 0
    head = next(line for line in capsys.readouterr().out.splitlines() if "flown as" in line)
    assert head.endswith(" type")
    assert file.read_bytes() == before
    assert run(["calibrate", str(log), "--robot-type", str(file), "--write", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["written"] == [str(file)]
    assert b'<legTimings flownAs="STEP"' in file.read_bytes()
    (lifetime,) = (each for each in printed["figures"] if each["name"] == "lifetime")
    assert lifetime["type"] != pytest.approx(lifetime["median"], rel=0.01)


def test_figures_of_few_values_are_told_and_not_written(log, capsys):
    log.write_bytes(dataflash(flown(PLACES[:3], Curve()), watts=444.0))
    assert run(["calibrate", str(log)]) == 0
    printed = capsys.readouterr().out
    few = next(line for line in printed.splitlines() if line.endswith("fewer than 3 values (STEP)"))
    assert few.startswith("not written: ")
    assert "maxJerk" in few
    assert "<legTimings" not in printed


def test_figures_of_fewer_than_two_legs_for_each_are_not_written(log, capsys):
    log.write_bytes(dataflash(flown(PLACES[:-3], Curve())))
    assert run(["calibrate", str(log)]) == 0
    assert (
        "maxAcceleration, maxDeceleration, maxJerk, settlingTime: fewer than 8 legs"
        in capsys.readouterr().out
    )


def test_writing_needs_a_type(log, capsys):
    assert run(["calibrate", str(log), "--write"]) == 2
    assert "--write needs --robot-type" in capsys.readouterr().err
