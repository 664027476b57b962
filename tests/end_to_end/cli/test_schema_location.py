"""Models that name their metamodels, so that Eclipse opens them without any registration."""

import shutil

import pytest

from mmrs_core.languages.schema_location import stated_places
from mmrs_core.resources import shipped


@pytest.fixture
def mission(tmp_path):
    return shutil.copytree(shipped("examples") / "drone-and-rover", tmp_path / "mission")


def test_a_planned_behaviour_names_its_metamodels_where_they_lie(mmrs, mission, tmp_path):
    assert mmrs("metamodel", "export", tmp_path / "all languages")[0] == 0
    assert mmrs("plan", mission, "--schema-location", tmp_path / "all languages")[0] == 0
    places = stated_places(mission / "behaviour.xmi")
    assert places["urn:mmrs:behaviour:1.0"] == "../all%20languages/behaviour.ecore"


def test_a_folder_without_metamodels_is_told_before_anything_is_planned(mmrs, mission, tmp_path):
    code, out, err = mmrs("plan", mission, "--schema-location", tmp_path)
    assert (code, out) == (3, "")
    assert "no robot.ecore in this folder; 'mmrs metamodel export" in err
    assert not (mission / "behaviour.xmi").exists()
