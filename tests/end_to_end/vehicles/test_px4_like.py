"""Generated controllers on our vehicles that behave as PX4's documentation says."""

import subprocess

import pytest
from mmrs_multicopter.testing import quad, target_input, two_drones
from ports import free_port
from warm_python import python

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_mavlink.sitl import Host, Settings, SimulatedVehicle
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("faults")

SPEEDUP = 10.0
OFFBOARD, MISSION = "guided", "auto"


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return two drones that have flown: program, folder, vehicles by robot, and the ended process."""
    folder, program, vehicles, links = tmp_path_factory.mktemp("flown"), two_drones(), {}, []
    types = [quad(**{"mavlink.camera.command": "digicam"})]
    write(render(MAVLINK_PYTHON, target_input(program, types)), folder)
    degrees = degrees_of([robot.home[:2] for robot in program.robots], program.frame)
    for number, (robot, place) in enumerate(zip(program.robots, degrees, strict=True), start=1):
        port = free_port()
        settings = Settings("copter", *place, system=number, firmware="px4")
        vehicles[robot.id] = SimulatedVehicle(port, settings, speedup=SPEEDUP)
        links += ["--connect", f"{robot.id}=udpin:127.0.0.1:{port}@{number}"]
    host = Host(list(vehicles.values()))
    host.start()
    command = [python(), "fleet.py", *links, "--speedup", str(SPEEDUP)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=120)
    host.stop()
    for vehicle in vehicles.values():
        vehicle.radio.close()
    return program, folder, vehicles, done


def test_they_fly_and_their_logs_replay(flown):
    program, folder, vehicles, done = flown
    assert done.returncode == 0, done.stderr
    result = replay(program, read_logs([folder / "logs"]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    assert not any(vehicle.autopilot.armed for vehicle in vehicles.values())


def test_runs_are_missions_and_the_rest_is_offboard(flown):
    _, _, vehicles, _ = flown
    names = {number: name for name, number in vehicles["alpha"].autopilot.numbers.items()}
    entered = [names[number] for _, number in vehicles["alpha"].autopilot.modes]
    assert OFFBOARD in entered
    assert MISSION in entered
