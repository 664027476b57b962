"""Lists of waypoints, as pymavlink reads them: MAVProxy reads them with the same classes."""

import json
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input, two_drones
from pymavlink import mavutil, mavwp

from mmrs_core.behaviour.program import Transition
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.render import render
from mmrs_core.scene import Device, Frame
from mmrs_core.testing.programs import move, photo, program
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

FLIGHT = (
    take_off("up", 20.0),
    replace(go_to("a", (-40.0, 30.0, 25.5)), after=(photo(),)),
    go_to("b", (30.0, -30.0, 20.0), trajectory="VERTICAL_FIRST"),
    LAND,
)


@pytest.fixture(autouse=True)
def second_version_of_the_protocol(monkeypatch):
    """Fences and rally points are read only where pymavlink speaks MAVLink 2."""
    monkeypatch.setenv("MAVLINK20", "1")
    mavutil.set_dialect("ardupilotmega")


def texts(*moves, types=None, allow_lossy=False, **options):
    given = target_input(program(robot_program("alpha", moves), **options), types)
    files = render(WPL, given, allow_lossy=allow_lossy)
    return {file.path: file.content.decode("ascii") for file in files}


def loaded(loader, text, tmp_path):
    path = tmp_path / "list.waypoints"
    path.write_bytes(text.encode("ascii"))
    loader.load(str(path))
    return [loader.wp(index) for index in range(loader.count())]


def fields(item):
    params = (item.param1, item.param2, item.param3, item.param4)
    return (item.seq, item.frame, item.command, *params, item.x, item.y, item.z)


def test_pymavlink_reads_the_fence_and_the_rally_points_beside_the_mission(tmp_path):
    given = target_input(two_drones())
    plan = json.loads(render(QGC_PLAN, given, allow_lossy=True)[0].content)
    lists = {file.path: file.content.decode() for file in render(WPL, given, allow_lossy=True)}
    fence = loaded(mavwp.MissionItemProtocol_Fence(), lists["alpha.fence.waypoints"], tmp_path)
    ring = plan["geoFence"]["polygons"][0]["polygon"]
    assert [fields(item)[2:] for item in fence] == [(5002, len(ring), 0.0, 0.0, 0.0, *v, 0.0) for v in ring]
    rally = loaded(mavwp.MissionItemProtocol_Rally(), lists["alpha.rally.waypoints"], tmp_path)
    points = plan["rallyPoints"]["points"]
    assert [fields(item)[1:] for item in rally] == [(3, 5100, 0.0, 0.0, 0.0, 0.0, *p) for p in points]


def test_the_header_and_the_fields_are_exactly_those_of_the_format():
    header, *lines, last = texts(*FLIGHT)["alpha.waypoints"].split("\n")
    assert (header, last) == ("QGC WPL 110", "")
    assert {len(line.split("\t")) for line in lines} == {12}
    assert not any(" " in line for line in lines)
    assert [line.split("\t")[1] for line in lines] == ["1", *["0"] * (len(lines) - 1)]


def test_reals_have_eight_decimals():
    _, *lines, _ = texts(*FLIGHT)["alpha.waypoints"].split("\n")
    reals = [field for line in lines for field in line.split("\t")[4:11]]
    assert {len(real.partition(".")[2]) for real in reals} == {8}


def test_home_is_row_0_with_its_height_above_the_sea():
    row = texts(*FLIGHT)["alpha.waypoints"].split("\n")[1].split("\t")
    assert row[:4] == ["0", "1", "0", "16"]
    assert [float(field) for field in row[8:11]] == [42.37, 13.35, 720.0]


def test_every_line_is_traced_to_its_move():
    manifest = json.loads(texts(*FLIGHT)["wpl.manifest.json"])
    assert [(step["step"], step["move"], step["lines"]) for step in manifest["trace"]][:4] == [
        ("home", "", [2, 2]),
        ("item 1", "up", [3, 3]),
        ("item 2", "a", [4, 4]),
        ("item 3", "a", [5, 5]),
    ]


def test_a_second_sortie_is_a_second_list():
    files = texts(take_off("up", 20.0), LAND, move("charge", "Recharge", duration=9.0), *FLIGHT)
    assert {"alpha.waypoints", "alpha.sortie-2.waypoints"} <= set(files)


def test_without_areas_there_is_nothing_but_the_mission():
    given = replace(target_input(program(robot_program("alpha", FLIGHT))), areas=())
    assert [file.path for file in render(WPL, given)] == ["alpha.waypoints", "wpl.manifest.json"]


def test_what_a_list_cannot_say_is_refused():
    waiting = robot_program("alpha", FLIGHT, transitions={1: Transition(1, 2, waits=("go",))})
    with pytest.raises(UnsupportedError, match="waits for go"):
        render(WPL, target_input(program(waiting)))


def test_a_local_behaviour_is_refused_whatever_is_allowed():
    with pytest.raises(UnsupportedError, match="is local"):
        texts(*FLIGHT, frame=Frame("EPSG:4326", None, None), allow_lossy=True)


@pytest.mark.parametrize("number", ["nan", "inf"])
def test_a_wiring_without_a_finite_number_is_refused(number):
    camera = Device("camera", {}, {"mavlink.command.takePhoto": f"2000 0 {number}"})
    with pytest.raises(UnsupportedError, match="not a number of single precision"):
        texts(*FLIGHT, types=[replace(quad(), devices={"camera": camera})])
