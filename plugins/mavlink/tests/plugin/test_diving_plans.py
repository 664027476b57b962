"""Missions for ArduSub: depths are negative heights above a home at the surface."""

import json
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import quad, robot_program, target_input
from pymavlink import mavutil, mavwp

from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import move, program
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

LAKE = Frame("EPSG:4326", 46.2, 6.1, 372.0, "MSL", surface=-3.0)
DIVER = replace(
    quad(),
    metaclasses=(("urn:mmrs:robot:1.0", "Robot"),),
    capability_metaclasses=(("urn:mmrs:auv:1.1", "AUVMovement"),),
)
HOME = (0.0, 0.0, -3.5)


@pytest.fixture(autouse=True)
def second_version_of_the_protocol(monkeypatch):
    monkeypatch.setenv("MAVLINK20", "1")
    mavutil.set_dialect("ardupilotmega")


def dive(id, east, north, depth):
    return replace(move(id, "GoTo"), target=MoveTarget((east, north, LAKE.surface - depth)), speed=1.0)


def given(*moves, frame=LAKE):
    robot = robot_program("naiad", moves, home=HOME)
    return target_input(program(robot, frame=frame), [DIVER])


def rows(tmp_path, *moves, **options):
    """Return home and the waypoints of a list, as pymavlink reads them."""
    files = {file.path: file.content for file in render(WPL, given(*moves, **options))}
    (tmp_path / "naiad.waypoints").write_bytes(files["naiad.waypoints"])
    loader = mavwp.MAVWPLoader()
    loader.load(str(tmp_path / "naiad.waypoints"))
    return [loader.wp(index) for index in range(loader.count())]


def test_depths_are_negative_heights_above_a_home_at_the_surface(tmp_path):
    home, *items = rows(tmp_path, dive("a", 10.0, 0.0, 8.0), dive("b", 10.0, 10.0, 0.5))
    assert home.z == pytest.approx(372.0 - 3.0)
    assert [(item.z, item.frame) for item in items if item.command == 16] == [(-8.0, 3), (-0.5, 3)]


def test_a_place_at_the_surface_is_a_little_below_it(tmp_path):
    """ArduSub would stay at the depth where it is, were it 0."""
    _, *items = rows(tmp_path, dive("a", 10.0, 0.0, 8.0), dive("b", 10.0, 10.0, 0.0))
    assert [item.z for item in items if item.command == 16] == pytest.approx([-8.0, -0.01])


def test_a_hold_keeps_its_depth(tmp_path):
    _, *items = rows(tmp_path, dive("a", 10.0, 0.0, 8.0), move("h", "HoldPosition", duration=4.0))
    assert [(item.command, item.z) for item in items][-1] == (19, -8.0)


def test_there_is_no_item_that_an_underwater_vehicle_does_not_know(tmp_path):
    _, *items = rows(tmp_path, dive("a", 10.0, 0.0, 8.0), move("h", "HoldPosition", duration=4.0))
    assert {item.command for item in items} <= {16, 17, 19, 21, 93, 115, 178}


@pytest.mark.parametrize("target", [WPL, QGC_PLAN], ids=lambda target: target.name)
def test_what_is_above_the_surface_is_refused(target):
    with pytest.raises(UnsupportedError, match="move 'a': leads 2 m above the surface"):
        render(target, given(dive("a", 10.0, 0.0, -2.0)))


def test_nobody_needs_to_know_how_high_the_water_stands(tmp_path):
    unknown = replace(LAKE, altitude=None, altitude_reference="ORIGIN")
    home, *items = rows(tmp_path, dive("a", 10.0, 0.0, 8.0), frame=unknown)
    assert home.z == 0.0
    assert [item.z for item in items if item.command == 16] == [-8.0]


def test_a_plan_for_qgroundcontrol_is_for_a_submarine():
    files = {file.path: file.content for file in render(QGC_PLAN, given(dive("a", 10.0, 0.0, 8.0)))}
    mission = json.loads(files["naiad.plan"])["mission"]
    assert mission["vehicleType"] == 12
    assert mission["plannedHomePosition"][2] == pytest.approx(369.0)
    assert [item["Altitude"] for item in mission["items"] if item["command"] == 16] == [-8.0]
