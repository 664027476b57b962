"""Small missions on vehicles whose services are MAVSDK's."""

import subprocess

import pytest
from example_flight.fleets import OfMavsdk
from example_flight.mission import Home
from mmrs_multicopter.testing import target_input, two_drones
from warm_python import python

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON
from mmrs_runtime.semantics import Outcome

pytestmark = pytest.mark.real_time("faults")

UPLOADED = {"MISSION_REQUEST_INT", "MISSION_ACK", "MISSION_COUNT", "MISSION_ITEM_INT"}
FLOWN = {"MISSION_CURRENT", "MISSION_ITEM_REACHED"}
ALWAYS = {"COMMAND_ACK", "PARAM_VALUE", "GLOBAL_POSITION_INT", "EXTENDED_SYS_STATE"}


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return two drones that have flown by generated controllers: program, folder, vehicles, code, words."""
    folder = tmp_path_factory.mktemp("flown")
    program = two_drones()
    write(render(MAVLINK_PYTHON, target_input(program)), folder)
    degrees = degrees_of([robot.home[:2] for robot in program.robots], program.frame)
    homes = [Home(robot.id, *place, robot.home) for robot, place in zip(program.robots, degrees, strict=True)]
    with OfMavsdk(homes, folder) as vehicles:
        links = [part for robot, url in vehicles.links.items() for part in ("--connect", f"{robot}={url}")]
        command = [python(), "fleet.py", *links, "--speedup", str(vehicles.speedup)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=120)
    return program, folder, vehicles, done


def test_controllers_fly_them_and_their_logs_replay(flown):
    program, folder, vehicles, done = flown
    assert done.returncode == 0, done.stderr
    result = replay(program, read_logs([folder / "logs"]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())
    assert all(max(abs(value) for value in track[-1][1:]) < 1.5 for track in vehicles.tracks.values())


def test_what_was_said_was_mavsdks(flown):
    _, _, vehicles, _ = flown
    assert vehicles.by_mavsdk["alpha"].keys() >= UPLOADED | FLOWN | ALWAYS
    assert vehicles.by_mavsdk["beta"].keys() >= ALWAYS
