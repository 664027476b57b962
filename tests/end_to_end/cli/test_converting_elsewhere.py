"""What is converted into another folder can be read there."""

import shutil

import pytest

from mmrs_core.resources import shipped


@pytest.fixture
def park(tmp_path, monkeypatch):
    """Return the solar park, whose mission refers to panel groups of its context."""
    monkeypatch.chdir(tmp_path)
    return shutil.copytree(shipped("examples") / "solar-park", "park")


def test_a_model_is_not_written_where_its_references_would_not_be_followed(park, mmrs, tmp_path):
    (tmp_path / "far").mkdir()
    code, _, err = mmrs("convert", "park/mission.xmi", "far/mission.json")
    assert code == 1
    assert "far/mission.json: would refer to park/context.xmi, outside its folder" in err
    assert "mmrs convert park/mission.xmi park/context.xmi -o far\n" in err
    assert not list((tmp_path / "far").iterdir())


def test_beside_its_source_it_is_written_and_comes_back(park, mmrs):
    assert mmrs("convert", "park/mission.xmi", "park/copy.json")[0] == 0
    assert mmrs("convert", "park/copy.json", "park/copy.xmi")[0] == 0
    assert mmrs("diff", "park/mission.xmi", "park/copy.xmi")[:2] == (0, "the models say the same\n")


def test_together_models_go_elsewhere_and_come_back(park, mmrs):
    assert mmrs("convert", "park", "-o", "far")[0] == 0
    assert mmrs("convert", "far", "-o", "back")[0] == 0
    assert mmrs("diff", "park", "back")[:2] == (0, "the models say the same\n")


def test_a_reference_that_only_eclipse_follows_is_told(park, mmrs):
    code, _, err = mmrs("convert", "park/mission.xmi", "-o", "far")
    assert code == 0
    assert "references lead to where it is, outside far: only Eclipse follows them there" in err
