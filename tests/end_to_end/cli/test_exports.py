"""``mmrs export``: what is asked for goes to the right file, and what is missing or lost is said."""

import json
import shutil

import pytest
from lxml import etree

from mmrs_core.resources import shipped


@pytest.fixture
def layers(mmrs):
    """Return a function: the layers of an export, by name, with the number of their features."""

    def export(*arguments):
        code, out, err = mmrs("export", *arguments, "--json")
        assert code == 0, err
        return json.loads(out)["layers"]

    return export


def test_a_behaviour_is_exported_beside_itself_once_and_again_only_by_force(mmrs, project):
    code, out, _ = mmrs("export", project, "--format", "geojson")
    file = project / "export.geojson"
    assert (code, out.startswith(f"written: {file} (areas 1, homes 2, ")) == (0, True)
    before = file.read_bytes()
    assert mmrs("export", project, "--format", "geojson")[0] == 2
    assert mmrs("export", project, "--format", "geojson", "--force")[0] == 0
    assert file.read_bytes() == before


def test_only_the_wanted_layers_are_written_in_the_format_of_the_suffix(layers, project, tmp_path):
    file = tmp_path / "paths.kml"
    assert layers(project / "behaviour.xmi", "-o", file, "--only", "paths", "--only", "homes") == {
        "homes": 2,
        "paths": 2,
    }
    assert etree.parse(file).getroot().tag.endswith("}kml")


def test_a_mission_without_a_behaviour_has_no_paths(layers, tmp_path):
    project = shutil.copytree(shipped("examples") / "outfall", tmp_path / "outfall")
    found = layers(project, "--format", "geojson")
    assert found.keys() == {"areas", "elements", "tasks", "homes"}


def test_logs_find_their_behaviour_or_ask_for_it(mmrs, layers, project, tmp_path):
    logs, far = project / "logs", tmp_path / "far" / "away"
    assert mmrs("simulate", project, "-o", logs)[0] == 0
    found = layers(logs, "--format", "geojson")
    assert found["tracks"] == found["paths"] == 2
    assert (logs / "export.geojson").exists()
    shutil.copytree(logs, far)
    code, _, err = mmrs("export", far, "--format", "geojson")
    assert (code, f"'mmrs export BEHAVIOUR --logs {far}'" in err) == (3, True)
    assert layers(project, "--logs", far, "--format", "geojson") == found


def test_times_are_of_day_with_a_start_and_else_that_is_said(mmrs, project):
    lost = mmrs("export", project, "--format", "kml")[2]
    assert "times since the start" in lost
    code, _, err = mmrs("export", project, "--format", "kml", "--force", "--start", "2026-05-01T11:00+02:00")
    assert (code, "times since" in err) == (0, False)
    assert "<when>2026-05-01T09:00:00.000Z</when>" in (project / "export.kml").read_text(encoding="utf-8")


@pytest.mark.parametrize("start", ["12:00", "2026-05-01T09:00", "tomorrow"])
def test_a_start_without_date_or_time_zone_is_refused(mmrs, project, start):
    assert mmrs("export", project, "--format", "kml", "--start", start)[0] == 2
    assert not (project / "export.kml").exists()


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--format", "shp"), "--format shp: unknown; known are: geojson, "),
        ((), "--format: missing"),
        (("-o", "map.txt"), "--format: missing"),
        (("--only", "roads"), "invalid value for '--only': 'roads' is not one of 'areas', "),
        (("-o", "map.kml", "--only", "tracks"), "--only tracks: needs the logs of a run; add --logs DIR"),
    ],
)
def test_what_there_is_not_is_refused_with_what_there_is(mmrs, project, arguments, reason):
    code, _, err = mmrs("export", project, *arguments)
    assert (code, reason in err) == (2, True)


def test_wanted_layers_need_the_mission_or_the_behaviour_that_has_them(mmrs, project, tmp_path):
    file = tmp_path / "map.kml"
    code, _, err = mmrs("export", project / "behaviour.xmi", "-o", file, "--only", "tasks")
    assert (code, "has no mission; export the project instead" in err) == (2, True)
    code, _, err = mmrs("export", shipped("examples") / "outfall", "-o", file, "--only", "paths")
    assert (code, "no behaviour.xmi in this folder" in err, file.exists()) == (3, True, False)


def test_paths_of_a_behaviour_alone_need_its_robot_types_and_homes_do_not(mmrs, layers, project, tmp_path):
    alone, file = shutil.copy(project / "behaviour.xmi", tmp_path), tmp_path / "map.kml"
    code, _, err = mmrs("export", alone, "-o", file)
    assert (code, file.exists()) == (1, False)
    assert "cannot be simulated without its robot types: '" in err
    assert "--robots gives their files, or put these into robots/ beside it" in err
    types = [part for each in (project / "robots").iterdir() for part in ("--robots", each)]
    assert layers(alone, "-o", file, *types)["paths"] == 2
    assert layers(alone, "-o", file, "--only", "homes", "--force") == {"homes": 2}


def test_a_local_mission_is_refused_with_what_it_lacks(mmrs, tmp_path):
    project = shutil.copytree(shipped("examples") / "pool", tmp_path / "pool")
    code, _, err = mmrs("export", project, "--format", "kml")
    assert (code, "give its origin, or the home of its first robot, a latitude and a longitude" in err) == (
        1,
        True,
    )
    assert not list(project.glob("export*"))


def test_what_was_read_is_not_overwritten(mmrs, project):
    file = project / "context.xmi"
    before = file.read_bytes()
    assert mmrs("export", project, "--format", "kml", "-o", file, "--force")[0] == 2
    assert file.read_bytes() == before


def test_the_behaviour_of_another_mission_is_left_out_and_that_is_said(mmrs, tmp_path):
    project = shutil.copytree(shipped("examples") / "outfall", tmp_path / "outfall")
    shutil.copytree(
        shipped("examples") / "handwritten",
        project,
        ignore=shutil.ignore_patterns("context.xmi"),
        dirs_exist_ok=True,
    )
    code, out, err = mmrs("export", project, "--format", "geojson")
    assert (code, "is of another mission" in err, "paths" in out) == (0, True, False)


def test_heights_above_the_origin_are_said_with_what_the_mission_lacks(mmrs, tmp_path):
    project = shutil.copytree(shipped("examples") / "outfall", tmp_path / "outfall")
    err = mmrs("export", project, "--format", "geojson")[2]
    assert (
        f"{project}: note: heights are above the origin; the mission does not give its geoidSeparation" in err
    )


def test_an_obstacle_stands_on_the_ground_in_kml(mmrs, project, tmp_path):
    file = tmp_path / "areas.kml"
    assert mmrs("export", project, "-o", file, "--only", "areas")[0] == 0
    assert [each.text for each in etree.parse(file).iterfind(".//{*}Polygon/{*}extrude")] == ["1"]
