"""What bars some robots only is known wherever a behaviour is read with its place."""

import json
import shutil

import pytest

from mmrs_core.resources import shipped


@pytest.fixture
def yard(mmrs, tmp_path):
    """Return a project with a planned behaviour of a drone and a rover."""
    folder = shutil.copytree(shipped("examples") / "drone-and-rover", tmp_path / "yard")
    assert mmrs("plan", folder)[0] == 0
    return folder


def deepen(yard):
    """Fill the puddle on the rover's way."""
    context = yard / "context.xmi"
    text = context.read_text(encoding="utf-8")
    context.write_text(text.replace('waterDepth="0.1"', 'waterDepth="0.3"'), encoding="utf-8")


def test_a_check_finds_that_water_has_risen_on_the_rovers_way_and_not_under_the_drone(mmrs, yard):
    assert mmrs("check", yard / "behaviour.xmi")[0] == 0
    deepen(yard)
    code, out, _ = mmrs("check", yard / "behaviour.xmi", "--json")
    violated = [each for each in json.loads(out)["verdicts"] if each["status"] == "violated"]
    assert code == 1
    assert {(each["property"], each["robot"], each["area"]) for each in violated} == {
        ("clearance", "Badger", "puddle")
    }
    arguments = ("--target", "qgc-plan", "-o", yard / "plans", "--allow-lossy")
    code, _, err = mmrs("generate", yard / "behaviour.xmi", *arguments)
    assert code == 1
    assert "puddle" in err


def test_only_the_rover_is_fenced_out_of_the_water_and_off_the_slope(mmrs, yard):
    mmrs("generate", yard / "behaviour.xmi", "--target", "qgc-plan", "-o", yard / "plans", "--allow-lossy")
    fences = {
        path.stem: len(json.loads(path.read_text(encoding="utf-8"))["geoFence"]["polygons"])
        for path in (yard / "plans").glob("*.plan")
    }
    assert fences["Badger"] == 2
    assert fences["Kestrel"] == 0
