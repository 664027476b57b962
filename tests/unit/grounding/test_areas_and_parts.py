"""The place of a scene, and elements as plain data."""

from math import inf

import pytest
from grounded import geo, relative, scene, simple

from mmrs_core.diagnostics import Place
from mmrs_core.grounding.scenes import area_of, ground_of, part_of
from mmrs_core.languages import context, mission
from mmrs_core.scene import AreaUse, Part


def test_areas_keep_their_use_heights_and_distances(registry):
    def corners():
        return [relative(0, 0), relative(10, 0), relative(10, 10)]

    place = context.Context(
        forbiddenAreas=[context.Area(name="field", shell=corners(), safetyDistance=5.0)],
        obstacles=[context.Obstacle(shell=corners(), maxHeight=12.0)],
        emergencyAreas=[context.Area(shell=corners())],
    )
    found = scene(simple(registry, geo()), place).areas
    assert [each.name for each in found] == ["field", "obstacles[0]", "emergencyAreas[0]"]
    assert [each.use for each in found] == [AreaUse.FORBIDDEN, AreaUse.OBSTACLE, AreaUse.EMERGENCY]
    assert [(each.low, each.high) for each in found] == [(-inf, inf), (-inf, 12.0), (-inf, inf)]
    assert found[0].safety_distance == 5.0


def test_rings_lose_vertices_that_only_repeat(registry):
    corners = [relative(0, 0), relative(0, 0), relative(10, 0), relative(10, 10), relative(0, 0)]
    place = context.Context(forbiddenAreas=[context.Area(shell=corners)])
    area = scene(simple(registry, geo()), place).areas[0]
    assert area.shell == ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0))
    assert area.part.attributes["shell"] == ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0))


def test_area_outside_a_context_has_no_use():
    lonely = context.Area(shell=[])
    with pytest.raises(ValueError, match="neither a forbidden"):
        area_of(lonely, ground_of(None, None))


def test_environment_holds_only_what_is_known(registry):
    place = context.Context(environment=context.Environment(windSpeed=3.0))
    assert scene(simple(registry, geo()), place).environment == {"windSpeed": 3.0}


def test_holes_are_parts_with_grounded_points(registry):
    corners = [relative(0, 0), relative(90, 0), relative(90, 90)]
    hole = mission.Ring(points=[relative(60, 10), relative(80, 10), relative(80, 30)])
    sweep = registry.create(
        "urn:test:visit", "Sweep", shell=corners, holes=[hole], initialPosition=relative(0, 0)
    )
    (found,) = scene(simple(registry, geo(), tasks=[sweep])).tasks[0].part.attributes["holes"]
    assert isinstance(found, Part)
    assert found.attributes["points"] == ((60.0, 10.0, 0.0), (80.0, 10.0, 0.0), (80.0, 30.0, 0.0))


def test_references_become_positions_or_names(registry):
    made = simple(registry, geo())
    buoy = registry.create("urn:test:visit", "Buoy", name="B7", at=relative(5, 5))
    made.tasks[0].buoy, made.tasks[0].via = buoy, buoy.at
    found = scene(made, context.Context(elements=[buoy]))
    assert found.tasks[0].part.attributes["buoy"] == "B7"
    assert found.tasks[0].part.attributes["via"] == (5.0, 5.0, 0.0)
    assert found.elements[0].attributes["at"] == (5.0, 5.0, 0.0)


def test_part_carries_its_ancestry_most_specific_first(registry):
    found = scene(simple(registry, geo())).tasks[0].part
    assert found.metaclasses[:2] == (("urn:test:visit", "Visit"), ("urn:mmrs:mission:1.0", "PointTask"))
    assert found.place == Place(path="/tasks[0]")


def test_part_of_a_coordinate_without_a_position_is_refused():
    lonely = mission.Robot(name="r", home=relative())
    with pytest.raises(ValueError, match="no position"):
        part_of(lonely, ground_of(None, None))
