"""What starts ArduPilot's simulation and records it, with a stand-in for the binary that is ours."""

import subprocess
import sys
from math import hypot

import pytest
from example_flight.fleets import PEERS, ArduCopter
from example_flight.mission import Home
from mmrs_multicopter.testing import target_input, two_drones
from warm_python import python

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON

pytestmark = pytest.mark.real_time("faults")


@pytest.mark.thorough
def test_its_vehicles_are_started_reached_and_recorded(tmp_path, monkeypatch):
    binary = tmp_path / "arducopter"
    binary.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{PEERS}/arducopter_stand_in.py" "$@"\n')
    binary.chmod(0o755)
    monkeypatch.setenv(ArduCopter.firmware.variable, str(binary))
    program = two_drones()
    write(render(MAVLINK_PYTHON, target_input(program)), tmp_path / "controllers")
    degrees = degrees_of([robot.home[:2] for robot in program.robots], program.frame)
    homes = [Home(robot.id, *place, robot.home) for robot, place in zip(program.robots, degrees, strict=True)]
    with ArduCopter(homes, tmp_path) as fleet:
        links = [part for robot, url in fleet.links.items() for part in ("--connect", f"{robot}={url}")]
        command = [python(), "fleet.py", *links, "--speedup", str(fleet.speedup)]
        done = subprocess.run(
            command, cwd=tmp_path / "controllers", capture_output=True, text=True, check=False, timeout=120
        )
    assert done.returncode == 0, done.stderr
    for home in homes:
        track = fleet.tracks[home.robot]
        assert len(track) > 50
        assert max(up for *_, up in track) > 5.0
        assert hypot(*track[-1][1:3]) < 1.5
