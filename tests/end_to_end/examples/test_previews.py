"""The examples are drawn whole: every way, every stay, every choice, and what plug-ins know of the place."""

import pytest
from lxml import etree

from mmrs_core.pictures.preview.from_plan import picture_of_plan
from mmrs_core.pictures.preview.map import map_of
from mmrs_core.pictures.preview.page import page
from mmrs_core.scene import Branch, Serve

pytestmark = pytest.mark.together("examples")


@pytest.fixture
def picture_of(contributions):
    """Return a function: the picture of an example."""

    def draw(example):
        return picture_of_plan(example.scene, example.plan, contributions.map_symbols, example.trace.moves())

    return draw


def test_every_leg_and_stay_names_its_moves(example, picture_of):
    legs = [(robot.name, leg) for robot in picture_of(example).robots for leg in robot.legs]
    assert legs
    assert [(name, leg.kind, leg.task, leg.begin) for name, leg in legs if not leg.moves] == []


def test_no_move_is_named_by_two_legs(example, picture_of):
    for robot in picture_of(example).robots:
        named = [leg.moves for leg in robot.legs]
        assert len(named) == len(set(named))


def test_every_stay_is_marked_and_told(example, picture_of):
    picture = picture_of(example)
    stays = [
        (robot.name, leg)
        for robot in picture.robots
        for leg in robot.legs
        if leg.kind == "work" and len({point[:2] for point in leg.points}) == 1
    ]
    root = etree.fromstring(map_of(picture).encode())
    marks = [e.findtext("{*}title") for e in root.iter() if e.get("class") == "stay"]
    told = [line for mark in marks for line in mark.splitlines()]
    assert sorted(told) == sorted(leg.tip(name) for name, leg in stays)


def test_every_way_of_a_choice_is_told(taken, picture_of):
    example = taken("mixed-team")
    branches = [step for robot in example.plan.robots for step in robot.steps if isinstance(step, Branch)]
    arms = [arm.words for robot in picture_of(example).robots for arm in robot.arms]
    assert len(branches) == 1
    assert arms == ["if energy_above_100_kJ", "otherwise"]


def test_every_task_is_drawn_as_a_plugin_says(example, picture_of, contributions):
    served = {step.task for robot in example.plan.robots for step in robot.steps if isinstance(step, Serve)}
    symbols = set(contributions.map_symbols.values())
    assert {task.symbol for task in picture_of(example).tasks if task.name in served} <= symbols


def test_the_landmark_of_the_dam_is_on_the_map_and_on_the_page(taken, picture_of):
    picture = picture_of(taken("mixed-team"))
    (gauge,) = picture.elements
    assert (gauge.name, gauge.symbol.label, len(gauge.marks)) == ("spillway gauge", "landmark", 1)
    told = "landmark, description staff gauge on the left wall of the spillway"
    assert f"<title>spillway gauge: {told}</title>" in map_of(picture)
    assert "landmark</li>" in page(picture)


@pytest.mark.parametrize("name", ["ridge", "barn", "solar-park"])
def test_radio_ranges_are_drawn_where_there_are_relays(taken, picture_of, name):
    drawn = {each.whose: (each.at, each.metres) for each in picture_of(taken(name)).ranges}
    if name == "solar-park":
        assert drawn == {}
        return
    home, relay = drawn
    assert home.startswith("home of ")
    robot = taken(name).scene.robot(home.split("'")[1])
    assert drawn[home] == (robot.home[:2], robot.type.part.attributes["communicationRange"])
    assert "relay" in relay
