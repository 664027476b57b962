"""The models that the authors of FLYAQ published in 2015.

They have no licence, so they are not part of this project; ``MMRS_FLYAQ_2015`` names the folder they lie in.
"""

import json
import os
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from shapely.geometry import Point, Polygon
from source_values import missing

from mmrs_core.languages.reading import read_model

NAMED = os.environ.get("MMRS_FLYAQ_2015", "")
FOLDER = Path(NAMED)
MODELS = (
    "behaviour-example.xmi",
    "behaviour-example.json",
    "behaviour-old-multidrone.json",
    "context-demo.json",
    "mission-demo.json",
    "drones-list-demo.json",
)
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
        ("drone-parrot-sample.xmi",),
        ("drones-list-demo.json",),
    ],
    ids="".join,
)
def test_a_model_of_2015_migrates_to_a_valid_one(mmrs, project, files):
    code, out, _ = mmrs("migrate", *(FOLDER / file for file in files), "-o", project)
    assert code == 0
    assert re.search(r": valid(, with no mission beside it yet)?\n$", out)


@pytest.mark.parametrize(
    ("files", "code"), [(("context-demo.json",), "CTX008"), (("mission-demo.json", PARROT.name), "MML028")]
)
def test_what_is_wrong_with_the_nonsense_places_of_2015_is_how_far_they_lie_apart(mmrs, project, files, code):
    exit_code, _, err = mmrs("migrate", *(FOLDER / file for file in files), "-o", project)
    errors = [line for line in err.splitlines() if ": error: " in line]
    assert exit_code == 1
    assert errors
    assert [line for line in errors if not line.endswith(f"[{code}]")] == []


def test_the_mission_of_2015_is_refused_by_the_planner_for_its_millions_of_photos(mmrs, project):
    _, _, err = mmrs("migrate", FOLDER / "mission-demo.json", PARROT, "-o", project)
    assert "warning: task 'photoGridTask1' takes about 58,539,226 photos [SUR019]" in err
    mission = project / "mission.xmi"
    mission.write_text(
        mission.read_text().replace(' name="mission1"', ' name="mission1" largestGap="1e8"', 1)
    )
    code, _, err = mmrs("plan", project)
    assert code == 4
    assert "photos or samples, of which 200,000 can be planned" in err


@pytest.mark.parametrize("name", [*MODELS, PARROT.name], ids="".join)
def test_no_value_of_2015_is_dropped_silently(mmrs, contributions, project, name):
    told = json.loads(mmrs("migrate", FOLDER / name, "-o", project, "--json")[1])
    models = [read_model(file, contributions.languages) for file in project.rglob("*.xmi")]
    made = [root for model in models for root in model.roots]
    assert missing(FOLDER / name, made, [finding["subject"] for finding in told["findings"]]) == []


def test_a_behaviour_of_2015_is_read_by_the_metamodel_that_it_names(mmrs, project):
    for name in ("behaviour-example.json", "behaviour-old-multidrone.json"):
        _, out, _ = mmrs("migrate", FOLDER / name, "-o", project / name)
        assert out.startswith(f"{FOLDER / name}: a model (by {FOLDER / 'behaviour.ecore'})\n")


def test_every_vertex_of_2015_lies_in_the_border_that_is_made_of_it(mmrs, project):
    mmrs("migrate", FOLDER / "context-demo.json", "-o", project)
    source = json.loads((FOLDER / "context-demo.json").read_text())
    made = ElementTree.parse(project / "context.xmi").getroot()
    for kind, old in (("forbiddenAreas", "noFlyAreas"), ("obstacles", "obstacles")):
        for area, drawn in zip(source[old], made.findall(kind), strict=True):
            ring = Polygon([(float(each.get("latitude")), float(each.get("longitude"))) for each in drawn])
            for vertex in area["shell"]:
                assert ring.covers(Point(vertex["latitude"], vertex["longitude"])), area["name"]


def test_all_files_of_2015_are_called_what_they_are(mmrs, project):
    files = sorted(file for file in FOLDER.iterdir() if file.suffix in (".xmi", ".json", ".ecore"))
    _, out, _ = mmrs("migrate", *files, "-o", project)
    told = [line for line in out.splitlines() if line.startswith(str(FOLDER))]
    assert len(files) == 17
    assert [file.name for file in (project / "robots").iterdir()] == ["ParrotSample.xmi"]
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


@pytest.mark.parametrize("name", ["behaviour-example.xmi", "behaviour-example.json"])
def test_a_behaviour_of_2015_is_simulated_and_generated_as_it_is(mmrs, tmp_path, name):
    before = {file: file.read_bytes() for file in FOLDER.iterdir()}
    code, out, err = mmrs("simulate", FOLDER / name, "--robots", PARROT)
    assert (code, out.partition(" ")[0]) == (0, "success")
    assert f"{FOLDER / name}:" in err
    arguments = (FOLDER / name, "--robots", PARROT, "--target", "mavlink-python", "-o", tmp_path / "code")
    code, _, _ = mmrs(*arguments, "--quiet-migration", program="mmrs-gen")
    assert code == 0
    assert (tmp_path / "code" / "robot_Parrot1.py").is_file()
    assert {file: file.read_bytes() for file in FOLDER.iterdir()} == before


@pytest.mark.parametrize("name", [*MODELS, PARROT.name])
def test_every_model_of_2015_is_shown_as_it_is(mmrs, name):
    code, out, err = mmrs("show", FOLDER / name)
    assert code == 0
    assert out.partition(" ")[0] in ("Behaviour", "Context", "Drone", "Mission")
    assert "a model of FLYAQ 2015" in err or "a list of robot types of FLYAQ 2015" in err
