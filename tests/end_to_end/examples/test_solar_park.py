"""What drones do in a solar park: rows seen squarely and sharply, in enough sunlight."""

import shutil
from itertools import pairwise
from math import atan2, cos, degrees, dist, radians, sin

import pytest
from lxml import etree

from mmrs_core import pipeline
from mmrs_core.contributions.checks import Status
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import to_xmi
from mmrs_core.pictures.preview.from_plan import picture_of_plan
from mmrs_core.pictures.preview.map import map_of

pytestmark = pytest.mark.together("examples")

SOLAR = "urn:mmrs:solar:1.0"
ROWS = {"rows of the south field": 8, "rows of the east field": 5}


@pytest.fixture(scope="module")
def park(taken):
    return taken("solar-park")


@pytest.fixture
def copy(folder_of, tmp_path):
    """Return a function that copies the example, with some words of a file replaced."""

    def make(file, old, new):
        folder = tmp_path / "park"
        shutil.copytree(folder_of("solar-park"), folder)
        text = (folder / file).read_text(encoding="utf-8")
        assert old in text
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return make


def normal_of(group):
    azimuth, tilt = radians(group.attributes["azimuth"]), radians(group.attributes["tilt"])
    return sin(azimuth) * sin(tilt), cos(azimuth) * sin(tilt), cos(tilt)


def recordings(program, task):
    """Yield the moves of a task on which a camera records: from where it begins to where it stops."""
    for robot in program.robots:
        for one, two in pairwise(robot.moves):
            begins = any(action.name == "StartCapture" for action in one.after)
            if begins and two.task == task:
                yield one, two


@pytest.mark.parametrize("task", sorted(ROWS))
def test_every_row_is_recorded_from_end_to_end_by_one_of_the_drones(park, task):
    group = next(e for e in park.scene.elements if e.attributes["name"] == task.removeprefix("rows of the "))
    length = dist(*group.attributes["points"])
    found = list(recordings(park.program, task))
    assert len(found) == ROWS[task]
    for begin, end in found:
        assert dist(begin.target.position, end.target.position) == pytest.approx(length, abs=0.01)
        assert any(action.name == "StopCapture" for action in end.after)


@pytest.mark.parametrize("task", sorted(ROWS))
def test_the_camera_looks_along_the_normal_from_all_of_a_row(park, task):
    group = next(e for e in park.scene.elements if e.attributes["name"] == task.removeprefix("rows of the "))
    normal = normal_of(group)
    for moves in recordings(park.program, task):
        for move in moves:
            here, aim = move.target.position, move.heading.target.position
            cosine = sum((a - b) * n for a, b, n in zip(here, aim, normal, strict=True)) / dist(here, aim)
            assert cosine > cos(radians(1.1))
            bearing = degrees(atan2(aim[0] - here[0], aim[1] - here[1]))
            assert abs((bearing - group.attributes["azimuth"]) % 360.0 - 180.0) < 5.0


def test_nothing_is_recorded_faster_than_images_are_sharp(park):
    for task in ROWS:
        for _, move in recordings(park.program, task):
            pixel = 0.03 if "south" in task else 28.0 * 0.012 / 13.5
            assert move.speed * 0.008 <= 0.5 * pixel * (1.0 + 1e-6)


def test_an_image_is_taken_of_each_suspected_panel_after_all_rows(park):
    moves = {(robot.id, move.id): move for robot in park.program.robots for move in robot.moves}
    looks = [
        record
        for record in park.run.records
        if record.label == "act" and moves[record.robot, record.move].task == "hot panels"
    ]
    rows = [each for each in park.run.records if moves[each.robot, each.move].task in ROWS]
    assert len({(record.robot, record.move) for record in looks}) == 3
    assert min(record.time for record in looks) > max(record.time for record in rows if record.label == "act")


def test_the_sunlight_is_enough_by_what_the_behaviour_itself_says(park):
    found = [verdict for verdict in park.verdicts if verdict.property == "irradiance"]
    assert {verdict.status for verdict in found} == {Status.SAFE}
    assert min(verdict.margin for verdict in found) == 180.0


def test_on_a_dark_day_the_mission_is_not_valid(copy, contributions):
    folder = copy("context.xmi", 'irradiance="780.0"', 'irradiance="590.0"')
    models, _ = pipeline.read_models(folder, contributions)
    faults = pipeline.check_models(models, contributions)
    assert [fault.code for fault in faults] == ["SOL017", "SOL017", "SOL017"]


def test_sunlight_that_nobody_knows_stands_against_the_behaviour_unless_accepted(copy, park, contributions):
    folder = copy("context.xmi", ' irradiance="780.0"', "")
    models, faults = pipeline.valid_models(folder, contributions)
    assert faults == ()
    place = pipeline.place_of_scene(pipeline.ground(models))
    against = pipeline.refusals(pipeline.verify(park.program, place, contributions), park.program)
    assert {verdict.property for verdict in against} == {"irradiance"}


def test_every_row_of_panels_is_drawn(park, contributions):
    picture = picture_of_plan(park.scene, park.plan, contributions.map_symbols)
    drawn = {thing.name: (thing.symbol.label, len(thing.outlines)) for thing in picture.elements}
    assert drawn == {"south field": ("panel group", 8), "east field": ("panel group", 5)}
    assert etree.fromstring(map_of(picture).encode()) is not None


def test_without_the_plugin_its_elements_are_named_and_survive(folder_of, contributions):
    bare = Registry(each for each in contributions.languages.packages if each.ns_uri != SOLAR)
    file = folder_of("solar-park") / "context.xmi"
    model = read_model(file, bare)
    assert any(SOLAR in fault.message for fault in model.diagnostics)
    written = to_xmi(model.roots, bare)
    assert all(f'name="{name}"'.encode() in written for name in ("south field", "east field"))
