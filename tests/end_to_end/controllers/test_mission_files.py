"""Missions in files against a peer that is not ours: MAVSDK imports them, and a vehicle keeps them."""

import json
import re
import subprocess
import sys
from array import array
from math import isnan
from pathlib import Path

import pytest
from mmrs_multicopter.testing import quad, target_input, two_drones
from peer_lines import said_in

from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.plugin.plans.wpl import WPL

pytestmark = pytest.mark.real_time("controllers")

IMPORTER = Path(__file__).parents[2] / "peers" / "mavsdk_import.py"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("missions")
    for target in (QGC_PLAN, WPL):
        write(render(target, target_input(two_drones()), allow_lossy=True), folder)
    return folder


@pytest.fixture(scope="module")
def imported(folder, new_hangar):
    """Return what MAVSDK made of each file, by the file's name."""
    paths = sorted([*folder.glob("*.plan"), folder / "alpha.waypoints", folder / "beta.waypoints"])
    with new_hangar() as switch_on:
        return handed_over(paths, switch_on(two_drones(), speedup=1.0)[1])


def handed_over(paths, links):
    """Return what MAVSDK made of each file, by the file's name, for the last of some vehicles."""
    port = re.search(r"127\.0\.0\.1:(\d+)", links[-1]).group(1)
    command = [sys.executable, str(IMPORTER), port, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    told = [said for line in done.stdout.splitlines() if (said := said_in(line)) is not None]
    return dict(zip([path.name for path in paths], told, strict=True))


def planned(folder, robot):
    """Return the items of a plan for QGroundControl as MAVSDK tells items."""
    plan = json.loads((folder / f"{robot}.plan").read_text("utf-8"))["mission"]
    items = [(each["command"], each["frame"], each["params"]) for each in plan["items"]]
    return [told(16, 5, [0.0, 0.0, 0.0, 0.0, *plan["plannedHomePosition"]]), *(told(*item) for item in items)]


def told(command, frame, params):
    """Return an item as MAVSDK tells it, which keeps parameters in single precision."""
    x, y, z = params[4:]
    single = array("f", params[:4]).tolist()
    return [command, frame, round(x * 1e7), round(y * 1e7), z, 0, *single]


@pytest.mark.parametrize("robot", ["alpha", "beta"])
def test_mavsdk_imports_each_item_of_a_plan_as_it_stands_there(folder, imported, robot):
    assert imported[f"{robot}.plan"]["mission"] == planned(folder, robot)


@pytest.mark.parametrize("robot", ["alpha", "beta"])
def test_mavsdk_imports_each_item_of_a_list_as_it_stands_in_the_plan(folder, imported, robot):
    """MAVSDK puts a home before what it reads, also where row 0 is one: the row comes as item 1."""
    first, row, *items = imported[f"{robot}.waypoints"]["mission"]
    home, *expected = planned(folder, robot)
    assert first[0] == row[0] == 16
    assert row[2:5] == home[2:5]
    assert items == expected


@pytest.mark.parametrize("robot", ["alpha", "beta"])
def test_mavsdk_finds_fence_and_rally_point_in_a_plan_and_none_in_a_list(imported, robot):
    plan, listed = imported[f"{robot}.plan"], imported[f"{robot}.waypoints"]
    assert [item[0] for item in plan["fence"]] == [5002] * 8
    assert [item[0] for item in plan["rally"]] == [5100]
    assert (listed["fence"], listed["rally"]) == ([], [])


@pytest.mark.parametrize("name", ["alpha.plan", "beta.plan", "alpha.waypoints", "beta.waypoints"])
def test_a_vehicle_gives_back_the_mission_that_mavsdk_has_uploaded(imported, name):
    """All but home, which is the vehicle's own, and frames of what has no place, which it does not keep."""
    (_, *kept), (_, *sent) = (imported[name][what] for what in ("downloaded", "mission"))
    assert [[item[0], *item[2:5]] for item in kept] == [[item[0], *item[2:5]] for item in sent]
    assert {item[1] for item in kept} <= {0, 3}


def test_mavsdk_hands_what_is_left_to_a_px4_over_as_no_number(tmp_path, hangar):
    given = target_input(two_drones(), [quad(**{"mavlink.autopilot": "px4"})])
    write(render(QGC_PLAN, given, allow_lossy=True), tmp_path)
    path = tmp_path / "alpha.plan"
    headings = [item["params"][3] for item in json.loads(path.read_text("utf-8"))["mission"]["items"]]
    assert None in headings
    found = handed_over([path], hangar(two_drones(), speedup=1.0, firmware="px4")[1])["alpha.plan"]
    for items in (found["mission"], found["downloaded"]):
        told = [item[9] for item in items[len(items) - len(headings) :]]
        assert [isnan(each) for each in told] == [each is None for each in headings]
