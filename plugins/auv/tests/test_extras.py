"""Names that nobody reads are refused: of a sheet, of its `extra`, of a Doppler log."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from mmrs_auv.sheets import sheet_of
from sample_vessels import pool_sheet
from vessel_sheets import Asked

from auv_vessel.__main__ import main
from auv_vessel.api import Craft
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.goals import Goal
from auv_vessel.movement import guidance, loops
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.movement.movement import Movement
from auv_vessel.refusals import EXTRAS, SheetError
from auv_vessel.sheet import Sheet, from_json, to_json
from auv_vessel.wire.codec import Codec
from auv_vision.cameras import cameras_of
from mmrs_core.errors import UnsupportedError
from mmrs_core.grounding.scenes import robot_type_of


def test_known_are_just_the_names_that_somebody_reads() -> None:
    asked = Asked()
    sheet: Sheet = replace(pool_sheet(), extra=asked)
    codec = Codec(sheet)
    for part in (Sensors, Actuators, Movement, Craft, Vehicle):
        part(sheet, codec)
    cameras_of(sheet)
    guidance.Guidance(Goal("SEARCH"), loops.Motion(), sheet, abilities_of(sheet))
    assert asked.keys_asked == EXTRAS


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("search.radus", "there is no such name; did you mean 'search.radius'?"),
        ("deadman_time", "there is no such name; did you mean 'deadman.time'?"),
        ("camera.fronts.down", "there is no such name; did you mean 'camera.front.down'?"),
        ("device0.second", "there is no such name; did you mean 'device0.seconds'?"),
        ("device2.seconds", "there is no device 2, there are 2"),
        ("xyzzy", "there is no such name"),
    ],
)
def test_a_name_that_nobody_reads_is_refused_with_the_nearest(key: str, said: str) -> None:
    with pytest.raises(SheetError) as caught:
        Codec(pool_sheet(**{key: 1.0}))
    assert caught.value.faults == (f"extra {key!r}: {said}",)


def test_a_log_that_has_the_bottom_at_no_height_is_refused() -> None:
    with pytest.raises(SheetError, match=re.escape("extra 'log.least': 60.0 is not below 'log.most', 50.0")):
        Codec(pool_sheet(**{"log.least": 60.0}))


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ('"mass"', '"mas"', "'mas': there is no such name; did you mean 'mass'?; 'mass' is missing"),
        ('"watchdog"', '"watch_dog"', "'watch_dog': there is no such name; did you mean 'watchdog'?"),
        (
            '"max_thrust"',
            '"max_trust"',
            "thruster 0: 'max_trust': there is no such name; did you mean 'max_thrust'?",
        ),
        ('"mass"', '"height"', "'height' is there more than once"),
    ],
)
def test_a_node_does_not_begin_with_a_misspelt_sheet(
    right: str, wrong: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = to_json(pool_sheet())
    assert from_json(text) == pool_sheet()
    (tmp_path / "auv.json").write_text(text.replace(right, wrong, 1))
    assert main(["movement", "--sheet", str(tmp_path / "auv.json")]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("devices", "torpedo", "devices: 'torpedo' is not a list"),
        ("extra", [1.0], "extra: [1.0] is not an object"),
        ("thrusters", {}, "thrusters: {} is not a list"),
        ("thrusters", [7], "thruster 0: 7 is not an object"),
    ],
)
def test_what_has_another_shape_is_told_with_its_place(key: str, value: object, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(f"no sheet of a vehicle: {said}")):
        from_json(json.dumps(json.loads(to_json(pool_sheet())) | {key: value}))


@pytest.mark.parametrize("place", ["position", "direction"])
def test_a_vector_that_is_none_is_told_with_its_place(place: str) -> None:
    found = json.loads(to_json(pool_sheet()))
    found["thrusters"][1][place] = 7
    with pytest.raises(SheetError, match=re.escape(f"thruster 1 ('T2'): {place}: 7 is not three numbers")):
        Codec(from_json(json.dumps(found)))


def test_a_node_does_not_begin_with_a_misspelt_extra(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = json.loads(to_json(pool_sheet()))
    found["extra"] = {"power.limmit": 300.0}
    (tmp_path / "auv.json").write_text(json.dumps(found))
    assert main(["actuators", "--sheet", str(tmp_path / "auv.json")]) == 2
    assert (
        "extra 'power.limmit': there is no such name; did you mean 'power.limit'?" in capsys.readouterr().err
    )


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("dvl.range.mim", "0.5", "there is no such name; did you mean 'dvl.range.min'?"),
        ("dvl.range.max", "far", "is 'far', no number above 0"),
    ],
)
def test_what_a_doppler_log_says_in_vain_is_refused(
    key: str, value: str, said: str, project_types: list[object]
) -> None:
    types = [robot_type_of(each) for each in project_types]  # type: ignore[arg-type]
    type = next(each for each in types if each.name == "Pool AUV")
    camera = type.devices["ctd"]
    devices = {**type.devices, "ctd": replace(camera, properties={**camera.properties, key: value})}
    with pytest.raises(UnsupportedError) as caught:
        sheet_of(replace(type, devices=devices), "Naiad")
    assert any(
        each.startswith(f"device 'ctd': property '{key}'") and said in each for each in caught.value.elements
    )
