"""What the plug-in's page says of the control layer is so."""

import re
from dataclasses import fields, replace
from pathlib import Path

from sample_vessels import pool_sheet
from vessel_sheets import Asked

from auv_vessel.api import Craft
from auv_vessel.body.hydrodynamics import hull_of
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.goals import Goal
from auv_vessel.instruments import Instruments
from auv_vessel.movement import guidance, loops, movement
from auv_vessel.movement.abilities import abilities_of
from auv_vessel.wire.codec import Codec

PAGE = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
PART = PAGE[PAGE.index("## The nodes") : PAGE.index("## The simulated vehicle")]


def test_the_page_names_all_that_a_sheet_may_say_of_the_control_layer() -> None:
    of_body = Asked()
    hull_of(replace(pool_sheet(), extra=of_body))
    asked = Asked()
    sheet = replace(pool_sheet(), extra=asked)
    for kind in (Sensors, Actuators, movement.Movement, Craft):
        kind(sheet, Codec(pool_sheet()))
    guidance.Guidance(Goal("SEARCH"), loops.Motion(), sheet, abilities_of(sheet))
    of_instruments = {each.name.replace("_", ".", 1) for each in fields(Instruments)}
    said = {
        key
        for row in re.findall(r"^\| (`.*?) \|", PART, re.MULTILINE)
        for key in re.findall(r"`([^`]+)`", row)
    }
    assert said == asked.keys_asked - of_body.keys_asked - of_instruments


def test_the_page_says_within_what_a_goal_is_reached() -> None:
    said = (guidance.PLACE, guidance.DEPTH, guidance.HEADING, guidance.SPEED)
    assert f"position ({said[0]:g} m), depth ({said[1]:g} m), heading ({said[2]:g}°)" in PART
    assert f"{said[3]:g} m/s" in PART
