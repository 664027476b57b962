"""What the plug-in's page says of the simulated vehicle is so."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from sample_vessels import pool_sheet
from vessel_sheets import Asked

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec

PAGE = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
TABLE = PAGE[PAGE.index("## The simulated vehicle") :]


def said_keys() -> list[str]:
    keys = []
    for row in re.findall(r"^\| (`.*?) \|", TABLE, re.MULTILINE):
        for key in re.findall(r"`([^`]+)`", row):
            keys.append(keys[-1].rsplit(".", 1)[0] + key if key.startswith(".") else key)
    return keys


def test_the_page_names_all_that_a_sheet_may_say_of_the_body():
    extra = Asked()
    sheet: Sheet = replace(pool_sheet(), extra=extra)
    vehicle = Vehicle(sheet, Codec(sheet), Surroundings())
    command = Codec(sheet).encode("DeviceCommand", Device=0, Action=0, Parameter=0.0, Request=1)
    vehicle.hear(command, 0.0)
    vehicle.hear(Codec(sheet).encode("DeviceCommand", Device=1, Action=0, Parameter=0.0, Request=1), 0.0)
    instruments = ("pressure.", "rates.", "attitude.", "heading.", "acceleration.", "log.", "fix.", "start.")

    asked = {key for key in extra.keys_asked if not key.startswith(instruments)}

    spread = {"linear_drag.sway", "linear_drag.heave", "linear_drag.roll", "linear_drag.pitch"}
    assert asked == set(said_keys()) | spread


@pytest.mark.parametrize("key", ["munk", "righting_arm", "linear_drag.yaw", "thruster.lag"])
def test_a_negative_value_is_refused_with_its_name(key):
    sheet = pool_sheet(**{key: -1.0})

    with pytest.raises(ValueError, match=key.replace(".", r"\.")):
        Vehicle(sheet, Codec(sheet))
