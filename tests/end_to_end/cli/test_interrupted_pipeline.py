"""A pipeline under an obstacle is followed around it; validating and planning name the same stretch."""

import re
import shutil

import pytest

from mmrs_core.resources import shipped

BUOY = """<obstacles name="buoy" safetyDistance="1.0">
    <shell xsi:type="mission:RelativeCoordinate" x="160.0" y="50.0"/>
    <shell xsi:type="mission:RelativeCoordinate" x="163.0" y="50.0"/>
    <shell xsi:type="mission:RelativeCoordinate" x="163.0" y="53.0"/>
    <shell xsi:type="mission:RelativeCoordinate" x="160.0" y="53.0"/>
  </obstacles>
  <elements """


@pytest.fixture
def bay(tmp_path):
    """Return a mission along a pipeline, a part of whose way is too near to a buoy."""
    project = shutil.copytree(shipped("examples") / "outfall", tmp_path / "bay")
    context = (project / "context.xmi").read_text(encoding="utf-8").replace("<elements ", BUOY, 1)
    (project / "context.xmi").write_text(context, encoding="utf-8")
    return project


def test_what_is_left_out_of_a_pipeline_is_said_alike_before_and_after_planning(mmrs, bay):
    code, out, err = mmrs("validate", bay)
    assert code == 0
    said = r"'pipe': ([\d.]+) of the [\d.]+ m of its pipeline are too near to Obstacle 'buoy' for every robot"
    length, begin = re.search(rf"{said}, from ([\d.]+) m on", out + err).groups()
    code, out, _ = mmrs("plan", bay)
    assert code == 0
    assert f"task 'pipe' leaves out {length} m from {begin} m along the pipeline" in out
