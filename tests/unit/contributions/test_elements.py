"""Context elements of plug-ins reach planning, checks and simulation alike."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from mmrs_core import pipeline
from mmrs_core.contributions.checks import Status
from mmrs_core.contributions.rules import ElementKind
from mmrs_core.errors import InfeasibleError
from mmrs_core.hookspecs import hookimpl
from mmrs_core.plugins import load_plugins
from mmrs_core.scene import Part
from mmrs_core.testing.scenes import sample_robot, sample_scene, square
from mmrs_core.testing.small_programs import go, program, robot, robot_type
from mmrs_core.transformation.kinds import PLAIN_ROBOT, kinematics_for

SAILOR, MAST = ("urn:test:1.0", "Sailor"), ("urn:test:1.0", "Mast")
THE_MAST = Part((MAST,), {"name": "mast"})
TYPE = robot_type(metaclass=SAILOR)


def kinematics(robot, scene):
    """Return the figures of a robot that starts from a mast."""
    if not scene.elements:
        raise InfeasibleError("the context has no mast")
    return kinematics_for(robot, scene, floor=0.0, ceiling=float(len(scene.elements)))


@pytest.fixture(scope="module")
def contributions():
    kind = replace(PLAIN_ROBOT, name="sailor", metaclass=SAILOR, kinematics=kinematics)
    mast = ElementKind(MAST, lambda element, everything: (square("mast", 30.0, 0.0, 1.0, 20.0),))
    plugin = SimpleNamespace(
        mmrs_robot_kinds=hookimpl(lambda: (kind,)), mmrs_element_kinds=hookimpl(lambda: (mast,))
    )
    return load_plugins(only_core=True, extra={"masts": plugin}).contributions


@pytest.fixture
def scene(contributions):
    return pipeline.expand(sample_scene(sample_robot(TYPE), elements=(THE_MAST,)), contributions)


def test_plans_keep_out_of_what_elements_are(scene):
    assert [area.name for area in scene.areas] == ["mast"]


def test_checks_know_the_elements_that_plans_know(contributions, scene):
    place = pipeline.place_of_scene(scene)
    sails = program(robot("Alba", [go("by", (30.0, 9.0, 0.0)), go("into", (30.0, 0.5, 0.0))]))
    found = {each.property: each for each in pipeline.verify(sails, place, contributions)}
    assert found["altitude"].status is Status.SAFE
    assert (found["clearance"].status, found["clearance"].area) == (Status.VIOLATED, "mast")


def test_simulations_know_the_elements(contributions, scene):
    place = pipeline.place_of_scene(scene)
    run = pipeline.simulate(program(robot("Alba", [go("by", (9.0, 9.0, 0.0))])), place, contributions)
    assert run.ending.outcome.value == "success"
