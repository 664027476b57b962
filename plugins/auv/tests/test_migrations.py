"""Vehicles whose movements hold their thrusters become vehicles that hold each of them once."""

import json
from dataclasses import replace

import pytest
from dives import dive, swim
from mmrs_auv import plugin
from mmrs_auv.constraints import CONSTRAINTS
from mmrs_auv.kinds import AUV_KIND
from mmrs_auv.sheets import sheet_of
from mmrs_auv.targets.ada.target import ADA
from mmrs_auv.targets.can_c.target import CAN_C
from mmrs_auv.targets.can_python.target import CAN_PYTHON

from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.render import render
from mmrs_core.grounding.robots import robot_type_of
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import label_of, metaclass_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import registry_with
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.models import breaches
from mmrs_core.transformation.kinds import MOVE_KINDS

FIGURES = 'maxDepth="50.0" operatingThrust="20.0" maxThrust="30.0" operatingPower="90.0" maxPower="200.0"'
PUSHING = f"""<thrusters id="T1" {FIGURES}>
      <freedomDegree>SURGE</freedomDegree><freedomDegree>YAW</freedomDegree>
      <mounting starboard="-0.1" pushForward="1.0"/>
    </thrusters>
    <thrusters id="T2" {FIGURES}>
      <freedomDegree>SURGE</freedomDegree><freedomDegree>YAW</freedomDegree>
      <mounting starboard="0.1" pushForward="1.0"/>
    </thrusters>"""
LIFTING = f"""<thrusters id="T3" {FIGURES}>
      <freedomDegree>HEAVE</freedomDegree><mounting pushDown="1.0"/>
    </thrusters>"""
OLD = f"""<robot:Robot xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:robot="urn:mmrs:robot:1.0"
    xmlns:auv="urn:mmrs:auv:1.0" name="Diver" pressuremeter="true" maxPayload="2.0">
  <size xsi:type="auv:InWaterSize" width="0.4" length="0.6" height="0.3" weight="20" weightInWater="-0.1"/>
  <batteries capacity="10000.0" voltage="22.2"/>
  <movementCapabilities xsi:type="auv:AUVMovement">
    <speed min="0.0" max="1.0"/>
    {PUSHING}
    {LIFTING}
  </movementCapabilities>
  <movementCapabilities xsi:type="auv:AUVMovement" payloadWeight="2.0">
    <speed min="0.0" max="0.6"/>
    {LIFTING}
    {PUSHING}
  </movementCapabilities>
</robot:Robot>"""

NEW = f"""<auv:AUV xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:auv="urn:mmrs:auv:1.1" name="Diver" pressuremeter="true" maxPayload="2.0">
  <size xsi:type="auv:InWaterSize" width="0.4" length="0.6" height="0.3" weight="20" weightInWater="-0.1"/>
  <batteries capacity="10000.0" voltage="22.2"/>
  <movementCapabilities xsi:type="auv:AUVMovement" thrusters="//@thrusters.0 //@thrusters.1 //@thrusters.2">
    <speed min="0.0" max="1.0"/>
  </movementCapabilities>
  <movementCapabilities xsi:type="auv:AUVMovement" payloadWeight="2.0"
      thrusters="//@thrusters.2 //@thrusters.0 //@thrusters.1">
    <speed min="0.0" max="0.6"/>
  </movementCapabilities>
  {PUSHING}
  {LIFTING}
</auv:AUV>"""
"""The same vehicle as it is written today."""


@pytest.fixture(scope="module")
def installed():
    return registry_with(plugin.mmrs_metamodels(), plugin.mmrs_migrations())


@pytest.fixture
def migrated(installed):
    def read(text, file="diver.xmi"):
        model = read_text(text.encode(), file, installed)
        (robot,) = model.roots
        return model, robot

    return read


def names_used(robot):
    return [[label_of(each) for each in movement.thrusters] for movement in robot.movementCapabilities]


def test_the_vehicle_holds_once_what_several_movements_held(migrated, installed):
    model, robot = migrated(OLD)
    assert metaclass_of(robot).key == ("urn:mmrs:auv:1.1", "AUV")
    assert [each.id for each in robot.thrusters] == ["T1", "T2", "T3"]
    assert names_used(robot) == [["T1", "T2", "T3"], ["T3", "T1", "T2"]]
    assert [each.code for each in model.diagnostics] == ["MIG001"]
    assert [str(each) for each in check_conformance(model, installed)] == []


def test_what_was_migrated_is_saved_and_read_again_without_a_migration(migrated, installed):
    _, robot = migrated(OLD)
    again = read_text(to_xmi([robot], installed), "new.xmi", installed)
    assert again.diagnostics == ()
    assert to_xmi(again.roots, installed) == to_xmi([robot], installed)
    assert names_used(again.roots[0]) == names_used(robot)


def test_a_movement_drives_the_thrusters_that_it_drove(migrated):
    sheets = [sheet_of(robot_type_of(migrated(OLD)[1]), "Diver", payload=payload) for payload in (0.0, 2.0)]
    assert [[each.id for each in sheet.thrusters] for sheet in sheets] == [
        ["T1", "T2", "T3"],
        ["T3", "T1", "T2"],
    ]
    assert sheets[0].thrusters[1].position == (0.0, 0.1, 0.0)


@pytest.mark.parametrize("target", [ADA, CAN_C, CAN_PYTHON], ids=lambda each: each.name)
@pytest.mark.parametrize("payload", [0.0, 2.0])
def test_the_same_bytes_are_generated_for_a_vehicle_of_before_and_of_today(migrated, target, payload):
    swims = dive(swim("a", 1.0, 2.0, 1.0), type_name="Diver")
    laden = replace(swims, robots=tuple(replace(each, payload=payload) for each in swims.robots))

    def generated(text):
        kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
        types = {"Diver": robot_type_of(migrated(text)[1])}
        return render(target, TargetInput(laden, types, {AUV_KIND.metaclass: AUV_KIND}, kinds))

    assert generated(OLD) == generated(NEW)


def test_thrusters_of_one_identifier_that_differ_are_both_kept_and_an_error(migrated, installed):
    head, tail = OLD.rsplit('<mounting pushDown="1.0"/>', 1)
    _, robot = migrated(f'{head}<mounting pushDown="-1.0"/>{tail}')
    assert [each.id for each in robot.thrusters] == ["T1", "T2", "T3", "T3"]
    (rule,) = [each for each in CONSTRAINTS if each.code == "AUV003"]
    found = breaches(rule, [robot])
    assert found == ["thruster 'T3' has the identifier of another one"]


def test_a_robot_that_is_only_sized_for_water_stays_what_it_is(migrated):
    start, end = OLD.index("  <movementCapabilities"), OLD.index("</robot:Robot>")
    plain = '<movementCapabilities><speed min="0.0" max="1.0"/></movementCapabilities>'
    _, robot = migrated(OLD[:start] + plain + OLD[end:])
    assert metaclass_of(robot).key == ("urn:mmrs:robot:1.0", "Robot")


def test_json_is_migrated_as_well(migrated):
    thruster = {"id": "T1", "freedomDegree": ["SURGE"], "maxDepth": 50.0, "operatingThrust": 20.0}
    movement = {"$type": "auv:AUVMovement", "thrusters": [thruster]}
    robot = {
        "$languages": {"robot": "urn:mmrs:robot:1.0", "auv": "urn:mmrs:auv:1.0"},
        "$type": "robot:Robot",
        "name": "Diver",
        "movementCapabilities": [movement, movement],
    }
    _, made = migrated(json.dumps(robot), "diver.json")
    assert names_used(made) == [["T1"], ["T1"]]
    assert len(made.thrusters) == 1
