"""The figures that checks ask kinds of robots for."""

from dataclasses import replace

from checking import given, kind

from mmrs_core.analysis.figures import kinematics_of
from mmrs_core.scene import Part
from mmrs_core.testing.programs import areas
from mmrs_core.testing.small_programs import robot

WEATHER = {"windSpeed": 4.0}


def test_a_kind_is_asked_with_the_one_robot_and_all_that_is_known_of_its_surroundings():
    asked, plain = [], kind()

    def kinematics(robot, scene):
        asked.append((robot, scene))
        return plain.kinematics(robot, scene)

    noting, pylon = replace(plain, kinematics=kinematics), Part((("plugin", "Pylon"),), {})
    around = {"areas": areas(), "environment": WEATHER, "elements": (pylon,)}
    crew = given(
        robot("a", [], home=(1.0, 2.0, 0.0)), robot("b", []), robot_kind=noting, reserve=0.3, **around
    )
    assert kinematics_of(crew, crew.program.robots[0]) == kinematics_of(crew, crew.program.robots[0])
    ((seen, scene),) = asked
    assert (seen.name, seen.home, scene.robots) == ("a", (1.0, 2.0, 0.0), (seen,))
    assert {name: getattr(scene, name) for name in around} == around
    assert scene.reserve == 0.3
