"""Areas, elements and tasks become features with all that is known of them."""

from dataclasses import replace

import pytest
from drawn_scene import SHELL, SYMBOLS

from mmrs_core.contributions.symbols import CORE_SYMBOLS
from mmrs_core.drawings.drawing import Geometry, HeightReference, LeftOut, Role
from mmrs_core.pictures.layers.chart import chart_of
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.pictures.layers.places import (
    areas_on,
    elements_on,
    homes_on,
    properties_of,
    rally_points_on,
    tasks_on,
)
from mmrs_core.pictures.palette import COLOURS
from mmrs_core.pictures.preview.features import elements_of
from mmrs_core.scene import Frame, Part
from mmrs_core.scene.relays import RELAY

CHART = chart_of(Frame("EPSG:4326", 42.37, 13.35, 100.0, "MSL"), (HeightReference.SEA_LEVEL,))
RING = ("urn:mmrs:mission:1.0", "Ring")


def part(kind="Buoy", **attributes):
    return Part((("urn:test:1.0", kind),), attributes)


def test_an_obstacle_has_the_height_of_its_upper_side_and_a_refuge_none(scene):
    tower, school, meadow = areas_on(CHART, scene.areas)
    assert (tower.name, tower.role, tower.heights[0].tolist()) == ("tower", Role.OBSTACLE, [135.0] * 4)
    assert (school.role, school.reference) == (Role.FORBIDDEN, HeightReference.NONE)
    assert (meadow.role, meadow.colour) == (Role.EMERGENCY_AREA, COLOURS["emergency"][0])


def test_areas_that_elements_make_are_drawn_as_these(scene):
    barred = replace(scene.areas[0], types=frozenset({"rover"}))
    assert [each.name for each in areas_on(CHART, [barred, scene.areas[1]])] == ["school"]


def test_tasks_have_their_holes_and_colours_and_those_without_a_position_are_missed(scene):
    hole = Part((RING,), {"points": tuple((east / 2 + 20, north / 2 + 5, 0.0) for east, north, _ in SHELL)})
    field = replace(
        scene.tasks[0], part=replace(scene.tasks[0].part, attributes={"shell": SHELL, "holes": (hole,)})
    )
    area, (layer, fork), road = tasks_on(CHART, replace(scene, tasks=(field, *scene.tasks[1:])), SYMBOLS)
    assert (area.geometry, len(area.rings), area.colour) == (Geometry.AREA, 2, "#c2571a")
    assert (area.name, area.properties["type"], area.folders) == ("field", "PhotoGridTask", (Layer.TASKS,))
    assert (layer, fork) == (Layer.TASKS, LeftOut("fork 'fork'", "has no position"))
    assert (road.geometry, road.heights[0].tolist()) == (Geometry.LINE, [115.0, 115.0])


def test_what_lies_under_water_is_below_the_origin():
    line, mark = elements_on(
        CHART, [part(name="pipe", points=((0.0, 0.0, -7.0), (9.0, 0.0, -9.5)), float=(4.0, 0.0, 0.0))], {}
    )
    assert (line.name, line.heights[0].tolist()) == ("pipe", [93.0, 90.5])
    assert (mark.geometry, mark.heights) == (Geometry.POINT, ())


def test_a_relay_is_a_mark_at_its_height_with_its_range():
    symbols = {each.metaclass: each for each in CORE_SYMBOLS}
    relay = Part((RELAY,), {"name": "ridge", "position": (10.0, 20.0, 6.0), "range": 650.0})
    (mark,) = elements_on(CHART, [relay], symbols)
    assert (mark.geometry, mark.name, mark.description) == (Geometry.POINT, "ridge", "relay")
    assert mark.heights[0].tolist() == [106.0]
    assert mark.properties == {"type": "Relay", "range": 650.0}
    (drawn,) = elements_of([relay], symbols)
    assert (drawn.marks, drawn.symbol.icon) == (((10.0, 20.0),), "⌁")
    assert "range 650" in drawn.tip


def test_of_two_positions_above_each_other_neither_height_is_chosen():
    (mooring,) = elements_on(CHART, [part(points=((0.0, 0.0, -20.0), (0.0, 0.0, -3.0)))], {})
    assert mooring.heights == ()


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        (
            {"name": "a", "depth": 8.0, "rows": 3, "tracking": False},
            {"depth": 8.0, "rows": 3, "tracking": False},
        ),
        (
            {"requiredActions": ("Scan", "Ping"), "empty": (), "absent": None, "words": ""},
            {"requiredActions": "Scan, Ping"},
        ),
        ({"parameters": (part(key="k", value="v"),)}, {"parameters[0].key": "k", "parameters[0].value": "v"}),
        ({"sheet": part(size=2.0)}, {"sheet.size": 2.0}),
        ({"type": "QUICK", "description": "red"}, {"Buoy.type": "QUICK", "Buoy.description": "red"}),
        (
            {
                "position": (1.0, 2.0, 3.0),
                "shell": SHELL,
                "panels": (part(position=(1.0, 2.0, 3.0), tilt=9.0),),
            },
            {},
        ),
    ],
)
def test_what_has_no_shape_of_its_own_is_a_property(attributes, expected):
    assert properties_of(part(**attributes)) == {"type": "Buoy", **expected}


def test_homes_have_heights_unless_they_lie_on_the_ground_at_an_origin_of_unknown_height():
    homes = [("a", "Quad", (1.0, 2.0, 0.0)), ("b", "Quad", (1.0, 2.0, 4.0)), ("c", "Quad", None)]
    low, high = homes_on(CHART, homes)
    assert (low.heights[0].tolist(), high.heights[0].tolist()) == ([100.0], [104.0])
    assert high.properties == {"robot": "b", "type": "Quad"}
    low, high = homes_on(replace(CHART, reference=HeightReference.HOME, zero=0.0), homes)
    assert (low.heights, high.heights[0].tolist()) == ((), [4.0])


def test_every_robot_has_its_rally_points(scene, behaviour, types):
    meadow = [replace(scene.areas[2], safety_distance=0.0)]
    points = list(rally_points_on(CHART, behaviour, types, meadow))
    assert [(each.name, each.role) for each in points] == [
        ("alpha", Role.CHOSEN_RALLY_POINT),
        ("beta", Role.CHOSEN_RALLY_POINT),
    ]
    assert points[0].rings[0].tolist() != points[1].rings[0].tolist()
