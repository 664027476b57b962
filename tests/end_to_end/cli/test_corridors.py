"""Corridors come from drawings into contexts, are planned through, verified, drawn and exported again."""

import json
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
