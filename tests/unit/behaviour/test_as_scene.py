"""Behaviours as scenes."""

from dataclasses import replace

import pytest

from mmrs_core.behaviour.as_scene import scene_of
from mmrs_core.errors import UnsupportedError
from mmrs_core.testing.small_programs import ROBOT_TYPE, program, robot, robot_type

TYPES = {ROBOT_TYPE: robot_type()}


def test_robots_keep_what_kinematics_depend_on():
    behaviour = replace(program(robot("r", [], home=(1.0, 2.0, 3.0))), position_error=0.25)
    (found,) = scene_of(behaviour, TYPES).robots
    assert (found.name, found.home, found.payload, found.travel_mode) == ("r", (1.0, 2.0, 3.0), 0.0, "NORMAL")
    assert found.clearance == 0.75


def test_a_home_that_nobody_gave_is_the_origin():
    (found,) = scene_of(program(robot("r", [], home=None)), TYPES).robots
    assert found.home == (0.0, 0.0, 0.0)


def test_the_reserve_is_the_behaviours_unless_told_otherwise():
    behaviour = replace(program(robot("r", [])), reserve=0.3)
    assert scene_of(behaviour, TYPES).reserve == 0.3
    assert scene_of(behaviour, TYPES, reserve=0.0).reserve == 0.0


def test_robots_without_a_type_are_listed():
    with pytest.raises(UnsupportedError) as caught:
        scene_of(program(robot("a", []), robot("b", [])), {})
    assert caught.value.elements == ("robot 'a': type 'plain'", "robot 'b': type 'plain'")
