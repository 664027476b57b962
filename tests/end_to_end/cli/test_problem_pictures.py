"""A mission that is not valid, or has no plan, is drawn with its problems at their positions."""

import json
import re
import shutil
from html import unescape

import pytest
from lxml import etree

from mmrs_core.cli import run
from mmrs_core.cli.examples import example_folder
from mmrs_core.pictures.preview.from_models import picture_of_models
from mmrs_core.pipeline import read_models

MISSION = "mission.xmi"
COARSE = ('gridResolution="12.0"', 'gridResolution="40.0"')
"""A grid that is planned in a tenth of the time."""


@pytest.fixture
def field(tmp_path):
    """Return a function: a copy of an example with some words of its mission replaced, or with one task."""

    def made(*changes, only=""):
        folder = shutil.copytree(example_folder("carbon-dioxide"), tmp_path / "field", dirs_exist_ok=True)
        words = (folder / MISSION).read_text("utf-8").replace(*COARSE)
        for old, new in changes:
            assert old in words
            words = words.replace(old, new, 1)
        mission = etree.fromstring(words.encode())
        for each in (*mission.iterfind("tasks"), *mission.iterfind("taskDependencies")) if only else ():
            if each.get("name") != only:
                mission.remove(each)
        (folder / MISSION).write_bytes(etree.tostring(mission) if only else words.encode())
        return folder

    return made


BAD_TYPE = ('name="Cirro" type="Quad 650"', 'name="Cirro" type="Quad 651"')
BAD_LATITUDE = ('latitude="42.369325"', 'latitude="142.369325"')
BAD_HOME = ('<home xsi:type="mission:GeoCoordinate" latitude="42.370000" longitude="13.350097"/>', "")
CROSSING = ('latitude="42.371530" longitude="13.349247"', 'latitude="42.371710" longitude="13.346"')
LATE = ('priority="1" altitude', 'priority="1" deadline="5.0" altitude')


def pins(svg):
    """Return the message of every numbered marker with its pixels."""
    root = etree.fromstring(svg.encode())
    return {
        pin.findtext("{*}title"): tuple(map(float, re.findall(r"[-0-9.]+", pin.get("transform"))))
        for pin in root.iter("{*}g")
        if pin.get("class", "").startswith("pin") and pin.find("{*}title") is not None
    }


def test_an_invalid_mission_is_drawn_with_its_problems_and_ends_as_validate_does(field, capsys):
    folder = field(BAD_TYPE, BAD_LATITUDE, CROSSING)
    assert run(["preview", str(folder)]) == run(["validate", str(folder)]) == 1
    said = capsys.readouterr().err
    page, svg = ((folder / name).read_text("utf-8") for name in ("preview.html", "preview.svg"))
    assert f"drawn with its problems: {folder / 'preview.html'}" in said
    assert "[MML004]" in page
    assert "mission.xmi:23" in page
    assert len(pins(svg)) == page.count('<li><svg class="sample" viewBox="-11') >= 3
    assert 'class="leg' not in svg.partition('class="legend"')[0]
    assert 'id="play"' not in page.partition("<script>")[0]


def test_a_marker_stands_where_its_element_lies(field, contributions):
    models, _ = read_models(field(BAD_TYPE), contributions)
    reasons = ("'west meadow' is too far", "robot 'Cirro' is too slow", "something else")
    picture = picture_of_models(models, contributions.map_symbols, reasons)
    meadow, home, nowhere = (problem.at for problem in picture.problems)
    west = next(task for task in picture.tasks if task.name == "west meadow")
    assert min(x for x, _ in west.rings[0]) < meadow[0] < max(x for x, _ in west.rings[0])
    assert home == picture.robots[2].home[:2]
    assert nowhere is None


def test_a_mission_without_a_plan_is_drawn_with_the_reasons(field, capsys):
    folder = field(LATE, only="east terrace")
    assert run(["preview", str(folder), "-o", str(folder / "out")]) == 4
    assert f"drawn with its problems: {folder / 'out' / 'preview.html'}" in capsys.readouterr().err
    page = (folder / "out" / "preview.html").read_text("utf-8")
    assert "its deadline is 5 s" in page
    assert "not planned" in page
    found = pins((folder / "out" / "preview.svg").read_text("utf-8"))
    assert any("east terrace" in words for words in found)


def test_a_robot_without_a_home_and_unknown_tasks_leave_the_rest_drawn(field):
    folder = field(BAD_HOME)
    assert run(["preview", str(folder)]) == 1
    assert run(["--no-plugins", "preview", str(folder)]) == 1
    assert "school" in (folder / "preview.svg").read_text("utf-8")


def test_warnings_of_a_valid_mission_are_marked_too(field):
    folder = field(only="west meadow")
    quad = folder / "robots" / "quad-650.xmi"
    words, exact = quad.read_text("utf-8"), '<legTimings overshoot="0.0"/></movementCapabilities>'
    quad.write_text(words.replace("</movementCapabilities>", exact), "utf-8")
    assert run(["preview", str(folder)]) == 0
    page, svg = ((folder / name).read_text("utf-8") for name in ("preview.html", "preview.svg"))
    assert len(pins(svg)) == 1
    assert "at the limit; 0.5 m of it is for position errors" in page
    assert "mission time" in page


def test_areas_and_robots_that_cannot_be_read_whole_are_marked_or_listed(field):
    folder = field(BAD_HOME)
    context = (folder / "context.xmi").read_text("utf-8")
    broken = context.replace(
        '<shell xsi:type="mission:GeoCoordinate" latitude="42.369802"', '<shell latitude="x"', 1
    )
    broken = broken.replace('<obstacles name="barn"', '<obstacles xsi:type="context:Barn" name="barn"')
    (folder / "context.xmi").write_text(broken, "utf-8")
    assert run(["preview", str(folder)]) == 1
    page, svg = (unescape((folder / name).read_text("utf-8")) for name in ("preview.html", "preview.svg"))
    for document in (page, svg):
        assert 'class="zone forbidden incomplete"' in document
        assert (
            "incomplete: forbidden area 'school' (context.xmi:8): 1 of 4 coordinates has no position"
            in document
        )
        assert "not drawn: obstacle 'barn' (context.xmi:39): Barn: no class" in document
        assert "not drawn: robot 'Brezza' (mission.xmi:12)" in document


def test_models_in_json_are_marked_and_listed_likewise(field, tmp_path):
    folder = tmp_path / "json"
    assert run(["convert", str(field()), "--to", "json", "-o", str(folder)]) == 0
    context = json.loads((folder / "context.json").read_text("utf-8"))
    context["forbiddenAreas"][0]["shell"][0]["latitude"] = "x42"
    context["emergencyAreas"][0] = {"$type": "context:Meadow", "name": "football pitch"}
    (folder / "context.json").write_text(json.dumps(context), "utf-8")
    assert run(["preview", str(folder)]) == 1
    page = unescape((folder / "preview.html").read_text("utf-8"))
    assert "incomplete: forbidden area 'school' (context.json:1): 1 of 4 coordinates" in page
    assert "not drawn: emergency area 'football pitch' (context.json:1): Meadow: no class" in page


def test_what_cannot_be_read_at_all_is_not_drawn(field):
    folder = field()
    (folder / MISSION).write_text("<mission", "utf-8")
    assert run(["preview", str(folder)]) == 3
    assert not (folder / "preview.html").exists()


def test_a_refused_plan_says_that_an_earlier_behaviour_is_unchanged(field, capsys):
    folder = field(only="east terrace")
    assert run(["plan", str(folder)]) == 0
    behaviour = folder / "behaviour.xmi"
    before = behaviour.read_bytes()
    assert "unchanged" not in capsys.readouterr().err
    assert run(["plan", str(field(LATE, only="east terrace"))]) == 4
    assert f"unchanged: {behaviour} is of an earlier plan" in capsys.readouterr().err
    assert behaviour.read_bytes() == before
