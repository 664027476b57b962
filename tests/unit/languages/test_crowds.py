"""Missions that hold more than can be worked through are refused before anything is compared."""

import pytest

from mmrs_core.languages import modelset
from mmrs_core.languages.modelset import read_project

MISSION = """<m:Mission xmlns:m="urn:mmrs:mission:1.0"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" name="m">
{}</m:Mission>"""
FORK = '<tasks xsi:type="m:Fork" name="f{}"/>'


@pytest.fixture
def faults_of(tmp_path, everything):
    def found(count):
        tasks = "".join(map(FORK.format, range(count)))
        (tmp_path / "mission.xmi").write_text(MISSION.format(tasks))
        return read_project(tmp_path, registry=everything)

    return found


def test_as_many_tasks_as_may_be_are_read(faults_of, monkeypatch):
    monkeypatch.setattr(modelset, "MOST_PARTS", 5)
    models, faults = faults_of(5)
    assert models is not None
    assert faults == ()


def test_more_tasks_than_can_be_worked_through_are_refused_at_their_place(faults_of, monkeypatch):
    monkeypatch.setattr(modelset, "MOST_PARTS", 5)
    models, faults = faults_of(6)
    assert models is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("FIL006", 1)]
    assert "holds 6 tasks" in faults[0].message
