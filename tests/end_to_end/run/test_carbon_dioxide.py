"""The mission of the paper, carried out by `mmrs run` with three simulated vehicles."""

from __future__ import annotations

import subprocess
import sys
from contextlib import ExitStack
from itertools import pairwise
from math import hypot, inf

import pytest
from fault_table.fleet import free_port, mmrs
from shapely import LineString, Polygon

from mmrs_core import pipeline
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import Outcome, replay
from mmrs_core.languages.reading import read_model
from mmrs_core.mavlink.earth import degrees_of
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped
from mmrs_core.scene import AreaUse
from mmrs_core.sitl import Settings, SimulatedVehicle

SPEEDUP = 25.0
SLACK = 0.05
"""Metres that a track may be less clear: the example allows for no error of position."""

pytestmark = pytest.mark.thorough


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Return the program, its place, what became of the run, and the vehicles after it."""
    folder = tmp_path_factory.mktemp("carbon-dioxide")
    example = shipped("examples") / "carbon-dioxide"
    file = folder / "behaviour.xmi"
    mmrs("plan", str(example), "-o", str(file))
    contributions = load_plugins().contributions
    models, _ = pipeline.valid_models(example, contributions)
    place = pipeline.place_of_scene(pipeline.ground(models))
    (behaviour,) = read_model(file, contributions.languages).roots
    program = pipeline.program_of(behaviour, contributions)
    command = [sys.executable, "-W", "error", "-m", "mmrs_core", "run", str(file), "--speedup", str(SPEEDUP)]
    command += ["--context", str(example / "context.xmi"), "--robots", str(example / "robots")]
    command += ["--log", str(folder / "logs")]
    with ExitStack() as stack:
        vehicles = {}
        for robot in program.robots:
            ((latitude, longitude),) = degrees_of([robot.home[:2]], program.frame)
            port = free_port()
            settings = Settings("copter", latitude, longitude, energy=20_000.0)
            vehicles[robot.id] = stack.enter_context(SimulatedVehicle(port, settings, speedup=SPEEDUP))
            command += ["--connect", f"{robot.id}=udpin:127.0.0.1:{port}"]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=280)
    return program, place, done, vehicles, folder / "logs"


def test_three_vehicles_fly_it_to_its_end(flown):
    _, _, done, vehicles, _ = flown
    assert len(vehicles) == 3
    assert done.returncode == 0, done.stderr
    assert not any(vehicle.autopilot.armed for vehicle in vehicles.values())


def test_its_logs_replay(flown):
    program, _, _, _, logs = flown
    result = replay(program, read_logs([logs]))
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ())


def test_its_tracks_are_clear_of_every_grown_area_corners_included(flown):
    program, place, _, vehicles, _ = flown
    areas = [area for area in place.areas if area.use is not AreaUse.EMERGENCY]
    assert areas
    for robot in program.robots:
        track = vehicles[robot.id].autopilot.track
        assert len(track) > 100
        needed = place.types[robot.type_name].half_diagonal + program.position_error
        for area in (each for each in areas if each.concerns(robot.type_name)):
            margin = least_margin(track, robot.home, area, needed)
            assert margin >= -SLACK, f"{robot.id} is {-margin:.2f} m too close to {area.name}"


def least_margin(track, home, area, needed: float) -> float:
    """Return how much farther from an area as drawn than it must be a track stays, metres."""
    shape = Polygon(area.shell)
    margins = []
    for (_, n1, e1, u1), (_, n2, e2, u2) in pairwise(track):
        way = LineString([(home[0] + e1, home[1] + n1), (home[0] + e2, home[1] + n2)])
        low, high = home[2] + min(u1, u2), home[2] + max(u1, u2)
        above = max(low - area.high, area.low - high, 0.0)
        margins.append(hypot(shape.distance(way), above) - area.safety_distance - needed)
    return min(margins, default=inf)
