"""A robot whose kind's plug-in is missing, and what ``mmrs diff`` says of what it cannot understand."""

import shutil

import pytest

from mmrs_core.resources import shipped

TRACTOR = """<?xml version="1.0" encoding="UTF-8"?>
<farm:Tractor xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:farm="urn:test:farm:1.0"
    name="Tractor" axles="2" plough="{plough}">
  <wheel radius="0.8"/>
</farm:Tractor>
"""


@pytest.fixture
def farm(tmp_path, monkeypatch):
    """Return the pool's project, one of whose robots is of a kind that nobody brings."""
    monkeypatch.chdir(tmp_path)
    folder = shutil.copytree(shipped("examples") / "pool", tmp_path / "farm")
    mission = folder / "mission.xmi"
    mission.write_text(mission.read_text().replace('type="Pool AUV"', 'type="Tractor"', 1))
    assert 'type="Tractor"' in mission.read_text()
    (folder / "robots" / "tractor.xmi").write_text(TRACTOR.format(plough="a reversible one with four bodies"))
    return "farm"


def test_a_type_that_is_there_but_not_understood_is_told_as_such(farm, mmrs):
    code, _, err = mmrs("validate", farm)
    assert code == 1
    assert (
        "its type 'Tractor' stands in farm/robots/tractor.xmi:2, in a language that is not installed [MML004]"
        in err
    )
    assert "hint: install the plug-in that provides urn:test:farm:1.0\n" in err
    assert "is not known [MML004]" not in err


def test_of_what_is_not_understood_the_part_that_differs_is_told(farm, mmrs, tmp_path):
    other = tmp_path / "other.xmi"
    other.write_text(TRACTOR.format(plough="a reversible one with five bodies"))
    code, out, _ = mmrs("diff", "farm/robots/tractor.xmi", other)
    assert code == 1
    assert "    content: '…ible one with four bodies\">" in out
    assert "→ '…ible one with five bodies\">" in out


def test_how_what_is_not_understood_is_laid_out_is_no_difference(farm, mmrs, tmp_path):
    text = TRACTOR.format(plough="none")
    (tmp_path / "one.xmi").write_text(text)
    (tmp_path / "other.xmi").write_text(text.replace(' axles="2"', '\n    axles="2"').replace("/>", " />"))
    assert mmrs("diff", "one.xmi", "other.xmi")[:2] == (0, "the models say the same\n")
