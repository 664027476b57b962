"""What the plug-in's page says of the control layer is so."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from pathlib import Path

from mmrs_auv.testing import pool_sheet
from mmrs_auv.vessel.api import Craft
from mmrs_auv.vessel.body.hydrodynamics import hull_of
from mmrs_auv.vessel.control.actuators import Actuators
from mmrs_auv.vessel.control.sensors import Sensors
from mmrs_auv.vessel.goals import Goal
from mmrs_auv.vessel.instruments import Instruments
from mmrs_auv.vessel.movement import guidance, loops, movement, progress
from mmrs_auv.vessel.movement.abilities import abilities_of
from mmrs_auv.vessel.wire.codec import Codec
from vessel_sheets import Asked

PAGE = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
PART = PAGE[PAGE.index("## The control layer") : PAGE.index("## The vehicle in simulation")]


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
    said = (progress.PLACE, progress.DEPTH, progress.HEADING, progress.SPEED)
    assert f"place ({said[0]:g} m), depth ({said[1]:g} m), heading ({said[2]:g}°)" in PART
    assert f"{said[3]:g} m/s" in PART
