"""The models that the authors of FLYAQ published in 2015.

They have no licence, so they are not part of this project; ``MMRS_FLYAQ_2015`` names the folder they lie in.
"""

import os
from pathlib import Path

import pytest

NAMED = os.environ.get("MMRS_FLYAQ_2015", "")
FOLDER = Path(NAMED)
PARROT = FOLDER / "drone-parrot-sample.xmi"

pytestmark = pytest.mark.skipif(not NAMED, reason="MMRS_FLYAQ_2015 names no folder with the models of 2015")


@pytest.fixture
def project(tmp_path):
    return tmp_path / "project"


@pytest.mark.parametrize(
    "files",
    [
        ("behaviour-example.xmi",),
        ("behaviour-example.json",),
        ("behaviour-old-multidrone.json",),
        ("context-demo.json",),
        ("mission-demo.json", PARROT.name),
        ("drone-parrot-sample.xmi",),
        ("drones-list-demo.json",),
    ],
    ids="".join,
)
def test_a_model_of_2015_migrates_to_a_valid_one(mmrs, project, files):
    code, out, _ = mmrs("migrate", *(FOLDER / file for file in files), "-o", project)
    assert code == 0
    assert out.endswith(": valid\n")


def test_the_mission_of_2015_is_refused_by_the_planner_for_its_millions_of_photos(mmrs, project):
    _, _, err = mmrs("migrate", FOLDER / "mission-demo.json", PARROT, "-o", project)
    assert "warning: task 'photoGridTask1' takes about 58,539,226 photos [SUR019]" in err
    code, _, err = mmrs("plan", project)
    assert code == 4
    assert "photos or samples, of which 200,000 can be planned" in err


def test_all_files_of_2015_are_called_what_they_are(mmrs, project):
    files = sorted(file for file in FOLDER.iterdir() if file.suffix in (".xmi", ".json", ".ecore"))
    _, out, _ = mmrs("migrate", *files, "-o", project)
    told = [line for line in out.splitlines() if line.startswith(str(FOLDER))]
    assert len(files) == 17
    assert sum(": a metamodel, http://" in line for line in told) == 7
    assert sum(": a palette of the 2015 editor" in line for line in told) == 2
    assert sum(": a list of task extensions" in line for line in told) == 1
    assert sum(": a list of robot types" in line for line in told) == 1
    assert sum(": a model" in line for line in told) == 6


def test_xmi_and_json_of_the_behaviour_of_2015_become_the_same(mmrs, tmp_path):
    for suffix in ("xmi", "json"):
        assert mmrs("migrate", FOLDER / f"behaviour-example.{suffix}", "-o", tmp_path / suffix)[0] == 0
    assert (tmp_path / "xmi" / "behaviour.xmi").read_bytes() == (
        tmp_path / "json" / "behaviour.xmi"
    ).read_bytes()


def test_the_behaviour_of_2015_is_simulated_checked_and_generated(mmrs, project, tmp_path):
    assert mmrs("migrate", FOLDER / "behaviour-example.xmi", PARROT, "-o", project)[0] == 0
    code, out, _ = mmrs("simulate", project)
    assert code == 0
    assert out.startswith("success")
    assert mmrs("check", project)[0] == 0
    code, out, _ = mmrs(project, "--target", "mavlink-python", "-o", tmp_path / "code", program="mmrs-gen")
    assert code == 0
    assert (tmp_path / "code" / "robot_Parrot1.py").is_file()
