"""A mission from MML to its replayed log, by an ArduSub that never knows where it is."""

import json
import shutil
from pathlib import Path

import pytest
from ports import free_port

from mmrs_core.testing.conformance.missions import run_command
from mmrs_mavlink.sitl import Settings, SimulatedVehicle

pytestmark = pytest.mark.real_time("vessels")

ROBOT = Path(__file__).parents[4] / "examples" / "outfall" / "robots" / "survey-auv.xmi"
MISSION = """<?xml version="1.0" encoding="UTF-8"?>
<mission:Mission xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:mission="urn:mmrs:mission:1.0"
    xmlns:auvtasks="urn:mmrs:auv-tasks:1.0" name="Dip" positionError="0.5">
  <team>
    <robots name="Nereid" type="Survey AUV">
      <home xsi:type="mission:RelativeCoordinate" x="0.0" y="0.0" z="0.0"/>
    </robots>
  </team>
  <tasks xsi:type="auvtasks:SurfaceTask" name="fix" duration="4.0">
    <point xsi:type="mission:RelativeCoordinate" x="6.0" y="-4.0"/>
  </tasks>
  <tasks xsi:type="auvtasks:YoYoTask" name="profile" minDepth="0.5" maxDepth="2.0" pitch="30.0">
    <initialPosition xsi:type="mission:RelativeCoordinate" x="6.0" y="0.0"/>
    <points xsi:type="mission:RelativeCoordinate" x="6.0" y="0.0"/>
    <points xsi:type="mission:RelativeCoordinate" x="0.5" y="0.0"/>
  </tasks>
  <origin xsi:type="mission:RelativeCoordinate" x="0.0" y="0.0"/>
  <acceptedUnknowns>range</acceptedUnknowns>
  <acceptedUnknowns>depth</acceptedUnknowns>
  <acceptedUnknowns>clearance</acceptedUnknowns>
</mission:Mission>
"""


def test_a_mission_is_carried_out_without_any_position_and_its_log_is_accepted(tmp_path):
    project, logs, port = tmp_path / "dip", tmp_path / "logs", free_port()
    (project / "robots").mkdir(parents=True)
    shutil.copy(ROBOT, project / "robots")
    (project / "mission.xmi").write_text(MISSION, encoding="utf-8")
    run_command("plan", project)
    with SimulatedVehicle(port, Settings(kind="sub"), speedup=10.0) as vehicle:
        vehicle.autopilot.located = False
        link = ("--connect", f"Nereid=udpin:127.0.0.1:{port}", "--speedup", "10")
        how = ("--backend", "ardusub-manual", "--backend-option", "full-speed=1.0", *link)
        run_command("run", project / "behaviour.xmi", *how, "--log", logs)
        depths = [-up for _, _, _, up in vehicle.autopilot.track]
        assert max(depths) >= 1.6
    assert "accepted: success" in run_command("replay", project / "behaviour.xmi", logs)
    box = [json.loads(line) for line in (logs / "Nereid.blackbox.ndjson").read_text().splitlines()]
    assert box[0]["kind"] == "start"
    assert min(line["place"]["height"] for line in box if line["kind"] == "fix") <= -1.6
