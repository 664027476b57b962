"""Constraints survive models that are not finished, and grounding refuses them in words."""

from contextlib import suppress

import pytest

from mmrs_core.analysis.constraints import CONSTRAINTS, check_behaviour, check_constraints
from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.scenes import ground
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.element import Element, Unknown, descendants, metaclass_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.reading import read_text
from mmrs_core.scene import Scene


def places(models) -> list[tuple[int, int, str]]:
    """Return (model, element, attribute) of every feature that holds something."""
    return [
        (root, index, feature.attribute)
        for root, whole in enumerate(roots(models))
        for index, element in enumerate((whole, *descendants(whole)))
        for feature in metaclass_of(element).features
        if getattr(element, feature.attribute)
    ]


def roots(models) -> tuple[Element, ...]:
    return models.mission, models.context, models.quad, models.behaviour


def without(models, root: int, index: int, attribute: str):
    whole = roots(models)[root]
    element = list((whole, *descendants(whole)))[index]
    feature = metaclass_of(element).by_attribute[attribute]
    setattr(element, attribute, [] if feature.many else None)
    return models


def survives(models) -> None:
    models.faults()
    with suppress(InvalidModelError):  # which says what is missing; anything else is a defect
        assert isinstance(ground(models.as_set), Scene)


def test_constraints_survive_a_sample_of_missing_features(fresh_models):
    for place in places(fresh_models())[::17]:
        survives(without(fresh_models(), *place))


@pytest.mark.thorough
def test_constraints_survive_every_missing_feature(fresh_models):
    for place in places(fresh_models()):
        survives(without(fresh_models(), *place))


def test_constraints_survive_empty_models(registry):
    empty = ModelSet(
        mission.Mission(), context.Context(), {"": robot.Robot()}, (), behaviour.Behaviour(robots=[])
    )
    assert check_constraints(empty, CONSTRAINTS, registry) == ()


def test_constraints_survive_elements_without_anything_inside(registry, fresh_models):
    made = registry.create
    hollow = ModelSet(
        mission.Mission(
            team=mission.Team(robots=[mission.Robot(), mission.Robot(home=mission.GeoCoordinate())]),
            tasks=[made("urn:test:trial", kind) for kind in ("Visit", "Follow", "Sweep")]
            + [mission.Fork(), mission.Join()],
            taskDependencies=[mission.TaskDependency()],
        ),
        context.Context(
            forbiddenAreas=[context.Area()],
            obstacles=[context.Obstacle()],
            emergencyAreas=[context.Area()],
            environment=context.Environment(),
        ),
        {"x": robot.Robot(size=robot.Size(), movementCapabilities=[robot.MovementCapability()])},
        (),
        behaviour.Behaviour(
            robots=[
                behaviour.Robot(
                    slots=[behaviour.Slot()],
                    moves=[behaviour.GoTo(), behaviour.HeadTo(), behaviour.Recharge()],
                    moveTransitions=[behaviour.Choice(), behaviour.MoveTransition()],
                )
            ],
            targets=[behaviour.ObjectTarget(), behaviour.RelativeCoordinate()],
        ),
    )
    codes = {fault.code for fault in check_constraints(hollow, CONSTRAINTS, registry)}
    assert {"MML043", "MML044", "BL001", "BL002"} <= codes


def test_constraints_survive_wrong_types(models):
    models.task("visit").robotsWanted = "many"
    models.task("sweep").altitude = "high"
    models.context.obstacles[0].safetyDistance = True
    models.faults()


def test_constraints_survive_elements_of_missing_plugins(registry):
    data = b"""<?xml version="1.0" encoding="UTF-8"?>
<mission:Mission xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:mission="urn:mmrs:mission:1.0"
    xmlns:gone="urn:test:gone" name="m">
  <team><robots name="r" type="quad"><home xsi:type="mission:GeoCoordinate" latitude="1" longitude="2"/>
  </robots></team>
  <tasks xsi:type="gone:Dig" name="dig"/>
</mission:Mission>"""
    (read,) = read_text(data, "mission.xmi", registry).roots
    found = check_constraints(ModelSet(read, None, {}, ()), CONSTRAINTS, registry)
    assert {fault.code for fault in found} == {"MML004"}
    with pytest.raises(InvalidModelError) as caught:
        ground(ModelSet(read, None, {}, ()))
    assert any("not installed" in fault.message for fault in caught.value.diagnostics)


def test_behaviour_is_checked_without_a_mission(registry, models):
    models.behaviour.robots[0].moveTransitions.pop()
    found = check_behaviour(models.behaviour, CONSTRAINTS, registry)
    assert {fault.code for fault in found} == {"BL006", "BL011", "BL012"}


def test_behaviour_is_checked_against_types_where_they_are_given(registry, models):
    models.behaviour.robots[0].typeName = "Quad"
    assert check_behaviour(models.behaviour, CONSTRAINTS, registry) == ()
    found = check_behaviour(models.behaviour, CONSTRAINTS, registry, robots={"quad": models.quad})
    assert [fault.code for fault in found] == ["BL035"]


def test_a_coordinate_without_an_end_is_not_taken_for_swapped(models):
    models.task("visit").point = models.geo(float("inf"), 13.35)
    assert "MML027" not in models.codes()


def test_a_move_of_an_unknown_kind_may_end_anywhere(models):
    unknown = Unknown.__new__(Unknown)
    unknown._mmrs_type = "urn:kites:1.0#Soar"
    robot = models.behaviour.robots[0]
    robot.moves.append(unknown)
    go = models.move("go")
    go.distance = 5.0
    models.transition("start").from_ = unknown
    assert "BL052" not in models.codes()


@pytest.mark.parametrize(("name", "code"), [("Quad", "MML004"), ("", "MML013")])
def test_nothing_is_derived_from_a_type_that_is_not_known(models, name, code):
    models.put(models.mission.team.robots[1], type=name)
    models.put(models.task("visit"), requiredDevices=["sonar"])
    models.put(models.task("follow"), points=[models.at(510, 510), models.at(590, 590)])
    assert models.codes() == {code}


def test_a_type_without_a_name_may_be_the_one_that_robots_name(models):
    models.quad.name = ""
    nameless = ModelSet(models.mission, models.context, {"": models.quad}, ())
    found = check_constraints(nameless, CONSTRAINTS, models.registry)
    assert {fault.code for fault in found} == {"RL028"}
