"""Corridors come from drawings into contexts, are planned through, verified, drawn and exported again."""

import json
import re
import shutil

import pytest

from mmrs_core.resources import shipped

NAME = "lane above the road"
LANE = {
    "type": "Feature",
    "properties": {"name": NAME},
    "geometry": {"type": "LineString", "coordinates": [[13.35035, 42.37005], [13.351, 42.37012]]},
}


@pytest.fixture
def fields(mmrs, tmp_path):
    """Return a project with a corridor that was drawn: that of the page on corridors, planned only once."""
    project = shutil.copytree(shipped("examples") / "carbon-dioxide", tmp_path / "fields")
    drawing = tmp_path / "lane.geojson"
    drawing.write_text(json.dumps({"type": "FeatureCollection", "features": [LANE]}))
    options = "lane*=Corridor:width=14,minHeight=30,maxHeight=60"
    code, _, err = mmrs("import", drawing, "--into", project, "--as", options)
    assert code == 0, err
    return project


def test_a_corridor_is_planned_through_verified_and_drawn(mmrs, fields, tmp_path):
    assert mmrs("plan", fields)[0] == 0
    code, out, _ = mmrs("check", fields, "--json")
    found = {each["property"]: each for each in json.loads(out)["verdicts"] if each["robot"] == "Alba"}
    assert (code, found["corridors"]["status"]) == (0, "safe")
    assert f"leads through '{NAME}'" in found["corridors"]["message"]
    assert mmrs("preview", fields, "-o", tmp_path / "seen")[0] == 0
    assert f"{NAME}: corridor, width 14" in (tmp_path / "seen" / "preview.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("form", ["geojson", "kml"])
def test_an_exported_corridor_is_imported_as_it_was(mmrs, fields, tmp_path, form):
    assert mmrs("export", fields, "--format", form, "--only", "elements")[0] == 0
    other = shutil.copytree(shipped("examples") / "carbon-dioxide", tmp_path / "other")
    code, _, err = mmrs("import", fields / f"export.{form}", "--into", other)
    assert code == 0, err
    before, after = ((each / "context.xmi").read_text().split("<corridors ")[1] for each in (fields, other))
    assert before == after


def test_a_corridor_without_a_width_is_refused(mmrs, tmp_path):
    project = shutil.copytree(shipped("examples") / "carbon-dioxide", tmp_path / "fields")
    drawing = tmp_path / "lane.geojson"
    drawing.write_text(json.dumps({"type": "FeatureCollection", "features": [LANE]}))
    code, _, err = mmrs("import", drawing, "--into", project, "--as", "lane*=Corridor")
    assert (code, f"width of Corridor '{NAME}' is 0, but must be more than 0 [CTX018]" in err) == (1, True)


MISSION = """<?xml version="1.0" encoding="UTF-8"?>
<mission:Mission xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" name="Fire" minimumSeparation="5.0"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:mission="urn:mmrs:mission:1.0"
    xmlns:survey="urn:mmrs:survey:1.0">
  <team>
    <robots name="Alba" type="Quad 650"><home xsi:type="mission:RelativeCoordinate" x="-10" y="0"/></robots>
    <robots name="Brezza" type="Quad 650"><home xsi:type="mission:RelativeCoordinate" x="10" y="0"/></robots>
  </team>
  TASKS
</mission:Mission>
"""
TASK = """<tasks xsi:type="survey:GoToTask" name="NAME">
    <point xsi:type="mission:RelativeCoordinate" x="EAST" y="NORTH" z="20"/>
  </tasks>"""
CONTEXT = """<?xml version="1.0" encoding="UTF-8"?>
<context:Context xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" name="Valley"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:mission="urn:mmrs:mission:1.0"
    xmlns:context="urn:mmrs:context:1.0">
  <corridors name="lane" width="10" minHeight="18" maxHeight="22">
    <points xsi:type="mission:RelativeCoordinate" x="0" y="50"/>
    <points xsi:type="mission:RelativeCoordinate" x="0" y="150"/>
  </corridors>
</context:Context>
"""


def test_drones_that_share_a_corridor_signal_to_each_other_and_are_verified_to_keep_apart(mmrs, tmp_path):
    project = tmp_path / "fire"
    shutil.copytree(shipped("examples") / "carbon-dioxide" / "robots", project / "robots")
    places = {"west": (-100, 400), "far west": (-300, 1200), "east": (100, 400), "far east": (300, 1200)}
    tasks = [
        TASK.replace("NAME", name).replace("EAST", str(east)).replace("NORTH", str(north))
        for name, (east, north) in places.items()
    ]
    (project / "mission.xmi").write_text(MISSION.replace("TASKS", "".join(tasks)), encoding="utf-8")
    (project / "context.xmi").write_text(CONTEXT, encoding="utf-8")
    code, out, _ = mmrs("plan", project, "--json")
    assert code == 0
    assert json.loads(out)["makespan"] < 450.0
    signals = re.findall(
        r'"(Alba|Brezza) clear of (Alba|Brezza)', (project / "behaviour.xmi").read_text("utf-8")
    )
    assert set(signals) & {("Alba", "Brezza"), ("Brezza", "Alba")}
    code, out, _ = mmrs("check", project, "--json")
    found = {each["property"]: each["status"] for each in json.loads(out)["verdicts"]}
    assert code == 0
    assert {found[name] for name in ("separation", "synchronisation", "corridors")} == {"safe"}
