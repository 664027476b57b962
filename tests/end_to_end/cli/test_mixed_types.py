"""Drones of two types share one area, and what they are planned to do is safe."""

import json
import shutil

import pytest
from lxml import etree

from mmrs_core.resources import shipped


@pytest.fixture
def meadow(tmp_path):
    """Return a mission in which a wide, slow drone has to share a meadow with one of another type."""
    project = shutil.copytree(shipped("examples") / "carbon-dioxide", tmp_path / "meadow")
    tree = etree.parse(project / "mission.xmi")
    mission = tree.getroot()
    for each in (*mission.iterfind("tasks"), *mission.iterfind("taskDependencies")):
        if each.get("name") == "north meadow":
            each.set("robotsWanted", "2")
        else:
            mission.remove(each)
    first, second, _ = mission.iterfind("team/robots")
    first.getparent().remove(second)
    mission.find("team/robots[last()]").set("type", "Wide")
    tree.write(project / "mission.xmi")
    drone = (project / "robots" / "quad-650.xmi").read_text(encoding="utf-8")
    wide = drone.replace('name="Quad 650"', 'name="Wide"').replace('width="0.65"', 'width="1.9"')
    wide = wide.replace('max="12.0"', 'max="7.0"').replace('max="10.0"', 'max="6.0"')
    (project / "robots" / "wide.xmi").write_text(wide, encoding="utf-8")
    return project


def test_drones_of_two_types_share_an_area_and_are_safe(mmrs, meadow):
    code, out, err = mmrs("plan", meadow, "--json")
    assert (code, err) == (0, "")
    robots = json.loads(out)["robots"]
    assert [each["tasks"] for each in robots] == [["north meadow"], ["north meadow"]]
    code, out, err = mmrs("check", meadow)
    assert (code, err) == (0, "")
    assert ": safe" in out.splitlines()[-1]
