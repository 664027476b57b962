"""Drawings of a farm become projects that are valid and planned."""

import json
import shutil
from pathlib import Path

import pytest

from mmrs_core.cli import run

DRAWINGS = Path(__file__).parents[2] / "fixtures" / "drawings"
KITE = ("--robot", "Kite=Freefly Astro LR1")
FARM = {
    "farm.kml": (
        (),
        {
            "North field": "PhotoGridTask",
            "South field": "PhotoGridTask",
            "Neighbour's stable": "forbidden area",
            "Home": "home",
            "Water trough": "ObserveTask",
            "Obstacle: silo": "obstacle",
            "Rally meadow": "emergency area",
            "East fence": "RoadTask",
        },
    ),
    "farm.plan": (
        (),
        {
            "survey 1": "PhotoGridTask",
            "fence circle 1": "forbidden area",
            "rally point 1": "emergency area",
            "planned home": "home",
        },
    ),
    "farm.geojson": (
        ("--as", "power line=obstacle:radius=6"),
        {
            "orchard": "PhotoGridTask",
            "obstacle mast": "obstacle",
            "power line": "obstacle",
            "home": "home",
            "deep well": "ObserveTask",
        },
    ),
}


@pytest.fixture
def drawing(request, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(DRAWINGS / request.param, tmp_path)
    return request.param


def told(capsys):
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("drawing", FARM, indirect=True)
def test_a_drawing_becomes_a_project_that_is_valid_and_planned(drawing, capsys):
    options, expected = FARM[drawing]
    assert run(["import", drawing, "-o", "farm", *KITE, *options, "--json"]) == 0
    result = told(capsys)
    assert {each["name"]: each["became"] for each in result["features"] if each["became"]} == expected
    assert all(each["became"] or each["left_because"] for each in result["features"])
    assert sorted(result["files"]) == [
        "farm/context.xmi",
        "farm/mission.xmi",
        "farm/robots/freefly-astro-lr1.xmi",
    ]
    mission = Path("farm/mission.xmi").read_text()
    assert f"imported from {drawing}." in mission
    assert "minimumSeparation=" in mission
    assert '<policies response="RETURN" after="10.0"/>' in mission
    assert run(["validate", "farm"]) == 0
    assert run(["plan", "farm"]) == 0
    assert Path("farm/behaviour.xmi").is_file()


@pytest.mark.parametrize("drawing", ["farm.kml"], indirect=True)
def test_a_drawing_that_is_imported_again_adds_what_is_new(drawing, capsys):
    assert run(["import", drawing, "-o", "farm", *KITE]) == 0
    before = {file: file.read_bytes() for file in Path("farm").rglob("*.xmi")}
    capsys.readouterr()
    assert run(["import", drawing, "--into", "farm"]) == 0
    out = capsys.readouterr().out
    assert out.count("the same is there already") == 7
    assert "it is the home of Kite already" in out
    assert out.endswith("nothing written\n")
    text = (
        Path(drawing)
        .read_text()
        .replace(
            "</Document>",
            "<Placemark><name>Gate</name><Point><coordinates>11.34,44.4935</coordinates></Point></Placemark></Document>",
        )
    )
    Path(drawing).write_text(text)
    assert run(["import", drawing, "--into", "farm"]) == 0
    changed = [file.name for file, data in before.items() if file.read_bytes() != data]
    assert changed == ["mission.xmi"]
    assert run(["validate", "farm"]) == 0


@pytest.mark.parametrize("drawing", ["farm.kml"], indirect=True)
def test_without_robots_the_report_comes_with_what_is_missing(drawing, capsys):
    assert run(["import", drawing, "--dry-run"]) == 0
    assert run(["import", drawing, "-o", "farm"]) == 2
    printed = capsys.readouterr()
    assert printed.out.count("Water trough") == 2
    assert "no robots: a mission needs a team; --robot NAME=TYPE@HOME adds one" in printed.err
    assert "points for homes: Home, Water trough, Rally meadow" in printed.err
    assert not Path("farm").exists()


@pytest.mark.parametrize("drawing", ["farm.kml"], indirect=True)
def test_a_refused_import_reports_its_features_too(drawing, capsys):
    for options in ((), (*KITE, "--as", "Water trough=obstacle")):
        assert run(["import", drawing, "-o", "farm", *options, "--json"]) == 2
        result = told(capsys)
        assert result["error"]["message"]
        assert "Water trough" in {each["name"] for each in result["features"]}
        assert (result["written"], Path("farm").exists()) == (False, False)


def test_many_that_are_the_same_have_one_line_and_json_has_every_one(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    point = (
        '{{"type": "Feature", "properties": {{"name": "{}", "mmrs:role": "photo", "mmrs:folders": "{}"}}, '
    )
    point += '"geometry": {{"type": "Point", "coordinates": [11.34, 44.5]}}}}'
    names = [(f"Kite {number}", "flown/photos") for number in range(10)] + [("Kite", "odd")]
    features = ",\n".join(point.format(*each) for each in names)
    Path("f.geojson").write_text(f'{{"type": "FeatureCollection", "features": [\n{features}]}}')
    assert run(["import", "f.geojson", "--dry-run"]) == 0
    lines = [line.split("  ") for line in capsys.readouterr().out.splitlines()]
    assert [[cell.strip() for cell in line if cell] for line in lines[1:3]] == [
        [
            "(left out)",
            "f.geojson:2-11",
            "10 points of 'photos': Kite 0 … Kite 9",
            "it is a photo that was taken; --as 'flown/photos/*'=task makes a task of it",
        ],
        [
            "(left out)",
            "f.geojson:12",
            "Kite",
            "it is a photo that was taken; --as 'odd/Kite'=task makes a task of it",
        ],
    ]
    assert run(["import", "f.geojson", "--dry-run", "--json"]) == 0
    assert [each["name"] for each in told(capsys)["features"]] == [name for name, _ in names]


def test_a_drawing_without_tasks_says_what_to_do(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("trees.csv").write_text("lat,lon,name,radius\n44.5,11.34,obstacle,3\n")
    assert run(["import", "trees.csv", "-o", "farm", "--robot=K=Freefly Astro LR1@44.5,11.35"]) == 1
    words = "no feature becomes a task; --as NAME=task makes one, --into adds to a project with tasks"
    assert words in capsys.readouterr().err
    assert not Path("farm").exists()
