"""A vehicle that goes on with a program goes back to where it was broken off, by a way that is clear."""

from pathlib import Path

import pytest
from dives import dive, rehearse, swim
from mmrs_auv.backend.rehearsed import RehearsedRobot
from mmrs_auv.controllers.vehicle import CanVehicle

from mmrs_core.contributions.execution import Fault
from mmrs_core.scene import Area, AreaUse


def block(west: float, south: float, east: float, north: float) -> Area:
    ring = ((west, south), (east, south), (east, north), (west, north))
    return Area("wreck", AreaUse.OBSTACLE, ring)


def dived(folder: Path, *areas: Area) -> tuple[RehearsedRobot, float]:
    """Return a vehicle at (6, 0), 1 m deep, that has come from home by way of (0, 0.5); and the time."""
    behaviour = dive(swim("first", 0.0, 0.5, 1.0), swim("second", 6.0, 0.0, 1.0))
    found = rehearse(behaviour, folder, areas=areas, noise="no")
    return found.robots["naiad"], found.run.ending.time


def test_it_goes_round_what_is_in_its_way(tmp_path: Path) -> None:
    robot, now = dived(tmp_path, block(2.5, -1.5, 3.5, 0.8))
    assert robot.hindrance(("start", "first"), "second", now) == ""
    robot.recover(("start", "first"), "second", now)
    track = []
    while not robot.done:
        now += 0.5
        robot.look(now)
        assert robot.trouble is None
        assert now < 300.0
        truth = robot.stage.vehicle.truth
        track.append((truth.east, truth.north))
    assert track[-1] == pytest.approx((0.0, 0.5), abs=0.6)
    assert not [place for place in track if 2.3 < place[0] < 3.7 and -1.7 < place[1] < 1.0]


def test_whoever_runs_behaviours_knows_that_it_can_go_back(tmp_path: Path) -> None:
    robot, now = dived(tmp_path)
    assert robot.comes_home
    assert isinstance(robot, CanVehicle)
    assert robot.away(now) == "it is 6 m from home"
    robot.recover(("start",), "first", now)
    while not robot.done:
        now += 0.5
        robot.look(now)
        assert now < 300.0
    assert robot.away(now) == ""


@pytest.mark.thorough
def test_it_is_refused_where_there_is_no_way(tmp_path: Path) -> None:
    robot, now = dived(tmp_path, block(-3.0, -3.0, 3.0, 3.0))
    said = robot.hindrance(("start", "first"), "second", now)
    assert said.startswith("unknown path to where its program was interrupted: goal")
    assert "'wreck'" in said
    robot.recover(("start", "first"), "second", now)
    robot.look(now + 0.5)
    assert robot.trouble == Fault("REFUSED", said)
